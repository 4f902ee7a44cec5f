"""Is it said where a run leaves the range of a correlation: every table that is made of one, at random points.

    python benchmarks/drawn/table_ends.py [--points 200]

Tables of library machines, of circuits with each coolant and of every surface of network.toml, at -40 to 150 degC, 0 to
4 times the usual speed, flow or difference, and at some far beyond. What a run says is held against what the
correlation says of itself there. Points beside an end, to 3 % and 1 K, are left out.
"""

import argparse
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from geom import load_machine
from geom.errors import InputError
from lumped.circuits import circuit
from lumped.correlations.info import Info
from lumped.correlations.streams import streamed
from lumped.correlations.tabulate import film_tabulated
from lumped.declarations import films
from lumped.declarations.circuit import read_circuits
from lumped.declarations.links import ROTATING, gap, rotating
from lumped.integration.record import Record
from lumped.integration.simulate import simulate
from lumped.machine import air, jackets, outer
from lumped.machine.films import face_films, surroundings
from lumped.model.build import bare_network, node_link
from lumped.model.network import NOTHING
from lumped.schemas.reader import Table
from lumped.transfer.laws import FilmTable, Fixed, Law, StreamTable
from lumped.transfer.properties import Fluid
from lumped.transfer.ranges import within_silence

MACHINES = Path("geom/machines")
CHANNEL = {"wall": "housing", "width_mm": 20, "height_mm": 6, "length_m": 1.2, "bends": 2}
COIL = {**CHANNEL, "length_m": 3.0, "coil_diameter_mm": 250}
BORE = {"wall": "housing", "diameter_mm": 20, "length_m": 0.4}
NOZZLES = {"wall": "housing", "nozzles": 8, "nozzle_mm": 1.5, "area_m2": 0.05, "run_mm": 60}
COOLANTS: tuple[dict[str, object], ...] = (
    {"name": "water", "pressure_bar": 3.0},
    {"name": "ethylene glycol", "mass_percent": 50},
    {"name": "propylene glycol", "volume_percent": 40},
    {"name": "oil"},
    {"name": "ATF"},
)
MOVING: dict[str, dict[str, float]] = {
    "plate": {"size_m": 0.5},
    "cylinder": {"size_m": 0.3},
    "fin channel": {"size_m": 0.25, "diameter_mm": 20.0, "speed_at_end": 0.2},
    "duct": {"size_m": 0.3, "diameter_mm": 20.0},
    "helical pipe": {"diameter_mm": 9.0, "coil_diameter_mm": 200.0},
    "end space": {},
}
STANDING: dict[str, dict[str, float]] = {
    "horizontal cylinder": {"size_m": 0.3},
    "vertical plate": {"size_m": 0.3},
    "plate facing up": {"size_m": 0.05},
    "plate facing down": {"size_m": 0.05},
    "vertical cylinder": {"size_m": 0.3, "diameter_mm": 100.0},
    "vertical fins": {"size_m": 0.2, "depth_mm": 20.0, "spacing_mm": 12.0},
    "horizontal fins": {"spacing_mm": 12.0},
    "parallel plates": {"size_m": 0.2, "spacing_mm": 8.0},
}
IN_LIQUID = ("plate", "cylinder", "duct", "helical pipe")
STILL_K = (0.2, 180.0)  # of differences: where tables of still air begin and end
BESIDE = tuple((x, dT) for x in (0.97, 1.0, 1.03) for dT in (-1.0, 0.0, 1.0))


@dataclass(frozen=True)
class Tabled:
    """A table of a correlation.

    usual : |input| or difference (K);  info : what the correlation says of itself at one and a temperature (degC)
    liquid : T (degC) -> Fluid, of a table that follows the fluid's own temperature
    """

    law: Law
    usual: float
    info: Callable[[float, float], Info]
    liquid: Callable[[float], Fluid] | None = None

    @property
    def still(self) -> bool:
        return isinstance(self.law.temperature, FilmTable)

    @property
    def of(self) -> str | None:
        return self.law.temperature.of if isinstance(self.law.temperature, StreamTable) else None


def main() -> int:
    """How many points lie outside, correlation by correlation, and how many of these are not told: 1 if any."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", type=int, default=200)
    found = ends(every_table(sorted(file.stem for file in MACHINES.glob("*.toml"))), parser.parse_args().points)
    for name, (points, outside, silent, wrong) in sorted(found.items()):
        print(f"{name:25} {points:6} points, {outside:5} outside, {silent:3} of these silent, {wrong:3} told inside")
    return int(any(silent or wrong for _, _, silent, wrong in found.values()))


def ends(tables: Iterable[Tabled], count: int) -> dict[str, tuple[int, int, int, int]]:
    """Correlation -> points that were tried, outside its range, outside in silence, and told though inside."""
    rng, out = np.random.default_rng(48), dict[str, np.ndarray]()
    for table in tables:
        domain = getattr(table.law.temperature, "domain", None)
        name = domain.what.partition(":")[0] if domain else "none"
        out[name] = out.get(name, np.zeros(4, int)) + asked(table, count, rng)
    return {name: tuple(counts.tolist()) for name, counts in out.items()}


def asked(table: Tabled, count: int, rng: np.random.Generator) -> np.ndarray:
    """(4,) of one table."""
    out = np.zeros(4, int)
    for _ in range(count):
        T = rng.uniform(-40.0, 130.0 if table.liquid else 150.0)
        size = table.usual * (rng.uniform(0.0, 4.0) if rng.random() < 0.7 else 10.0 ** rng.uniform(-4.0, 3.0))
        size = float(np.clip(size, *STILL_K)) if table.still else size
        with within_silence():
            try:
                at = {bool(table.info(x * size, T + dT).outside) for x, dT in BESIDE}
            except InputError:  # it freezes or boils
                continue
        if len(at) == 1:
            outside, said = True in at, bool(warned(table, size, T))
            out += np.array([1, outside, outside and not said, said and not outside])
    return out


def warned(table: Tabled, size: float, T: float) -> list[str]:
    """What a short run says at a temperature of the fluid (degC) and an |input|, or a difference of still air (K)."""
    half = 0.5 * size if table.still else 0.0
    network = bare_network("one film", {"wall": 1e9}, ("fluid",))
    link = node_link(network, "film", "film", "wall", "fluid", table.law)
    link = replace(link, cold=NOTHING) if table.liquid else link
    record = Record(np.array([0.0, 1e-3]), {table.of: size} if table.of else {}, {"fluid": T - half}, T + half)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        simulate(network.extended([link], [], ()), record)
    return [str(w.message) for w in caught]


@contextmanager
def tables() -> Iterator[list[Tabled]]:
    """Every table of a correlation that is made meanwhile, by whomever."""
    found: list[Tabled] = []

    def moving(of: Any, usual: float, film: Any, fluid: Any, degC: float, liquid: bool, *more: Any, **keys: Any) -> Law:
        law = streamed(of, usual, film, fluid, degC, liquid, *more, **keys)
        found.append(Tabled(law, usual, lambda size, T: film(size, fluid(T))[1], fluid if liquid else None))
        return law

    def still(film: Any, *grid: Any) -> FilmTable:
        table = film_tabulated(film, *grid)
        found.append(Tabled(Fixed(1.0, table), 50.0, lambda d, T: film(T + 0.5 * d, T - 0.5 * d)[1]))
        return table

    with ExitStack() as stack:
        for module in (jackets, outer, air, circuit, films):
            for name, made in (("streamed", moving), ("film_tabulated", still)):
                if hasattr(module, name):
                    stack.enter_context(patch.object(module, name, made))
        _forget()
        yield found
    _forget()


def _forget() -> None:
    jackets._film.cache_clear()
    outer.still_air.cache_clear()


def every_table(machines: Iterable[str], coolants: Sequence[Mapping[str, object]] = COOLANTS) -> list[Tabled]:
    """Of machines, of circuits with each coolant, and of every surface of network.toml."""
    with tables() as found:
        for name in machines:
            of_machine(name)
        for coolant in coolants:
            of_circuits(coolant)
            for surface in IN_LIQUID:
                films.over(_declared(surface, {**MOVING[surface], "speed": "v", "up_to_m_s": 2.0, "coolant": coolant}))
        for surface, keys in MOVING.items():
            films.over(_declared(surface, {**keys, "speed": "v", "up_to_m_s": 20.0}))
        for surface, keys in STANDING.items():
            films.natural(_declared(surface, keys))
        for law in ("taylor", "becker-kaye"):
            gap(Table({"law": law, "rotor_radius_mm": 50.0, "gap_mm": 1.0}, law))
        for surface in ROTATING:
            rotating(_declared(surface, {"diameter_mm": 100.0}))
    return found


def _declared(surface: str, keys: Mapping[str, object]) -> Table:
    return Table({"surface": surface, **keys}, surface)


def of_circuits(coolant: Mapping[str, object]) -> None:
    """One of each kind, and a channel beside a coil."""
    for passes in ([CHANNEL], [COIL], [BORE], [NOZZLES], [{**CHANNEL, "branch": "a"}, {**COIL, "branch": "b"}]):
        flow = {"at_degC": 60.0, "flow_l_min": 8.0, "flow_l_min_input": "flow_l_min", "inlet": "inlet"}
        data = {"circuits": {"c": {"coolant": dict(coolant), "passes": passes, **flow}}}
        (one,) = read_circuits(Table(data, "circuit"), ["housing"], ["inlet"]).values()
        one.links(bare_network("c", {"housing": 1.0, **one.capacities()}, ("inlet",)))


def of_machine(name: str) -> None:
    """Gap, jackets, the fan's ways, outer faces."""
    machine = load_machine(name)
    around = surroundings(machine, ())
    if around.gap is not None:
        air.gap_film(around.gap, around.usual_rpm)
    for jacket in around.cooling.feeds if around.cooling else ():
        assert around.cooling
        jackets.jacket_film(machine, jacket, around.cooling)
    for way in around.ways.ducts if around.ways else ():
        face_films("poles", way, around)
    for part in machine.parts:
        outer.outer_films(machine, part.name, around.films)


if __name__ == "__main__":
    sys.exit(main())
