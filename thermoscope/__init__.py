"""See where your motor's thermal model is wrong, and why.

import thermoscope as ts

case = ts.open("my-case")           # a case folder, or the name of a case that comes along
case.compare()                      # the model against every test: error per sensor (K)
d = case.diagnose()                 # which effect is missing, with its probability
better = case.add(d.best)           # a new case: the effect added, the parameters calibrated again
better.save()                       # one more revision in model.toml
better.plot()                       # measured and modelled over time

machine = ts.build("tefc-industrial")           # mesh, field and network of a machine
machine.field(current_A=20.0, ambient_C=40.0)   # its steady temperatures

Nothing heavy is loaded before it is used. What is wrong with the input raises InputError: what, where, what would be
right.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from thermoscope.rooms import register_rooms

if TYPE_CHECKING:
    from geom.errors import InputError, MissingDependency, ThermoscopeError
    from lumped.declarations.network import load_network, read_network
    from lumped.integration.record import Record
    from lumped.integration.simulate import Run, simulate
    from lumped.integration.steady import Steady, steady
    from lumped.model.network import Network, Parameter
    from thermoscope.interface.case import Case, effects, open
    from thermoscope.interface.machine import Field, Machine, build, machines
    from validation.comparison.compare import Comparison
    from validation.effects.base import Effect
    from validation.inference.result import Candidate, Diagnosis
    from validation.revision.revise import Revision

__all__ = [
    "Candidate",
    "Case",
    "Comparison",
    "Diagnosis",
    "Effect",
    "Field",
    "InputError",
    "Machine",
    "MissingDependency",
    "Network",
    "Parameter",
    "Record",
    "Revision",
    "Run",
    "Steady",
    "ThermoscopeError",
    "build",
    "effects",
    "load_network",
    "machines",
    "open",
    "read_network",
    "simulate",
    "steady",
]

register_rooms()


def __getattr__(name: str) -> Any:
    if name not in __all__:
        from geom.plugins import plugins

        offered = plugins("names")  # of extras, such as `compare_designs`
        if name in offered:
            return offered[name]
        raise AttributeError(
            f"module 'thermoscope' has no attribute '{name}'; known: {', '.join([*__all__, *offered])}"
        )
    from geom.lazy import typed_homes

    return getattr(import_module(typed_homes(__file__)[name][0]), name)


def __dir__() -> list[str]:
    return __all__
