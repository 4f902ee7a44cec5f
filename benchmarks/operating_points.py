"""Random operating points of every machine family and circuit, against correlations called directly.

    python benchmarks/operating_points.py [--points 200] [--json FILE] [--page]

Every film of every library machine - gap, jackets, outer faces with fins and a cowl's air, end space, a fan's air - and
of circuits of one and of several branches with every coolant, at random speeds (0 to 3 times the rated one), flows (0
to 4 times), coolant from -40 to 130 degC where it is a liquid, air from -40 to 150 degC and up to 4,000 m high. The
network's coefficient is held against the correlation at the true state; beside it the shares of branches
against equal pressure drop, and at rest the heat in against the heat out. A run that leaves the range of a correlation
has to say so (`drawn/table_ends.py`).
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from drawn.table_ends import BORE, CHANNEL, COIL, COOLANTS, MACHINES, MOVING, NOZZLES, STANDING, ends, every_table

from geom import Machine, load_machine
from geom.description.roles import Role
from geom.errors import InputError, ThermoscopeError
from lumped.build.crosscheck import coefficients, fluid_nodes, steady_state
from lumped.build.mesh_choice import MEANS
from lumped.build.pipeline import means_network, prepared, reduced
from lumped.circuits.circuit import film_in
from lumped.circuits.hydraulics import parallel_shares
from lumped.correlations.air_gap import taylor_film
from lumped.correlations.contacts import radiation_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.end_space import end_space
from lumped.correlations.fins import elenbaas, heiles
from lumped.correlations.forced import flat_plate
from lumped.correlations.natural import churchill_chu_cylinder, churchill_chu_plate, mcadams_plate
from lumped.declarations.circuit import read_circuits
from lumped.declarations.films import moving_surfaces, natural, over, still_surfaces
from lumped.declarations.network import read_network
from lumped.integration.steady import steady
from lumped.machine.air import Ways, gap_film, stirred
from lumped.machine.bases import on_every_base
from lumped.machine.films import Surroundings, face_films, surroundings
from lumped.machine.jackets import FLOW, LIQUIDS, channel_of, onto_outlet
from lumped.machine.motor import rated_inputs
from lumped.machine.outer import Outer, cowl_of, outer_films, outer_of
from lumped.machine.shapes import extent, fins_of
from lumped.model.network import Network
from lumped.schemas.reader import Table
from lumped.transfer.laws import Law
from lumped.transfer.properties import Fluid, air
from lumped.transfer.ranges import within_silence
from lumped.transfer.terms_value import coefficient
from lumped.transfer.thin_air import density, thin_film, thin_stream
from scripts.published import benchmark_parser, publish, table, write_json

ALLOWED = 0.02
CIRCUITS: dict[str, list[dict[str, object]]] = {
    "one channel": [CHANNEL],
    "a coil": [COIL],
    "a bore": [BORE],
    "nozzles": [NOZZLES],
    "two branches": [{**CHANNEL, "branch": "a"}, {**COIL, "branch": "b"}],
    "three branches": [{**CHANNEL, "branch": b, "length_m": x} for b, x in (("a", 0.5), ("b", 1.5), ("c", 5.0))],
}
HIGHEST_M = 4000.0
MOVERS = ("speed_rpm", "fan_flow_m3h")
AT_REST = ("ipmsm-48s8p-jacket", "series-dc-100kw-air", "series-dc-100kw-jacket-two", "tefc-industrial")
STEADY = 20  # points at rest: what leaves then is what comes in, of one network for all of them
PAGE = Path("docs/benchmarks.md")
Pair = tuple[float, float]  # ours, the correlation's
Key = tuple[str, str]  # what is asked, of what


def main() -> int:
    """The table, and 1 where anything is off by more than ALLOWED or a table ends in silence."""
    parser = benchmark_parser(__doc__)
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--page", action="store_true", help="put the table into docs/benchmarks.md")
    options = parser.parse_args()
    with within_silence():
        found = worst(subjects(options.points))
    asked = ends(every_table(file.stem for file in sorted(MACHINES.glob("*.toml"))), options.points)
    for (kind, of), (off, count) in found.items():
        print(f"{of:25} {kind:35} {count:6} points  worst {100.0 * off:5.2f} %")
    outside, silent, inside = (sum(counts[k] for counts in asked.values()) for k in (1, 2, 3))
    print(f"{outside} points outside a correlation, {silent} of them in silence; {inside} told that are inside")
    write_json(options.json, [[*key, *value] for key, value in found.items()])
    if options.page:
        publish(PAGE, "operating-points", points_tables(found, asked))
    return int(bool(silent or inside) or any(off > ALLOWED for off, _ in found.values()))


def worst(pairs: Iterable[tuple[Key, Pair]]) -> dict[Key, tuple[float, int]]:
    """Of every kind and what it is of: the largest relative difference, and of how many."""
    out: dict[Key, tuple[float, int]] = {}
    for key, (a, b) in pairs:
        off, count = out.get(key, (0.0, 0))
        out[key] = max(off, abs(a / b - 1.0) if b else abs(a)), count + 1
    return out


def points_tables(found: Mapping[Key, tuple[float, int]], asked: Mapping[str, tuple[int, int, int, int]]) -> str:
    """A row per kind, a column per family or coolant: percent, of how many points."""
    off = [(kind, of, f"{count:,}", f"{100.0 * share:.2f} %") for (kind, of), (share, count) in found.items()]
    head = ("correlation", "points", "outside its range", "of these in silence", "inside and told")
    said = [(f"`{name}`", *(f"{n:,}" for n in counts)) for name, counts in sorted(asked.items())]
    return f"{table(['', 'of', 'points', 'furthest off'], off)}\n\n{table(head, said)}"


def subjects(
    count: int, machines: Sequence[str] | None = None, coolants: Sequence[dict[str, object]] | None = None
) -> Iterator[tuple[Key, Pair]]:
    """Everything that is asked, by kind and by family, coolant or surface."""
    rng = np.random.default_rng(48)
    for name in machines or sorted(file.stem for file in MACHINES.glob("*.toml")):
        yield from machine_points(name, count, rng)
    for coolant in coolants or COOLANTS:
        for name, passes in CIRCUITS.items():
            for kind, pairs in circuit_points(name, {"coolant": coolant, "passes": passes}, count, rng):
                yield from (((f"circuit, {kind}", str(coolant["name"])), pair) for pair in pairs)
    for surface in MOVING:
        yield from ((("declared film", surface), pair) for pair in declared_points(surface, count, rng))
    for surface in STANDING:
        yield from ((("still air", surface), pair) for pair in standing_points(surface, count, rng))


def declared_points(surface: str, count: int, rng: np.random.Generator) -> Iterator[Pair]:
    """Moving air of network.toml at 0 to 3 times the largest speed that is expected (20 m/s), at five altitudes."""
    for k in range(5):
        high = rng.uniform(0.0, HIGHEST_M)
        data = {"surface": surface, "speed": "v", "up_to_m_s": 20.0, "altitude_m": high, **MOVING[surface]}
        law = over(Table(dict(data), surface))
        for _ in range(k * count // 5, (k + 1) * count // 5):
            v, hot, cold = rng.uniform(0.0, 60.0), rng.uniform(-40.0, 150.0), rng.uniform(-40.0, 80.0)
            exact = moving_surfaces()[surface](Table(dict(data), surface), air(0.5 * (hot + cold), high))(v)[0]
            yield coefficient(law, {"v": np.array([v])}, hot, cold), exact


def standing_points(surface: str, count: int, rng: np.random.Generator) -> Iterator[Pair]:
    """Still air of network.toml at rises from 0.5 to 150 K, at five altitudes."""
    for k in range(5):
        data = {"surface": surface, "altitude_m": rng.uniform(0.0, HIGHEST_M), **STANDING[surface]}
        law, exact = (
            natural(Table(dict(data), surface)),
            still_surfaces()[surface](Table(dict(data), surface), partial(air, altitude_m=data["altitude_m"])),
        )
        for _ in range(k * count // 5, (k + 1) * count // 5):
            cold, rise = rng.uniform(-40.0, 50.0), rng.uniform(0.5, 150.0)
            yield coefficient(law, {}, cold + rise, cold), exact(cold + rise, cold)[0]


def machine_points(name: str, count: int, rng: np.random.Generator) -> Iterator[tuple[Key, Pair]]:
    """Gap, jackets, outer faces, end space and fan's air of a machine, and its heat at rest."""
    machine = load_machine(name)
    around = surroundings(machine, ())

    def each(kind: str, point: Callable[[], Pair | None]) -> Iterator[tuple[Key, Pair]]:
        yield from (((kind, str(machine.family)), pair) for _ in range(count) if (pair := point()))

    if around.gap is not None:
        yield from each("air gap", lambda: gap_point(around, rng))
    for jacket in around.cooling.feeds if around.cooling else ():
        yield from each("jacket", partial(jacket_point, around, jacket, rng))
    for outer, part in {outer_of(machine, p.name, around.films): p.name for p in machine.parts}.items():
        laws = outer_films(machine, part, around.films)
        yield from each("outer faces", partial(outside_point, machine, part, outer, laws, rng))
    yield from each("end space", lambda: end_space_point(around, rng))
    if around.ways is not None:
        for way in around.ways.ducts:
            yield from each("ducts of the fan's air", partial(duct_point, around, way, rng))
            yield from each("split of the fan's air", partial(split_point, around.ways, way, rng))
    if name in AT_REST:
        network = on_every_base(means_network(machine, reduced(prepared(machine, 0.1, 36), MEANS)))
        for _ in range(min(count, STEADY)):
            yield from ((("heat at rest", str(machine.family)), p) for p in heat_point(machine, network, rng))


def heat_point(machine: Machine, network: Network, rng: np.random.Generator) -> Iterator[Pair]:
    """What faces and streams take to the surroundings beside what the losses put in; none where it runs away."""
    inputs = {k: v * rng.uniform(0.05, 3.0) for k, v in rated_inputs(machine).items()}
    inputs["current_A"] *= 0.1
    cold = rng.uniform(-40.0, 50.0)
    try:
        z = steady_state(network, inputs, cold)
    except ThermoscopeError:
        return
    c, fluids = coefficients(network, inputs, z), fluid_nodes(network)
    u = np.array([z[network.column(name)] for name in fluids])
    faces = [p for p in network.places.values() if p.kind == "surface" and p.fluid in network.boundaries]
    out = sum(c.films[p.name] * p.area * (float(p.mean.weights @ z[p.mean.index]) - cold) for p in faces)
    yield float(out + (c.streams @ u - c.inflow).sum()), sum(c.watts.values())


def outside_point(machine: Machine, part: str, outer: Outer, laws: dict[str, Law], rng: np.random.Generator) -> Pair:
    """Still and blown air and radiation of one face, together."""
    cowl, cold, rise = cowl_of(machine), rng.uniform(-40.0, 50.0), rng.uniform(0.5, 150.0)
    hot, rpm = cold + rise, rng.uniform(0.0, 3.0) * (cowl.at_rpm if cowl else 1500.0)
    high = rng.uniform(0.0, HIGHEST_M)
    still = outer.factor * STILL[outer.surface](outer, hot, cold, partial(air, altitude_m=high))
    blown = blown_film(machine, part, rpm, air(0.5 * (hot + cold), high)) if "blown" in laws else 0.0
    thin = [law if kind == "radiation" else thin_film(law, density(high), MOVERS) for kind, law in laws.items()]
    got = sum(coefficient(law, {"speed_rpm": np.array([rpm])}, hot, cold) for law in thin)
    return got, float(np.cbrt(still**3 + blown**3)) + radiation_film(outer.emissivity * outer.view, hot, cold)[0]


STILL: dict[str, Callable[[Outer, float, float, Callable[[float], Fluid]], float]] = {
    "horizontal cylinder": lambda o, hot, cold, of: churchill_chu_cylinder(o.size, hot, cold, of)[0],
    "vertical plate": lambda o, hot, cold, of: churchill_chu_plate(o.size, hot, cold, of)[0],
    "horizontal plate": lambda o, hot, cold, of: (
        0.5 * sum(mcadams_plate(o.size, hot, cold, up, of)[0] for up in (True, False))
    ),
    "radial fins": lambda o, hot, cold, of: elenbaas(o.spacing, o.size, hot, cold, of)[0],
}


def blown_film(machine: Machine, part: str, rpm: float, fluid: Fluid) -> float:
    """The cowl's air: Heiles between fins, a flat plate over shields and blades."""
    cowl, fins, e = cowl_of(machine), fins_of(machine), extent(machine.part(part))
    assert cowl is not None
    v = cowl.air_speed * rpm / cowl.at_rpm
    if part == "housing" and fins is not None:
        length = fins.length if fins.axial else np.pi * (fins.root + fins.height)
        return heiles(0.5 * (1.0 + cowl.end_share) * v, fins.hydraulic_diameter, length, cowl.turbulence, fluid)[0]
    if machine.part(part).role is Role.FAN:
        return flat_plate(v, 0.5 * e.size[1], fluid)[0]
    share = cowl.rear_share if part.endswith(cowl.rear) else cowl.front_share
    return flat_plate(share * v, e.size[1], fluid)[0]


def end_space_point(around: Surroundings, rng: np.random.Generator) -> Pair:
    films, rpm, share = around.films, rng.uniform(0.0, 3.0) * around.usual_rpm, rng.uniform(0.05, 1.0)
    v = share * around.tip_radius * rpm * np.pi / 30.0
    exact = end_space(v, films.end_space_k1_W_m2K, films.end_space_k2, films.end_space_k3)[0]
    law = stirred(share, films, around.tip_radius)
    return coefficient(law, {"speed_rpm": np.array([rpm])}, 80.0, 40.0), float(exact)


def fan_split(ways: Ways, flow: float, fluid: Fluid) -> dict[str, float]:
    """Share of every way: the gap's is given, the rest drops the same pressure."""
    beside = 1.0 - ways.fan.gap_share
    ducts = [[duct] for duct in ways.ducts.values()]
    return dict(
        zip(ways.ducts, (beside * s for s in parallel_shares(ducts, beside * flow / 3600.0, fluid)), strict=True)
    )


def split_point(ways: Ways, way: str, rng: np.random.Generator) -> Pair:
    flow, T, high = rng.uniform(0.01, 4.0) * ways.fan.flow_m3_h, rng.uniform(-40.0, 50.0), rng.uniform(0.0, HIGHEST_M)
    whole = air(T, high).rho * air(T).cp * flow / 3600.0
    got = coefficient(thin_stream(ways.rate(way), density(high)), {"fan_flow_m3h": np.array([flow])}, T, 0.0)
    return got / whole, fan_split(ways, flow, air(T + ways.fan.air_C - 20.0, high))[way]


def duct_point(around: Surroundings, way: str, rng: np.random.Generator) -> Pair:
    """The fan's air along the walls of a duct; those that stand see all that does not turn."""
    ways = around.ways
    assert ways is not None
    flow, hot, cold = rng.uniform(0.01, 4.0) * ways.fan.flow_m3_h, rng.uniform(-40.0, 150.0), rng.uniform(-40.0, 80.0)
    high = rng.uniform(0.0, HIGHEST_M)
    duct, fluid = ways.ducts[way], air(0.5 * (hot + cold), high)
    shares = fan_split(ways, flow, fluid)
    share = shares[way] if duct.turns else 1.0 - sum(s for n, s in shares.items() if ways.ducts[n].turns)
    exact = duct_film(share * flow / 3600.0 / duct.section, duct.diameter, duct.length, fluid)[0]
    law = thin_film(face_films("poles", way, around)["axial"], density(high), MOVERS)
    return coefficient(law, {"fan_flow_m3h": np.array([flow])}, hot, cold), exact


def gap_point(around: Surroundings, rng: np.random.Generator) -> Pair:
    assert around.gap is not None
    rpm, T, high = rng.uniform(0.0, 3.0) * around.usual_rpm, rng.uniform(-40.0, 150.0), rng.uniform(0.0, HIGHEST_M)
    law = thin_film(gap_film(around.gap, around.usual_rpm), density(high), MOVERS)
    exact = taylor_film(rpm * np.pi / 30.0, around.gap.rotor_radius, around.gap.width, air(T, high))[0]
    return coefficient(law, {"speed_rpm": np.array([rpm])}, T, T), exact


def jacket_point(around: Surroundings, jacket: str, rng: np.random.Generator) -> Pair | None:
    assert around.cooling is not None
    cooling = replace(around.cooling, coolant=str(rng.choice(list(LIQUIDS))), pressure_bar=3.0)
    T = rng.uniform(-40.0, 130.0)
    flow, wet = rng.uniform(0.0, 4.0) * cooling.flow_l_min, rng.uniform(1e-4, 1e-2)
    try:
        fluid = cooling.at(T)
    except InputError:
        return None
    h = channel_of(around.machine, jacket).film(cooling.share(jacket) * flow, fluid)[0]
    rate = fluid.rho * fluid.cp * cooling.share(jacket) * flow / 6e4
    law = onto_outlet(around.machine, jacket, cooling, wet)
    got = coefficient(law, {FLOW: np.array([flow])}, T, 0.0)
    return (got * wet / rate, float(np.expm1(h * wet / rate))) if h * wet < 5.0 * rate else None


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
            rate, area = fluid.rho * fluid.cp * flow / 6e4 * share, duct.wall / circuit.cells
            N = film_in(duct, flow / 6e4 * share, fluid)[0] * area / rate
            if N < 4.0:
                stretched.append((float(np.log1p(coefficient(film.law, at, T, 0.0) / rate)), N))
        whole = fluid.rho * fluid.cp * flow / 6e4
        shares += [(coefficient(x.law, at, T, 0.0) / whole, s) for x, s in zip(streams, split, strict=False)]
        if len(closed) < STEADY and flow > 2.0 and T < 60.0:
            rest = steady(network, {FLOW: flow}, {"inlet": T})
            taken = sum(coefficient(x.law, at, x.hot.at(rest.z), 0.0) for x in network.links if x.kind == "stream")
            closed.append((taken * (rest["c.outlet"] - T), 2000.0))
    yield "films", stretched
    yield "heat at rest", closed
    yield "shares of branches", shares


if __name__ == "__main__":
    raise SystemExit(main())
