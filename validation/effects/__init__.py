"""The physics a network may lack, each at every place where it can sit."""

from validation.effects.base import Effect, Scene
from validation.effects.registry import catalogue, effect, extended, kinds

__all__ = ["Effect", "Scene", "catalogue", "effect", "extended", "kinds"]
