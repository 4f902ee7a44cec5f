"""What a network of this kind gets wrong, as columns: the change of every reading by one deviation of each doubt.

The lines of `measured.doubt` that no calibrated parameter stands for are linear here: a machine that is not quite the
model reads y + D d with d ~ N(0, 1). Marginalised, D D' is the covariance of the model error, correlations between
sensors and tests included, without a draw: Bayesian approximation error (Kaipio and Somersalo 2005, chapter 5.8).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, product

import numpy as np

from geom.arrays import Array
from lumped.integration.simulate import simulate
from lumped.model.network import Link, Network, Parameter, Place, Row, Source
from lumped.model.quantities import AIR, LIQUID
from lumped.model.topology import FRICTION
from lumped.transfer.laws import CONSTANT, Constant, Fixed, Inputs, WithTemperature
from measured.case import Channel, Test
from measured.doubt import USUAL, Doubt, boundary_doubt
from measured.sensors.operators import lag, setting
from validation.calibration.input_steps import InputStep, input_steps, recorded_inputs, with_more, with_steps
from validation.comparison.linearisation import Segment, largest_rise, segments
from validation.comparison.predict import heat_model, record
from validation.effects.build import Shaped, copy_element, exchange, heat
from validation.parameters.model_form import EXACT_LOSSES, KNOTS, REFERENCE_RISE_K, Table, is_film
from validation.parameters.reference import mean_factor
from validation.threads import run_by_run, side_by_side

SQUARED = ("current", "torque")  # quantities whose square makes heat
SMOOTH = 1e-3  # of its mean square: an input that jumps by less is as good as straight
FELT = 0.1  # of what a good model may be wrong by: a hundredth of its variance that inputs stepped early or late
LEAST_W_K = 1e-9  # of a link that heat passes: what doubts are shares of


LOGARITHM = Table(KNOTS, tuple(np.log(np.clip(np.array(KNOTS) / REFERENCE_RISE_K, 0.1, 10.0))))


@dataclass(frozen=True)
class SquareOf:
    """The sum of squares of some inputs, of its largest value."""

    inputs: tuple[str, ...]
    largest: float

    def __call__(self, inputs: Inputs) -> Array:
        return np.asarray(sum(np.asarray(inputs[n], float) ** 2 for n in self.inputs)) / self.largest

    @classmethod
    def of(cls, network: Network, tests: Sequence[Test], quantities: Sequence[str]) -> "SquareOf | None":
        """Of the first of some quantities that all tests have and that is not zero throughout."""
        every = [n for n in tests[0].inputs if all(n in t.inputs for t in tests)] if tests else []
        for quantity in quantities:
            names = tuple(n for n in every if network.measures(n) == quantity)
            square = [sum(np.asarray(t.inputs[n], float) ** 2 for n in names) for t in tests]
            largest = max(float(np.max(x)) for x in square) if names else 0.0
            if largest > 0.0:
                return cls(names, largest)
        return None


def with_doubts(network: Network, doubt: Doubt, tests: Sequence[Test] = ()) -> tuple[Network, tuple[Parameter, ...]]:
    """The network with a neutral parameter for each doubt of its links, losses and capacities; prior_sd is its size.

    tests : whose largest load is that at which losses are in doubt; without any they follow their laws
    """
    before, pairs = len(network.parameters), lumping_errors(network, doubt["bridge"])
    past = bypasses(network, doubt["bridge"], tests)
    new = [*_each_link(network, doubt), *_each_loss(network, doubt), *_each_capacity(network, doubt)]
    for loss, square in _under_load(network, tests):
        name = f"{loss.name}*{'*'.join(square.inputs)}"
        network = copy_element(network, loss, name, Shaped(loss.law, square, also_reads=square.inputs))
        new.append(_amplitude(f"doubt:{name}", name, doubt["load"], "1"))
    for link in [x for x in network.links if _constant_film(network, x)]:
        name = f"{link.name}^dT?"
        network = copy_element(network, link, name, WithTemperature(link.law, LOGARITHM))
        new.append(_amplitude(f"doubt:{name}", name, doubt["film exponent"], "1"))
    for a, b, G in pairs:
        name = f"beside:{a}|{b}"
        network = network.extended(links=[exchange(network, name, a, b, Fixed(1.0))])
        new.append(_amplitude(f"doubt:{name}", name, G, "W/K"))
    for name, films, sd in past:
        network = network.extended(links=films)
        new.append(replace(_amplitude(f"doubt:{name}", "", sd, "1"), targets=tuple((x.name, 1.0) for x in films)))
    network = replace(network, parameters=(*network.parameters, *new))
    return network, network.parameters[before:]


def bypasses(network: Network, share: float, tests: Sequence[Test]) -> list[tuple[str, list[Link], float]]:
    """Heat that passes from a body beside its neighbour through that one's films to a boundary, as bodies that are not
    of one temperature let it: name, films of the same laws, and the part of them (one sigma)."""
    out = []
    for body, ends in stars(network).items():
        by_boundary: dict[str, list[Link]] = {}
        for x in [x for x in network.links if x.places[0] == body and x.places[1] in network.boundaries]:
            if is_film(network, x) and x.kind != "stream" and not x.origin:
                by_boundary.setdefault(x.places[1], []).append(x)
        for (outside, films), (other, G) in product(by_boundary.items(), ends.items()):
            name, area = f"past:{other}|{body}|{outside}", {x.name: float(np.max(np.abs(x.vals))) for x in films}
            new = [exchange(network, f"{name}:{x.name}", other, outside, x.law) for x in films]
            new = [replace(n, vals=n.vals * area[x.name]) for n, x in zip(new, films, strict=True)]
            washes = sum(area[x.name] * mean_factor([x.law], tests) for x in films)  # W/K
            out.append((name, new, share * G / (G + washes)))
    return out


def _constant_film(network: Network, link: Link) -> bool:
    film = is_film(network, link) and link.kind != "stream" and not link.origin
    return film and isinstance(link.law.temperature, Constant)


def _amplitude(name: str, target: str, sd: float, unit: str) -> Parameter:
    return Parameter(name, ((target, 1.0),), 0.0, unit, -1e9, 1e9, sd, "amplitude", 0.0)


def _log(target: str, sd: float) -> Parameter:
    return Parameter(f"doubt:{target}", ((target, 1.0),), prior_sd=sd)


def alone(network: Network) -> set[str]:
    """Links, losses and capacities that a parameter moves by themselves, or with what an exponent adds to them."""
    extras = {x.name for x in network.links if x.origin} | {x.name for x in network.sources if x.origin}
    groups = [[t for t, _ in p.targets if t not in extras] for p in network.parameters if p.mapping == "log"]
    return {targets[0] for targets in groups if len(targets) == 1}


def _each_link(network: Network, doubt: Doubt) -> Iterator[Parameter]:
    """A link that shares its parameter with others, or has none, may differ from them."""
    single, common = alone(network), _shared(network)
    pairs = joints(network)
    for x in network.links:
        if x.name not in single and x.kind != "stream" and not x.origin:
            alike = "joint" if x.name in pairs else "group"
            yield _log(x.name, doubt[alike if x.name in common or is_film(network, x) else "conductivity"])


def _each_loss(network: Network, doubt: Doubt) -> Iterator[Parameter]:
    """Bearings of one parameter differ more than the parts of one loss."""
    single, common = alone(network), _shared(network)
    for s in network.sources:
        if s.name not in single and not s.origin:
            yield _log(s.name, doubt["bearing" if s.kind in FRICTION and s.name in common else "split"])


def _under_load(network: Network, tests: Sequence[Test]) -> Iterator[tuple[Source, SquareOf]]:
    """Losses that may follow the load although their laws do not say so, with the load; copper's follow it anyway."""
    load = SquareOf.of(network, tests, ("current", "torque"))
    for s in network.sources:
        exempt = s.origin or s.kind in EXACT_LOSSES or s.law.looks_at_all
        if load is not None and not exempt and not set(load.inputs) & set(s.law.reads):
            yield s, load


def _shared(network: Network) -> set[str]:
    """What some parameter moves."""
    return {t for p in network.parameters for t, _ in p.targets}


def joints(network: Network) -> set[str]:
    """Constant links between bodies that share a parameter with one between two others: contacts of one drawing."""
    bodies = {p.name for p in solid(network)}
    pair_of = {x.name: frozenset(x.places) for x in network.links if _is_constant(x) and bodies >= set(x.places)}
    out: set[str] = set()
    for p in network.parameters:
        mine = {t: pair_of[t] for t, _ in p.targets if t in pair_of}
        if len(set(mine.values())) > 1:
            out |= set(mine)
    return out


def _is_constant(link: Link) -> bool:
    return isinstance(link.law, Fixed) and link.law.temperature == CONSTANT and link.kind not in ("stream", "film")


def _each_capacity(network: Network, doubt: Doubt) -> Iterator[Parameter]:
    single, groups = alone(network), network.capacity_group or network.states
    mass = {g: sum(C for C, group in zip(network.C, groups) if group == g) for g in groups}
    for g in dict.fromkeys(groups):
        if f"capacity:{g}" not in single and mass[g] > 0:
            yield _log(f"capacity:{g}", doubt["capacity"])


def lumping_errors(network: Network, share: float) -> list[tuple[str, str, float]]:
    """Pairs of nodes and the conductance (W/K) that passes between them beside the nodes that join them, one sigma.

    A part that is not of one temperature joins its neighbours a little more, or less, than the star through its mean.
    It has one field however many neighbours it has: what passes beside it is shared over these.
    """
    square: dict[tuple[str, str], float] = {}
    for ends in stars(network).values():
        for (a, Ga), (b, Gb) in combinations(ends.items(), 2):
            pair = (a, b) if (b, a) not in square else (b, a)
            square[pair] = square.get(pair, 0.0) + (share * Ga * Gb / (Ga + Gb)) ** 2 / (len(ends) - 1)
    return [(a, b, float(np.sqrt(v))) for (a, b), v in square.items()]


def stars(network: Network) -> dict[str, dict[str, float]]:
    """For every node with mass its neighbours through conductances (W/K) that depend on nothing."""
    heavy = {p.name for p in network.places.values() if p.kind == "node" and network.C[p.states[0]] > 0}
    out: dict[str, dict[str, float]] = {}
    for link in network.links:
        if link.kind == "stream" or not isinstance(link.law, Fixed):
            continue
        if link.law.temperature == CONSTANT and link.law.value > LEAST_W_K:
            for node, other in (link.places, link.places[::-1]):
                if node in heavy and other in heavy:
                    ends = out.setdefault(node, {})
                    ends[other] = ends.get(other, 0.0) + link.law.value
    return out


@dataclass(frozen=True)
class Series:
    """A recorded series as a function of time."""

    time: Array
    value: Array

    def __call__(self, inputs: Inputs) -> Array:
        return np.interp(np.asarray(inputs["time_s"], float), self.time, self.value)


def with_cores(network: Network, test: Test, values: Mapping[str, float], doubt: Doubt) -> Network:
    """The network with the heat (W) that a core in each node would give off in this test, amplitude zero.

    A share of the node's capacity follows it with a time constant tau: its heat is C * share (dT/dt - dT_core/dt).
    """
    sources, parameters = [], []
    places = solid(network)
    if not places:  # parts from a field have their inner temperatures as states
        return network
    T = nodes(network, test, values, places)
    core = T.copy()
    lag(test.time, core, np.full(len(places), doubt["core time"]))
    for i, place in enumerate(places):
        C = float(network.C[place.states[0]])
        q = doubt["core"] * C * np.gradient(T[:, i] - core[:, i], test.time)
        name = f"core:{place.name}"
        law = Shaped(Fixed(1.0), Series(test.time, q), also_reads=("time_s",), by_instant=True)
        sources.append(heat(network, name, "core", place.name, law))
        parameters.append(_amplitude(f"doubt:{name}", name, 1.0, "1"))
    network = network.extended(sources=sources)
    return replace(network, parameters=(*network.parameters, *parameters))


def solid(network: Network) -> list[Place]:
    """Nodes with mass."""
    return [p for p in network.places.values() if p.kind == "node" and network.C[p.states[0]] > 0]


def nodes(network: Network, test: Test, values: Mapping[str, float], places: Sequence[Place]) -> Array:
    """Temperatures (n_time, n) of some nodes in a test."""
    bare, now = heat_model(network, values)
    return simulate(bare, record(test, setting(network.parameters, values)), now, [p.mean for p in places]).y


@dataclass(frozen=True)
class ModelError:
    """columns : (test, channel) -> (n, d) change of the readings (K) by one deviation of each doubt;  names (d,)

    law : share of itself (one sigma) that an effect's amplitude is wrong by because its law is
    sums : (test, channel) -> K, one sigma of the model's doubts together before they were scaled down
    steps : how many of the columns, the last, are of when inputs stepped: the record's doubt, not the model's
    """

    columns: Mapping[tuple[str, str], Array]
    names: tuple[str, ...]
    law: float = USUAL["law"]
    sums: Mapping[tuple[str, str], float] = field(default_factory=dict)
    steps: int = 0

    def of(self, segment: Segment) -> Array:
        return self.columns[segment.test, segment.channel]

    @property
    def size(self) -> int:
        return next(iter(self.columns.values())).shape[1]

    @property
    def model_columns(self) -> int:
        """How many columns are the model's: the first."""
        return self.size - self.steps

    def late(self, parts: Sequence[Segment]) -> dict[str, Array]:
        """Channel -> (n, steps): what steps of the inputs do in a test."""
        return {s.channel: self.of(s)[:, self.model_columns :] for s in parts}

    def bounded(self, most: float) -> "ModelError":
        """With the model's columns of each record scaled down together to `most` (K, one sigma) in sum."""
        scaled = {
            key: np.hstack(
                [x[:, : self.model_columns] * min(1.0, most / max(self.sums[key], 1e-12)), x[:, self.model_columns :]]
            )
            for key, x in self.columns.items()
        }
        return replace(self, columns=scaled)

    def beside(self, segment: Segment, p: int) -> Segment:
        """The segment with the model error's columns behind its first p."""
        return replace(segment, J=np.column_stack([segment.J[:, :p], self.of(segment), segment.J[:, p:]]))


def model_error(
    network: Network,
    tests: Sequence[Test],
    values: Mapping[str, float],
    doubt: Doubt = USUAL,
    sensed: Sequence[Test] = (),
    steps_like: ModelError | None = None,
) -> ModelError:
    """The model error of a network at some values of its parameters, over the instants of its tests' segments.

    Where the doubts of a record add up to more than a share of the machine's largest rise, they are scaled down
    together; of its own rise would not do, for beside a hot part a cool one is off by what the hot one makes.

    sensed : tests whose sensors' placement is in doubt, and whose largest load counts; by default `tests`
    steps_like : the model error of the same tests by a network that is nearly this one. What its input steps do is
        taken over: they are in doubt by a share of a sample, and each of them asks for a run
    """
    larger, doubts = with_doubts(network, doubt, sensed or tests)
    steps = {t.name: input_steps(t, len(network.states)) for t in sensed or tests}

    def of_test(test: Test) -> tuple[tuple[Parameter, ...], dict[tuple[str, str], Array]]:
        with_core = with_cores(larger, test, values, doubt)
        every = (*doubts, *with_core.parameters[len(larger.parameters) :])
        parts = segments(with_core, [test], values, every)
        scale = np.array([p.prior_sd for p in every])
        beside = placements(network, test, values, doubt, sensed or tests)
        here = np.array([float(t.name == test.name) for t in sensed or tests])
        flow = of_inputs(network, test, values, doubt, parts, here)
        late = of_steps(network, test, values, doubt, parts, steps) if steps_like is None else steps_like.late(parts)
        columns = {
            s.channel: np.column_stack([s.J * scale, beside[s.channel], flow[s.channel], late[s.channel]])
            for s in parts
        }
        return every, {(s.test, s.channel): columns[s.channel] for s in parts}

    each = side_by_side(of_test, tests, lambda test: len(test.time))
    names = (*named(network, each[-1][0], doubt, sensed or tests), *step_names(sensed or tests, steps))
    columns = {key: x for _, of in each for key, x in of.items()}
    late = sum(map(len, steps.values()))
    sums = {key: total_sd(x[:, : x.shape[1] - late]) for key, x in columns.items()}
    return ModelError(columns, names, doubt["law"], sums, late).bounded(doubt["total"] * machine_rise(sensed or tests))


def machine_rise(tests: Sequence[Test]) -> float:
    """The largest rise (K) of any reading."""
    return max(largest_rise(c) for t in tests for c in t.channels if np.isfinite(c.y).any())


def total_sd(columns: Array) -> float:
    """Standard deviation (K, rms over a record) of all doubts together."""
    return float(np.sqrt(np.mean(np.sum(columns**2, axis=1))))


def named(network: Network, doubts: Sequence[Parameter], doubt: Doubt, tests: Sequence[Test]) -> tuple[str, ...]:
    """What each column but those of input steps stands for."""
    names = [p.name.removeprefix("doubt:") for p in doubts]
    beside = [f"{n} in the reading of {c}" for c, n, _ in sensed_beside(network, tests, doubt)]
    once = [f"flow of {what} in {t.name}" for what in ("air", "liquid") for t in tests]
    late = [f"{b} late" for b in network.boundaries]
    return (*names, *beside, "flow of air", "flow of liquid", "jumps between samples", *once, *late)


def step_names(tests: Sequence[Test], steps: Mapping[str, Sequence[InputStep]]) -> tuple[str, ...]:
    """What each column of input steps stands for.  steps : by the name of their test"""
    every = [(t, s) for t in tests for s in steps[t.name]]
    return tuple(f"{s.what} near {recorded_inputs(t)[0][s.row[0]]:.0f} s of {t.name}" for t, s in every)


def of_inputs(
    network: Network, test: Test, values: Mapping[str, float], doubt: Doubt, plain: Sequence[Segment], here: Array
) -> dict[str, Array]:
    """Channel -> (n, k): each kind of flow, as its meter may be off in all tests; what jumps between samples; each kind
    of flow in one test after the other, as the meter may be off there alone; each boundary, that may come late.

    plain : the test as recorded;  here : (n_test,) 1 for this test among those whose meters are in doubt, 0 for others
    """
    scales = (*(_flow(network, test, doubt, quantity) for quantity in (AIR, LIQUID)), jumps(network, test, doubt))
    variants = [*(test.scaled(scale) if scale else test for scale in scales), *late_boundaries(network, test, doubt)]
    runs = [plain if now is test else segments(network, [now], values) for now in variants]
    every = [np.column_stack([s.r - run[i].r for run in runs]) for i, s in enumerate(plain)]
    n = len(scales)
    return {
        s.channel: np.hstack([x[:, :n], np.kron(x[:, :2], here), x[:, n:]]) for s, x in zip(plain, every, strict=True)
    }


def late_boundaries(network: Network, test: Test, doubt: Doubt) -> list[Test]:
    """The test with each boundary of the network in turn late; the test itself where that one hardly moves."""
    out = []
    for name in network.boundaries:
        course = np.array(np.broadcast_to(np.asarray(test.boundaries[name], float), test.time.shape))
        late = course[:, None].copy()
        lag(test.time, late, np.array([doubt["boundary late"]]))
        moves = np.sqrt(np.mean((late[:, 0] - course) ** 2)) > FELT * boundary_doubt(doubt, name)
        out.append(replace(test, boundaries={**test.boundaries, name: late[:, 0]}) if moves else test)
    return out


def of_steps(
    network: Network,
    test: Test,
    values: Mapping[str, float],
    doubt: Doubt,
    plain: Sequence[Segment],
    by_test: Mapping[str, Sequence[InputStep]],
) -> dict[str, Array]:
    """Channel -> (n, k): each step of the inputs of all tests, moved by a deviation; zero in other tests, and where all
    steps of the test together are small beside what a good model may be wrong by.

    plain : the test as recorded;  by_test : name -> its steps
    """
    every = [(name == test.name, s) for name, some in by_test.items() for s in some]
    if not doubt["step in sample"]:
        return {s.channel: np.zeros((s.r.size, len(every))) for s in plain}
    steps = [s for here, s in every if here and not s.hidden]
    early = segments(network, [with_steps(test, steps)], values) if steps else plain

    def changed(before: Sequence[Segment], now: Sequence[Segment]) -> list[Array]:
        return [doubt["step in sample"] * (a.r - b.r) for a, b in zip(before, now, strict=True)]

    def run(now: Test) -> list[Segment]:
        return segments(network, [now], values)

    whole = changed(early, run(with_steps(test, steps, steps))) if steps else []
    small = FELT * np.sqrt(max(len(steps), 1))  # moved together, they do so much more than each by chance
    felt = any(np.sqrt(np.mean(x**2)) > small * s.model_K for x, s in zip(whole, plain, strict=False))
    nothing = [np.zeros_like(s.r) for s in plain]
    mine = [s for here, s in every if felt and here]
    variants = [with_more(test, s) if s.hidden else with_steps(test, steps, [s]) for s in mine]
    after = iter(zip(mine, run_by_run(run, variants, network.size), strict=True))  # often one test alone has steps
    each = ((plain if s.hidden else early, now) for s, now in after)
    columns = [changed(*next(each)) if felt and here else nothing for here, _ in every]
    return {
        s.channel: np.column_stack([np.empty((s.r.size, 0)), *(c[i] for c in columns)]) for i, s in enumerate(plain)
    }


def _flow(network: Network, test: Test, doubt: Doubt, quantity: str) -> dict[str, float]:
    return {n: 1.0 + doubt["flow"] for n in test.inputs if network.measures(n) == quantity}


def jumps(network: Network, test: Test, doubt: Doubt) -> dict[str, float]:
    """Input that heat follows by its square -> factor on it in this test, if it jumps where it is taken as straight.

    Between u and v the mean square is (u^2 + u v + v^2) / 3 on a straight line and (u^2 + v^2) / 2 of two steps.
    """
    out = {}
    for n in test.inputs:
        fine = test.recorded if test.recorded and n in test.recorded.inputs else test
        time, u = fine.time, np.asarray(fine.inputs[n], float)
        step, a, b = np.diff(time), u[:-1], u[1:]
        straight = float(step @ (a * a + a * b + b * b)) / 3.0
        more = float(step @ (b - a) ** 2) / 6.0
        if network.measures(n) in SQUARED and more > SMOOTH * straight:
            out[n] = float(np.sqrt(1.0 + doubt["between samples"] * more / straight))
    return out


def placements(
    network: Network, test: Test, values: Mapping[str, float], doubt: Doubt, tests: Sequence[Test]
) -> dict[str, Array]:
    """Channel -> (n, c): a share of each neighbour's temperature in its reading, a column per sensor and neighbour."""
    pairs = sensed_beside(network, tests, doubt)
    here = {c.name: c for c in test.channels}
    virtual = [_virtual(here[c], network.places[n].mean, f"{i}:{c}") for i, (c, n, _) in enumerate(pairs) if c in here]
    sensors = [_virtual(c, c.row, c.name) for c in test.channels]
    plain, now = heat_model(network, values)
    parts = {s.channel: s for s in segments(plain, [replace(test, channels=(*sensors, *virtual))], now)}
    return {c.name: _beside(c.name, pairs, parts) for c in test.channels if c.name in parts}


def sensed_beside(network: Network, tests: Sequence[Test], doubt: Doubt) -> list[tuple[str, str, float]]:
    """Every sensor, each place beside its own, and the share (one sigma) of that in its reading."""
    sensors = {c.name: c for t in tests for c in t.channels}
    return [(c.name, n, share) for c in sensors.values() for n, share in neighbours(network, c, doubt)]


def _beside(channel: str, pairs: Sequence[tuple[str, str, float]], parts: Mapping[str, Segment]) -> Array:
    r = parts[channel].r
    zero = np.zeros_like(r)
    columns = [s * (r - parts[f"{i}:{c}"].r) if c == channel else zero for i, (c, _, s) in enumerate(pairs)]
    return np.column_stack(columns) if columns else np.zeros((r.size, 0))


def _virtual(c: Channel, row: Row, name: str) -> Channel:
    """A sensor that reads a row of the network where the channel was read; its readings are zero."""
    return replace(c, name=name, row=row, y=np.where(np.isfinite(c.y), 0.0, np.nan))


def neighbours(network: Network, c: Channel, doubt: Doubt) -> list[tuple[str, float]]:
    """Places beside a sensor's own, and the share (one sigma) of each in its reading."""
    part = network.places[c.place].part if c.place in network.places else c.place
    near = dict.fromkeys(n for x in network.links for n in x.places if part in x.places and n != part)
    places = [n for n in near if n in network.places and network.places[n].kind != "surface"]
    fluid = c.place in network.places and network.places[c.place].kind == "fluid"
    share = doubt["placement in stream" if fluid else "placement"]
    return [(n, share / np.sqrt(len(places))) for n in places]
