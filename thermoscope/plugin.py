"""What extras and packages of others build on, beside `import thermoscope as ts`: names of the rooms, loaded when used.

    from thermoscope import plugin as th

plugin.pyi lists them with their modules. What is missing there is added there; nothing else of the rooms is promised.
"""

from pathlib import Path

from geom.lazy import loaded_when_used

__getattr__, __dir__ = loaded_when_used(__name__, Path(__file__).with_suffix(".pyi"))
