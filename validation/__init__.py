"""Does the model agree with the measurements, and if not, what is missing?"""

from validation.case import AddedEffect, Case, Channel, Model, Test
from validation.comparison.compare import Comparison, compare
from validation.diagnosis.result import Diagnosis
from validation.effects import Effect, Scene, catalogue, effect, kinds
from validation.inference.diagnose import diagnose
from validation.revision.revise import Revision, add, calibrate, remove

__all__ = [
    "AddedEffect",
    "Case",
    "Channel",
    "Comparison",
    "Diagnosis",
    "Effect",
    "Model",
    "Revision",
    "Scene",
    "Test",
    "add",
    "calibrate",
    "catalogue",
    "compare",
    "diagnose",
    "effect",
    "kinds",
    "remove",
]
