"""What is exported: the network with its multipliers worked in, and what its user must know of inputs and outputs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from extras.export.products import Sum
from extras.export.tables import Ranges, factors
from thermoscope import InputError, Network, plugin as th

USUAL_C = 20.0  # where a run starts unless it is told
WIDER = 1.5  # tables of unknown laws reach that much beyond what the fitted tests recorded


@dataclass(frozen=True)
class Signal:
    """An input of a law, or a boundary temperature.  low, high : over the fitted tests; None where none records it"""

    name: str
    unit: str
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Output:
    """A temperature (degC).  row : over z = [x; u];  limit : degC, if one was given

    error_K, role : root mean square against the readings of the tests of that role, where a sensor sits, when the
    model was fitted
    low, high : reached by the model in the tests
    """

    name: str
    row: th.Row
    limit: float | None = None
    error_K: float | None = None
    role: str = ""


@dataclass(frozen=True)
class Model:
    """A network as exported code has it.

    K0 (n, n + nb + 1) : constant terms;  terms : the others, with multipliers worked into `factors`
    sizes : inputs, by their sizes, that temperature laws see; or a size that never changes
    unit, node (n,) : K per unit of a state; 1 where it is a temperature
    """

    name: str
    revision: int
    effects: tuple[str, ...]
    states: tuple[str, ...]
    C: th.Array
    K0: th.Array
    terms: th.Terms
    term_names: tuple[str, ...]
    factors: tuple[Sum, ...]
    inputs: tuple[Signal, ...]
    boundaries: tuple[Signal, ...]
    outputs: tuple[Output, ...]
    unit: th.Array
    node: th.Ints
    sizes: tuple[tuple[str | None, float], ...] = ()
    tolerance: tuple[float, float] = (th.RUN.error_K, th.RUN.error_share)
    initial_degC: float = USUAL_C
    start_K: Mapping[str, float] = field(default_factory=dict)  # node without a sensor -> how far from that it began

    @property
    def signals(self) -> tuple[Signal, ...]:
        """All that is set from outside: inputs, then boundaries."""
        return (*self.inputs, *self.boundaries)

    @property
    def start_degC(self) -> list[float]:
        """Where each node began the first test that was fitted; other states at 0."""
        pairs = zip(self.states, self.node, strict=True)
        return [self.initial_degC + self.start_K.get(name, 0.0) if is_node else 0.0 for name, is_node in pairs]


def exported(folder: th.Folder, limits: Mapping[str, float]) -> Model:
    """The model of a case as it stands. Raises InputError for a law that has no form outside this tool."""
    (network, values), reference = th.model_of(folder), th.standing_reference(folder.case)
    model = packed(network, values, reference, outputs(network, folder, limits))
    effects = tuple(e.name for e in folder.case.model.effects)
    fitted = folder.case.model.values
    start = {
        n: fitted[name] for n in model.states for t in reference.tests[:1] if (name := th.start_name(n, t)) in fitted
    }
    return replace(model, name=folder.case.name, revision=folder.case.model.revision, effects=effects, start_K=start)


def packed(network: Network, values: Mapping[str, float], reference: th.Reference, looks: Sequence[Output]) -> Model:
    """A network at some values of its parameters; reference: which ranges of inputs it was fitted over."""
    every, m = th.assembly(network), th.multipliers(network, values)
    acting = np.array([m.get(name, 1.0) for name in every.names])
    steady = np.array([not p.bends and not p.law.reads for p in every.patterns], bool)
    live = ~steady & (acting != 0.0)
    constant = [float(p.law.factor({})) if s else 0.0 for p, s in zip(every.patterns, steady, strict=True)]
    reads = {name for p, on in zip(every.patterns, live, strict=True) if on for name in p.law.reads}
    inputs = tuple(Signal(n, unit_of(network, n), *_range(reference, n)) for n in sorted(reads))
    hidden = np.array(["#" in s for s in network.states], bool)
    # What temperature laws see: (input, 0), or (None, a size)
    laws = [x.law for x in every.input_sizes(live)]
    return Model(
        network.name,
        0,
        (),
        network.states,
        network.C * th.capacity_multipliers(network, m),
        every.matrix(acting * np.array(constant)),
        every.packed(live, steady),
        tuple(n for n, on in zip(every.names, live, strict=True) if on),
        tuple(_factors(every, live, acting, _reaches(inputs))),
        inputs,
        tuple(Signal(b, "degC", *_range(reference, b)) for b in network.boundaries),
        tuple(looks),
        th.state_units(network),
        (~hidden).astype(np.int64),
        tuple((law.reads[0], 0.0) if law.reads else (None, float(law.factor({}))) for law in laws),
        initial_degC=USUAL_C if reference.start_C is None else reference.start_C,
    )


def reach_of(signal: Signal) -> float:
    """How far tables of an input reach, either way of zero."""
    return WIDER * max(abs(signal.low or 0.0), abs(signal.high or 0.0))


def _reaches(signals: Sequence[Signal]) -> Ranges:
    """Input -> how far tables have to reach; what marks a single test is not an input."""
    reach = {s.name: (s, reach_of(s)) for s in signals if not s.name.startswith(th.LAW_RUNNING)}
    return {name: (-end if s.low and s.low < 0.0 else 0.0, end) for name, (s, end) in reach.items()}


def _factors(every: th.Assembly, live: NDArray[np.bool_], acting: th.Array, reach: Ranges) -> list[Sum]:
    pairs = [(p, x) for p, x, on in zip(every.patterns, acting, live, strict=True) if on]
    return [
        tuple(replace(one, coefficient=float(x) * one.coefficient) for one in factors(p.name, p.law, reach))
        for p, x in pairs
    ]


def _range(reference: th.Reference, name: str) -> tuple[float | None, float | None]:
    one = reference.signals.get(name)
    return (None, None) if one is None else (one.low, one.high)


def unit_of(network: Network, name: str) -> str:
    """The unit of an input, as memory holds it; "1" where nobody says."""
    quantity = network.measures(name)
    units = th.QUANTITIES[quantity].units if quantity in th.QUANTITIES else {}
    return next(iter(units), "1")


def outputs(network: Network, folder: th.Folder, limits: Mapping[str, float]) -> tuple[Output, ...]:
    """All named temperatures with their limits and, where a sensor sits, its error when the model was fitted."""
    case = folder.case
    free = case.model.reference is None and case.tests
    of_sensors = th.errors(case).sensor_errors if free else th.standing_reference(case).errors
    error_of = {f"sensor {name}": error for name, error in of_sensors.items()}
    rows = th.mean_rows(network) | {f"sensor {n}": c.row for n, c in sorted(th.sensors(folder).items())}
    for place in limits:
        if place not in rows:
            raise InputError(f"no temperature '{place}' to limit", "--limit", th.suggestion(place, rows))
    return tuple(Output(n, row, limits.get(n), *error_of.get(n, (None, ""))) for n, row in rows.items())
