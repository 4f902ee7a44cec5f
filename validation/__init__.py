"""Does the model agree with the measurements, and if not, what is missing?

Names are loaded when they are used: a command pays for nothing else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from validation.comparison.compare import Comparison, compare
    from validation.diagnosis import diagnose
    from validation.effects import Effect, Scene, catalogue, effect, kinds
    from validation.inference.result import Diagnosis
    from validation.revision.revise import Revision, add, calibrate, remove

_HOME = {
    "Comparison": "validation.comparison.compare",
    "Diagnosis": "validation.inference.result",
    "Effect": "validation.effects",
    "Revision": "validation.revision.revise",
    "Scene": "validation.effects",
    "add": "validation.revision.revise",
    "calibrate": "validation.revision.revise",
    "catalogue": "validation.effects",
    "compare": "validation.comparison.compare",
    "diagnose": "validation.diagnosis",
    "effect": "validation.effects",
    "kinds": "validation.effects",
    "remove": "validation.revision.revise",
}
__all__ = [
    "Comparison",
    "Diagnosis",
    "Effect",
    "Revision",
    "Scene",
    "add",
    "calibrate",
    "catalogue",
    "compare",
    "diagnose",
    "effect",
    "kinds",
    "remove",
]
__getattr__, __dir__ = loaded_when_used(__name__, _HOME)
