"""Which film washes which face of a motor, as coefficient laws by mechanism."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from lumped.laws import Inputs, Law, Radiation, Table
from lumped.motor_air import Duct, channel_film, duct_of, gap_film, stirred
from lumped.motor_coolant import Cooling, cooling_of, jacket_film
from lumped.motor_outer import outer_films
from lumped.motor_path import stem
from lumped.motor_settings import Fan, Films, read_fan, read_films
from lumped.motor_shapes import Gap, gap_of, turning

TOP_RPM = 3000.0  # films of speed are tabulated at least this far


@dataclass(frozen=True)
class Surroundings:
    """What the films of one machine depend on. contacts : names "a|b", which tell what turns."""

    machine: Any
    contacts: tuple[str, ...]

    @cached_property
    def films(self) -> Films:
        return read_films(self.machine)

    @cached_property
    def fan(self) -> Fan | None:
        return read_fan(self.machine)

    @cached_property
    def gap(self) -> Gap | None:
        return gap_of(self.machine)

    @cached_property
    def duct(self) -> Duct | None:
        return duct_of(self.machine)

    @cached_property
    def cooling(self) -> Cooling | None:
        return cooling_of(self.machine)

    @cached_property
    def turning(self) -> frozenset[str]:
        return turning(self.contacts)

    @cached_property
    def top_rpm(self) -> float:
        return max(TOP_RPM, 2.0 * float(self.machine.sections.get("ratings", {}).get("speed_rpm", 0.0)))


def surroundings(machine: Any, contacts: Iterable[str]) -> Surroundings:
    return Surroundings(machine, tuple(contacts))


def face_films(part: str, fluid: str, around: Surroundings) -> dict[str, Law]:
    """Mechanism -> law for one face; mechanisms act in parallel."""
    films, gap = around.films, around.gap
    if fluid == "ambient":
        return outer_films(around.machine, part, films)
    if around.cooling is not None and stem(fluid) in around.cooling.feeds:
        return {"": jacket_film(around.machine, stem(fluid), around.cooling)}
    if gap is None:
        return {}
    if fluid == "airgap":
        return {"": gap_film(gap, around.top_rpm)}
    if around.duct is not None and fluid == "air.interpolar":
        axial = {} if around.fan is None else {"axial": channel_film(around.duct)}
        return {**axial, "stirred": stirred(films.channel_wall_share, films, gap, around.top_rpm)}
    share = films.moving_wall_share if part in around.turning else films.still_wall_share
    return {"": stirred(share, films, gap, around.top_rpm)}


def nominal(laws: Mapping[str, Law], inputs: Inputs, difference: float = 30.0) -> float:
    """What all mechanisms add up to (W/m2/K) at an operating point, `difference` (K) above 20 degC."""
    total = 0.0
    for law in laws.values():
        value = float(np.mean(law.factor(inputs)))
        if isinstance(law.temperature, Table):
            value *= float(np.interp(difference, law.temperature.difference, law.temperature.value))
        elif isinstance(law.temperature, Radiation):
            hot, cold = 293.15 + difference, 293.15
            value *= 5.670374e-8 * (hot**2 + cold**2) * (hot + cold)
        total += value
    return total
