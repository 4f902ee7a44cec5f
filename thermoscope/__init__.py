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

from typing import TYPE_CHECKING, Any

from thermoscope.rooms import register_rooms

if TYPE_CHECKING:
    from geom.errors import InputError as InputError, MissingDependency as MissingDependency
    from geom.errors import ThermoscopeError as ThermoscopeError
    from lumped.declarations.network import load_network as load_network, read_network as read_network
    from lumped.integration.record import Record as Record
    from lumped.integration.simulate import Run as Run, simulate as simulate
    from lumped.integration.steady import Steady as Steady, steady as steady
    from lumped.model.network import Network as Network, Parameter as Parameter
    from thermoscope.interface.case import Case as Case, effects as effects, open as open
    from thermoscope.interface.machine import Field as Field, Machine as Machine, build as build, machines as machines
    from validation.comparison.compare import Comparison as Comparison
    from validation.effects.base import Effect as Effect
    from validation.inference.result import Candidate as Candidate, Diagnosis as Diagnosis
    from validation.revision.revise import Revision as Revision

register_rooms()


def __getattr__(name: str) -> Any:
    from geom.lazy import loaded_when_used
    from geom.plugins import plugins

    # Extras add names, too, such as `compare_designs`.
    return loaded_when_used(__name__, __file__, lambda: plugins("names"))[0](name)


def __dir__() -> list[str]:
    return list(__getattr__("__all__"))
