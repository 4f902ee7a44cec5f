"""Random operating points of every machine family and circuit, against correlations called directly.

    python benchmarks/operating_points.py [--points 200] [--json FILE]

Every film of every library machine, and of circuits of one and of several branches with every coolant, at random speeds
(0 to 3 times the rated one), flows (0 to 4 times), coolant from -40 to 130 degC where it is a liquid, air from -40 to
150 degC and, of declared films, up to 4,000 m. The network's coefficient is held against the correlation at the true
state; beside it the shares of branches against equal pressure drop, and at rest the heat in against the heat out.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from geom import load_machine
from geom.errors import InputError
from lumped.circuits.circuit import film_in
from lumped.circuits.hydraulics import parallel_shares
from lumped.correlations.air_gap import taylor_film
from lumped.declarations.circuit import read_circuits
from lumped.declarations.films import FORCED, over
from lumped.declarations.network import read_network
from lumped.integration.steady import steady
from lumped.machine.films import Surroundings, surroundings
from lumped.machine.jackets import FLOW, channel_of, liquid, onto_outlet
from lumped.machine.outer import cowl_of, outer_films
from lumped.machine.shapes import extent
from lumped.schemas.reader import Table
from lumped.transfer.laws import Law
from lumped.transfer.properties import air
from lumped.transfer.ranges import within_silence
from lumped.transfer.terms_value import coefficient

MACHINES = Path("geom/machines")
ALLOWED = 0.02
CHANNEL = {"wall": "housing", "width_mm": 20, "height_mm": 6, "length_m": 1.2, "bends": 2}
COIL = {**CHANNEL, "length_m": 3.0, "coil_diameter_mm": 250}
COOLANTS = (
    {"name": "water"},
    {"name": "ethylene glycol", "mass_percent": 50},
    {"name": "propylene glycol", "volume_percent": 40},
)
CIRCUITS: dict[str, list[dict[str, object]]] = {
    "one channel": [CHANNEL],
    "a coil": [COIL],
    "two branches": [{**CHANNEL, "branch": "a"}, {**COIL, "branch": "b"}],
    "three branches": [{**CHANNEL, "branch": b, "length_m": x} for b, x in (("a", 0.5), ("b", 1.5), ("c", 5.0))],
}
MOVING: dict[str, dict[str, float]] = {
    "plate": {"size_m": 0.5},
    "cylinder": {"size_m": 0.3},
    "fin channel": {"size_m": 0.25, "diameter_mm": 20.0, "speed_at_end": 0.2},
    "duct": {"size_m": 0.3, "diameter_mm": 20.0},
    "helical pipe": {"diameter_mm": 9.0, "coil_diameter_mm": 200.0},
    "end space": {},
}
HIGHEST_M = 4000.0
Pair = tuple[float, float]  # ours, the correlation's


def main() -> int:
    """The table, and 1 where anything is off by more than ALLOWED."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with within_silence():
        found = {name: worst(pairs) for name, pairs in subjects(options.points)}
    for name, (off, count) in found.items():
        print(f"{name:45} {count:5} points  worst {100.0 * off:5.2f} %")
    if options.json:
        options.json.write_text(json.dumps(found, indent=1))
    return int(any(off > ALLOWED for off, _ in found.values()))


def worst(pairs: list[Pair]) -> tuple[float, int]:
    """The largest relative difference, and of how many."""
    return max((abs(a / b - 1.0) if b else abs(a) for a, b in pairs), default=0.0), len(pairs)


def subjects(count: int) -> Iterator[tuple[str, list[Pair]]]:
    """Everything that is asked, by name."""
    rng = np.random.default_rng(48)
    for file in sorted(MACHINES.glob("*.toml")):
        yield from machine_points(file.stem, count, rng)
    for coolant in COOLANTS:
        for name, passes in CIRCUITS.items():
            circuit = f"{name}, {coolant['name']}"
            yield from circuit_points(circuit, {"coolant": coolant, "passes": passes}, count, rng)
    for surface in MOVING:
        yield f"declared: {surface}", list(declared_points(surface, count, rng))


def declared_points(surface: str, count: int, rng: np.random.Generator) -> Iterator[Pair]:
    """Moving air of network.toml at 0 to 3 times the largest speed that is expected (20 m/s), at five altitudes."""
    for k in range(5):
        high = rng.uniform(0.0, HIGHEST_M)
        data = {"surface": surface, "speed": "v", "up_to_m_s": 20.0, "altitude_m": high, **MOVING[surface]}
        law = over(Table(dict(data), surface))
        for _ in range(k * count // 5, (k + 1) * count // 5):
            v, hot, cold = rng.uniform(0.0, 60.0), rng.uniform(-40.0, 150.0), rng.uniform(-40.0, 80.0)
            exact = FORCED[surface](Table(dict(data), surface), air(0.5 * (hot + cold), high))(v)[0]
            yield coefficient(law, {"v": np.array([v])}, hot, cold), exact


def machine_points(name: str, count: int, rng: np.random.Generator) -> Iterator[tuple[str, list[Pair]]]:
    """Gap, jackets and shields of a machine."""
    machine = load_machine(name)
    around = surroundings(machine, ())
    if around.gap is not None:
        yield f"{name} gap", [gap_point(around, rng) for _ in range(count)]
    for jacket in around.cooling.feeds if around.cooling else ():
        yield f"{name} {jacket}", [p for _ in range(count) if (p := jacket_point(around, jacket, rng))]
    if (cowl := cowl_of(machine)) is not None:
        for part in (p.name for p in machine.parts if "cap" in p.name):
            laws, high = outer_films(machine, part, around.films), extent(machine.part(part)).size[1]
            if "blown" not in laws:
                continue
            share = cowl.rear_share if part.endswith(cowl.rear) else cowl.front_share
            scale = share * cowl.air_speed / cowl.at_rpm
            yield f"{name} {part}", [blown_point(laws, scale, high, cowl.at_rpm, rng) for _ in range(count)]


def gap_point(around: Surroundings, rng: np.random.Generator) -> Pair:
    from lumped.machine.air import gap_film

    assert around.gap is not None
    rpm, T = rng.uniform(0.0, 3.0) * around.usual_rpm, rng.uniform(-40.0, 150.0)
    law = gap_film(around.gap, around.usual_rpm)
    exact = taylor_film(rpm * np.pi / 30.0, around.gap.rotor_radius, around.gap.width, air(T))[0]
    return coefficient(law, {"speed_rpm": np.array([rpm])}, T, T), exact


def jacket_point(around: Surroundings, jacket: str, rng: np.random.Generator) -> Pair | None:
    assert around.cooling is not None
    cooling, T = around.cooling, rng.uniform(-40.0, 130.0)
    flow, wet = rng.uniform(0.0, 4.0) * cooling.flow_l_min, rng.uniform(1e-4, 1e-2)
    try:
        fluid = liquid(cooling.coolant, T)
    except InputError:
        return None
    h = channel_of(around.machine, jacket).film(cooling.share(jacket) * flow, fluid)[0]
    rate = cooling.liquid.rho * cooling.liquid.cp * cooling.share(jacket) * flow / 6e4
    law = onto_outlet(around.machine, jacket, cooling, wet)
    got = coefficient(law, {FLOW: np.array([flow])}, T, 0.0)
    return (got * wet / rate, float(np.expm1(h * wet / rate))) if h * wet < 5.0 * rate else None


def blown_point(laws: dict[str, Law], scale: float, high: float, rated: float, rng: np.random.Generator) -> Pair:
    from lumped.correlations.forced import flat_plate
    from lumped.correlations.natural import churchill_chu_plate

    rpm, cold, rise = rng.uniform(0.0, 3.0) * rated, rng.uniform(-40.0, 50.0), rng.uniform(0.5, 150.0)
    at = {"speed_rpm": np.array([rpm])}
    still = churchill_chu_plate(high, cold + rise, cold)[0]
    blown = flat_plate(scale * rpm, high, air(cold + 0.5 * rise))[0]
    got = sum(coefficient(laws[k], at, cold + rise, cold) for k in ("natural", "blown"))
    return got, float(np.cbrt(still**3 + blown**3))


def circuit_points(
    name: str, data: dict[str, object], count: int, rng: np.random.Generator
) -> Iterator[tuple[str, list[Pair]]]:
    """Films and shares of a circuit, and at rest what its network takes up and gives."""
    table = {"at_degC": 60.0, "flow_l_min": 8.0, "flow_l_min_input": FLOW, "inlet": "inlet", **data}
    circuit = read_circuits(Table({"circuits": {"c": dict(table)}}, "t"), ["housing"], ["inlet"])["c"]
    network = read_network(
        {
            "network": {"name": name, "boundaries": ["inlet"]},
            "nodes": {"housing": {"C_J_K": 2e4}},
            "losses": {"all": {"kind": "constant", "at": "housing", "P_W": 2000.0}},
            "circuits": {"c": dict(table)},
        }
    )
    films = [x for x in network.links if x.name.startswith("film:")]
    streams = [x for x in network.links if x.name.startswith("stream:c.")]
    shares, closed = [], []
    stretched: list[Pair] = []
    for _ in range(count):
        T, flow = rng.uniform(-40.0, 130.0), rng.uniform(0.01, 4.0) * 8.0
        try:
            fluid = circuit.liquid(T)
        except InputError:
            continue
        ducts = [[p.duct for p in passes] for passes in circuit.branches.values()]
        split = parallel_shares(ducts, flow / 6e4, fluid)
        at = {FLOW: np.array([flow])}
        for film, duct, share in zip(films, (d for ds in ducts for d in ds), split, strict=True):
            rate, area = circuit.heat * flow / 6e4 * share, duct.wall / circuit.cells
            N = film_in(duct, flow / 6e4 * share, fluid)[0] * area / rate
            if N < 4.0:
                stretched.append((float(np.log1p(coefficient(film.law, at, T, 0.0) / rate)), N))
        whole = circuit.heat * flow / 6e4
        shares += [(coefficient(x.law, at, T, 0.0) / whole, s) for x, s in zip(streams, split, strict=False)]
        if len(closed) < 20 and flow > 2.0 and T < 60.0:
            rest = steady(network, {FLOW: flow}, {"inlet": T})
            closed.append((circuit.heat * flow / 6e4 * (rest["c.outlet"] - T), 2000.0))
    yield f"{name}: films", stretched
    yield f"{name}: heat at rest", closed
    if streams:
        yield f"{name}: shares", shares


if __name__ == "__main__":
    raise SystemExit(main())
