"""One design: its machine, where that comes to rest, what it costs, and by how much it misses a limit."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from extras.rating.optimisation.electrics import Driven, Electrics, auxiliary_power
from extras.rating.optimisation.rest import Rest, losses, rest, without_feedback
from extras.rating.optimisation.scaling import Scaling
from extras.rating.optimisation.space import NONE, Corrections, Space
from extras.rating.points import HotSpots
from thermoscope import InputError, Network, plugin as th

PEAK, SETTLING, COPPER, AUXILIARY = OBJECTIVES = ("peak_degC", "settling_s", "copper_W", "auxiliary_W")
IMPOSSIBLE = 1e9  # what a design costs that no file can describe
GEOMETRY = "geometry fits"


class Uncertainty(Protocol):
    """How sure a temperature at rest is."""

    def sd(
        self, values: Mapping[str, float], inputs: Mapping[str, float], boundaries: Mapping[str, float], row: th.Row
    ) -> float: ...


@dataclass(frozen=True)
class Performance:
    """objectives : OBJECTIVES -> value;  excess : limit -> share by which it is exceeded, at most 0 where it is met

    places : limited place -> degC;  inputs : of the network;  why : what is impossible about it, else ""
    """

    objectives: Mapping[str, float]
    excess: Mapping[str, float]
    places: Mapping[str, float] = field(default_factory=dict)
    inputs: Mapping[str, float] = field(default_factory=dict)
    why: str = ""

    @property
    def feasible(self) -> bool:
        return all(e <= 0.0 for e in self.excess.values())


@dataclass(frozen=True)
class Problem:
    """Everything that a design is judged by; goes to other processes as a whole.

    network : with `design_parameters`, at `values`;  inputs, boundaries : the operating point
    peak : how many of the limited places, from the first, make up the peak temperature that is minimised
    machine_at : values of variables -> machine;  scaling : of the network's own machine; both None for a network alone
    from_machine : inputs that a design's machine decides, such as flows;  aimed : OBJECTIVES that are minimised
    driven : the cycle that is the load, instead of the inputs' current and speed
    sure : widens temperatures to the upper end of their 95 % band
    """

    network: Network
    values: Mapping[str, float]
    inputs: Mapping[str, float]
    boundaries: Mapping[str, float]
    space: Space
    spots: tuple[HotSpots, ...]
    peak: int
    electrics: Electrics = field(default_factory=Electrics)
    machine_at: Callable[[Mapping[str, float]], th.MachineDescription] | None = None
    scaling: Scaling | None = None
    from_machine: tuple[str, ...] = ()
    corrections: Corrections = NONE
    sure: Uncertainty | None = None
    driven: Driven | None = None
    aimed: tuple[str, ...] = OBJECTIVES

    @cached_property
    def _without_feedback(self) -> Network:
        return without_feedback(self.network, max(s.limit for s in self.spots))

    def of(self, x: Sequence[float] | th.Array) -> Performance:
        """The design at a point of the space."""
        try:
            return self.judged(self.space.named(x))
        except InputError as error:
            return self._impossible(str(error))

    def judged(self, design: Mapping[str, float]) -> Performance:
        """The design at values of the variables. Raises InputError where no machine can be built there."""
        machine = None if self.machine_at is None else self.machine_at(design)
        inputs, lag = self._inputs(design, machine)
        scaled = {} if self.scaling is None or machine is None else self.scaling.of(machine, inputs)
        values = {**self.values, **scaled}
        rest, runaway = self._rest(values, inputs)
        share = self.space.share(design)
        copper = losses(self.network, values, inputs, rest.z, ("copper",)) * self.corrections.ratio(COPPER, share)
        places, slowest = self._temperatures(rest, values, inputs, share)
        hottest = max(list(places.values())[: self.peak])
        ambient = self.boundaries.get("ambient", 20.0)
        objectives = {
            PEAK: hottest,
            SETTLING: slowest * self.corrections.ratio(SETTLING, share),
            COPPER: copper,
            AUXILIARY: 0.0 if machine is None else auxiliary_power(machine, inputs, ambient),
        }
        excess = {f"{s.name} <= {s.limit:g} degC": places[s.name] / s.limit - 1.0 for s in self.spots}
        limits = self.electrics.excess(inputs, copper) if self.driven is None else lag
        return Performance(objectives, {**excess, **limits}, places, inputs, "runaway" * runaway)

    def _inputs(
        self, design: Mapping[str, float], machine: th.MachineDescription | None
    ) -> tuple[dict[str, float], dict[str, float]]:
        """Of the network; and what the drive misses of its cycle."""
        out = {**self.inputs, **{n: u for n, u in design.items() if n in self.inputs}}
        if machine is not None:
            rated = th.rated_inputs(machine)
            out |= {n: rated[n] for n in self.from_machine}
        if self.driven is None:
            return out, {}
        load, lag = self.driven.inputs(design)
        return out | {n: u for n, u in load.items() if n in out}, lag

    def _rest(self, values: Mapping[str, float], inputs: Mapping[str, float]) -> tuple[Rest, bool]:
        """The rest; where the machine would run away, with losses as at the limit: above it then."""
        at_rest = rest(self.network, values, inputs, self.boundaries)
        if at_rest is not None and at_rest.stable:
            return at_rest, False
        again = rest(self._without_feedback, values, inputs, self.boundaries)
        if again is None:
            raise InputError("the machine does not come to rest", self.network.title, "a way for heat to leave it")
        return again, True

    def _temperatures(
        self, rest: Rest, values: Mapping[str, float], inputs: Mapping[str, float], share: th.Array
    ) -> tuple[dict[str, float], float]:
        """Place -> degC, of the hottest point; the settling time (s) of the hottest of the first `peak` places."""
        around = float(np.mean(list(self.boundaries.values())))
        rows, out = {}, {}
        for s in self.spots:
            T, rows[s.name] = s.hottest(rest.z)
            out[s.name] = around + (T - around) * self.corrections.ratio(s.name, share)
            if self.sure is not None:
                out[s.name] += th.NORMAL_95 * self.sure.sd(values, inputs, self.boundaries, rows[s.name])
        hottest = max([s.name for s in self.spots][: self.peak], key=lambda name: out[name])
        return out, rest.settling(rows[hottest])

    def _impossible(self, why: str) -> Performance:
        limits = [f"{s.name} <= {s.limit:g} degC" for s in self.spots]
        limits += list(self.electrics.excess(self.inputs, 0.0) if self.driven is None else self.driven.inputs({})[1])
        return Performance(
            dict.fromkeys(OBJECTIVES, IMPOSSIBLE), {**dict.fromkeys(limits, 0.0), GEOMETRY: 1.0}, why=why
        )

    def limits(self) -> list[str]:
        """Names of all that can be exceeded, in one order."""
        return [n for n in self._impossible("").excess]
