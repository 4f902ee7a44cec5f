"""Any network as the two resistances of the paper's fig. 10, and one model's values on other machines.

R_w lies from the winding to the machine, R_ext to ambient:

T_m = T_a + R_ext P          T_w = T_m + R_w P_w         P_w copper loss, P all losses

The two come from one steady state; what they leave over is how far they miss other loads and the transient. Calibrated
values go to networks of machines that were not used, and are tested there.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from thermoscope import InputError, Network, Steady, ThermoscopeError, plugin as th, steady


@dataclass(frozen=True)
class TwoPaths:
    """R_ext, R_w (K/W) at one load;  winding_K, machine_K : rises there;  P_w, P_all (W)

    residual : load (share of the current) -> (winding, machine) K that the two resistances miss; without those loads
    at which the machine does not come to rest
    """

    R_ext: float
    R_w: float
    winding_K: float
    machine_K: float
    P_w: float
    P_all: float
    residual: Mapping[float, tuple[float, float]]

    def rises(self, P_w: float, P_all: float) -> tuple[float, float]:
        """Winding and machine over ambient (K)."""
        machine = self.R_ext * P_all
        return machine + self.R_w * P_w, machine

    @property
    def largest_K(self) -> float:
        return max((abs(v) for pair in self.residual.values() for v in pair), default=0.0)

    def document(self) -> dict[str, Any]:
        plain = {k: v for k, v in vars(self).items() if k != "residual"}
        residual = {f"{k:g}": list(v) for k, v in self.residual.items()}
        return {**plain, "largest_residual_K": self.largest_K, "residual_K": residual}


def two_paths(
    network: Network,
    inputs: Mapping[str, float],
    ambient: float = 20.0,
    winding: str = "winding.copper",
    machine: str = "magnets",
    loads: Sequence[float] = (0.5, 0.75, 1.25),
    values: Mapping[str, float] | None = None,
) -> TwoPaths:
    """R_ext and R_w of a network at one load, and what they miss at others.

    inputs : the load; `loads` are shares of its inputs that are currents
    winding, machine : the places whose means T_w and T_m are
    """
    for place in (winding, machine):
        network.place(place)
    rated = _state(network, inputs, ambient, (winding, machine), values)
    T_w, T_m, P_w, P_all = rated
    if P_w <= 0 or P_all <= 0:
        raise InputError("no copper loss at this load", network.name, "a load with a current")
    paths = TwoPaths((T_m - ambient) / P_all, (T_w - T_m) / P_w, T_w - ambient, T_m - ambient, P_w, P_all, {})
    residual = {}
    for share in loads:
        level = {n: v * (share if network.measures(n) == "current" else 1.0) for n, v in inputs.items()}
        try:
            T_w, T_m, P_w, P_all = _state(network, level, ambient, (winding, machine), values)
        except ThermoscopeError:  # at this load the machine runs away
            continue
        expected = paths.rises(P_w, P_all)
        residual[share] = (expected[0] - (T_w - ambient), expected[1] - (T_m - ambient))
    return TwoPaths(paths.R_ext, paths.R_w, paths.winding_K, paths.machine_K, paths.P_w, paths.P_all, residual)


def of_test(
    case: th.MeasuredCase, test: th.Test, winding: str = "winding.copper", machine: str = "magnets"
) -> TwoPaths:
    """The case's model at the mean load of one of its tests."""
    network, values = th.heat_model(th.standing(case), th.physical(case))
    load = {name: float(np.mean(v)) for name, v in test.inputs.items()}
    air = float(np.mean([np.mean(v) for v in test.boundaries.values()]))
    return two_paths(network, load, air, winding, machine, values=values)


def _state(
    network: Network, inputs: Mapping[str, float], ambient: float, at: tuple[str, str], values: Mapping | None
) -> tuple[float, float, float, float]:
    """T_w, T_m (degC), P_w, P_all (W) at rest."""
    rows = [network.places[place].mean for place in at]
    state = steady(network, inputs, dict.fromkeys(network.boundaries, ambient), values, rows)
    more = th.multipliers(network, values)
    power = {s.name: more.get(s.name, 1.0) * power_of(s, inputs, state) for s in network.sources}
    copper = sum(power[s.name] for s in network.sources if s.kind == "copper")
    return float(state.y[0]), float(state.y[1]), copper, sum(power.values())


def power_of(source: th.Source, inputs: Mapping[str, float], state: Steady) -> float:
    """Loss (W) of a source at rest, before the multipliers of parameters."""
    one = {name: np.array([float(value)]) for name, value in inputs.items()}
    factor = float(np.ravel(source.law.factor(one))[0])
    law = source.law.temperature
    if not isinstance(law, th.Constant | th.Linear | th.Conductivity):
        raise InputError(
            f"loss '{source.name}' follows a {type(law).__name__}", "two resistances", "constant, or as copper does"
        )
    T = source.probe.at(state.z)
    return factor * th.temperature_value(law, T, T)


COVERAGE = 2.0  # standard uncertainties: 95 %
LIMITS = np.sqrt(6.0)  # of a sum of two even errors of one size, both at their limit, over its standard deviation
LATE = 0.25  # share of a test at its end that is compared: where it has settled


@dataclass(frozen=True)
class Row(th.TableRow):
    """One sensor in one test, means over the settled end (degC).

    U95_K : 95 % uncertainty of the measurement;  worst_K : its worst case, cold and hot meter both at their limits, the
    bound that the procedure's paper holds the difference against
    """

    properties = ("difference_K", "within")

    test: str
    channel: str
    measured_C: float
    simulated_C: float
    U95_K: float
    worst_K: float

    @property
    def difference_K(self) -> float:
        return self.measured_C - self.simulated_C

    @property
    def within(self) -> bool:
        return abs(self.difference_K) <= self.worst_K


@dataclass(frozen=True)
class Transfer:
    """A case with another case's values: what was taken over, and how it stands."""

    case: th.MeasuredCase
    parameters: tuple[str, ...]
    rows: tuple[Row, ...]

    @property
    def agrees(self) -> bool:
        return all(r.within for r in self.rows)

    def document(self) -> dict[str, Any]:
        parameters, rows = list(self.parameters), [r.document() for r in self.rows]
        return {"case": self.case.name, "parameters": parameters, "agrees": self.agrees, "rows": rows}


def transferred(source: th.MeasuredCase, target: th.MeasuredCase) -> Transfer:
    """Values of parameters that both networks declare under one name; sensors' own ones and losses stay behind.

    What a machine loses is its own: its resistance is measured cold, its magnetic loss given.
    """
    theirs = {p.name for p in target.model.network.parameters if not p.name.startswith("loss.")}
    values = {k: v for k, v in th.physical(source).items() if k in theirs}
    case = th.with_model(target, replace(target.model, values={**target.model.values, **values}))
    return Transfer(case, tuple(values), tuple(end_errors(case)))


def end_errors(case: th.MeasuredCase) -> list[Row]:
    """Every channel of every test at its end, against the model as it stands."""
    network = th.standing(case)
    out = []
    for test in case.tests:
        y = th.predict(network, test, th.physical(case)).y
        late = test.time >= test.time[-1] - LATE * (test.time[-1] - test.time[0])
        for j, c in enumerate(test.channels):
            rows = late & np.isfinite(c.y)
            if rows.any():
                means = float(c.y[rows].mean()), float(y[rows, j].mean())
                out.append(Row(test.name, c.name, *means, COVERAGE * c.sigma_K, float(LIMITS * c.sigma_K)))
    return out
