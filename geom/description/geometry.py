"""A machine's dimensions as the families read them."""

from types import SimpleNamespace


class Group(SimpleNamespace):
    """Parameters of one part of the machine in SI, by their names: lengths (m), angles (rad), counts and words."""


class Geometry(SimpleNamespace):
    """All parameters of a family, a `Group` each: geometry.rotor.stack_length (m)."""
