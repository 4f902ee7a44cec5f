"""Which film washes which face of a motor, as coefficient laws by mechanism."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial

from geom.description.machine import Machine
from geom.description.roles import Role
from lumped.machine.air import Ways, channel_film, gap_film, stirred, ways_of
from lumped.machine.jackets import Cooling, cooling_of, jacket_film
from lumped.machine.outer import outer_films
from lumped.machine.part_identities import turning
from lumped.machine.path import stem
from lumped.machine.settings import Fan, Films, read, read_films
from lumped.machine.shapes import Gap, gap_fluid, radius
from lumped.machine.sprays import Spray, spray_of
from lumped.transfer.laws import AtUsualTemperature, Inputs, Law
from lumped.transfer.terms_value import coefficient

USUAL_RPM = 1500.0  # where a machine file rates none: films of speed are tabulated around it


@dataclass(frozen=True)
class Surroundings:
    """What the films of one machine depend on. contacts : names "a|b", which tell what turns."""

    machine: Machine
    contacts: tuple[str, ...]

    @cached_property
    def films(self) -> Films:
        return read_films(self.machine)

    @cached_property
    def fan(self) -> Fan | None:
        table = {key: value for key, value in self.machine.sections.get("fans", {}).items() if key != "cowl"}
        return read(Fan, table, f"{self.machine.name} [fans]") if table else None

    @cached_property
    def gap(self) -> Gap | None:
        machine = self.machine
        if not any(part.role is Role.AIR_GAP for part in machine.fluids):
            return None
        (profile, _, _), *_ = machine.part(gap_fluid(machine)).prisms
        if not profile.holes:
            return None
        outer, inner = radius(profile.outer), radius(profile.holes[0])
        height = machine.features.air_gap
        return Gap(inner, outer - inner if height is None else height)

    @cached_property
    def gaps(self) -> frozenset[str]:
        """Fluids that are the air gap."""
        return frozenset(part.name for part in self.machine.fluids if part.role is Role.AIR_GAP)

    @cached_property
    def ways(self) -> Ways | None:
        """Of the fan's air along the axis."""
        return None if self.fan is None else ways_of(self.machine, self.fan)

    @cached_property
    def cooling(self) -> Cooling | None:
        return cooling_of(self.machine)

    @cached_property
    def spray(self) -> Spray | None:
        return spray_of(self.machine)

    @cached_property
    def turning(self) -> frozenset[str]:
        return turning(self.machine, self.contacts)

    @cached_property
    def tip_radius(self) -> float:
        """Of the rotor (m), or where no air gap is known, as in an imported machine, of the largest part that turns."""
        if self.gap is not None:
            return self.gap.rotor_radius
        rotating = [part for part in self.machine.parts if part.name in self.turning]
        return max((radius(profile.outer) for part in rotating for profile, _, _ in part.prisms), default=0.0)

    @cached_property
    def usual_rpm(self) -> float:
        """Rated speed, or what is usual."""
        return float(self.machine.sections.get("ratings", {}).get("speed_rpm", 0.0)) or USUAL_RPM


def surroundings(machine: Machine, contacts: Iterable[str]) -> Surroundings:
    return Surroundings(machine, tuple(contacts))


def face_films(part: str, fluid: str, around: Surroundings) -> dict[str, Law]:
    """Mechanism -> law for one face; mechanisms act in parallel."""
    films, gap = around.films, around.gap
    if fluid == "ambient":
        return outer_films(around.machine, part, films)
    if around.cooling is not None and stem(fluid) in around.cooling.feeds:
        return {"": jacket_film(around.machine, stem(fluid), around.cooling)}
    if around.spray is not None and around.spray.wets(part, fluid):
        return {"spray": AtUsualTemperature(around.spray.film(part))}
    if gap is not None and fluid in around.gaps:
        return {"": gap_film(gap, around.usual_rpm)}
    ducts, ways = around.machine.features.ducts, around.ways
    if fluid in ducts and ducts[fluid].turns and ways is not None and fluid in ways.rated:
        return {"axial": channel_film(ducts[fluid], partial(ways.share, fluid), ways.fan.flow_m3_h)}
    if fluid in ducts and not ducts[fluid].turns:
        axial = {} if ways is None else {"axial": channel_film(ducts[fluid], ways.past, ways.fan.flow_m3_h)}
        return {**axial, "stirred": stirred(films.channel_wall_share, films, around.tip_radius)}
    share = films.moving_wall_share if part in around.turning else films.still_wall_share
    return {"": stirred(share, films, around.tip_radius)}


def nominal(laws: Mapping[str, Law], inputs: Inputs, difference: float = 30.0) -> float:
    """What all mechanisms add up to (W/m2/K) at an operating point, `difference` (K) above 20 degC."""
    return sum(coefficient(law, inputs, 20.0 + difference, 20.0) for law in laws.values())
