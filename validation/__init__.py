"""Does the model agree with the measurements, and if not, what is missing?

Names are loaded when they are used: a command pays for nothing else.
"""

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from validation.comparison.compare import Comparison as Comparison, compare as compare
    from validation.diagnosis import diagnose as diagnose
    from validation.effects import Effect as Effect, Scene as Scene, catalogue as catalogue, effect as effect
    from validation.effects import kinds as kinds
    from validation.inference.result import Diagnosis as Diagnosis
    from validation.revision.revise import Revision as Revision, add as add, calibrate as calibrate, remove as remove

__getattr__, __dir__ = loaded_when_used(__name__, __file__)
