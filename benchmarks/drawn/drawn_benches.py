"""Benches that other people might have: a fan in one test, a lid that is opened, a probe that sat elsewhere; drawn.

    python benchmarks/drawn/drawn_benches.py [--cases 100] [--only lid] [--json FILE]

Every case is drawn anew (sizes, losses, films, noise, inputs) with one cause that the model does not have. It is right
where `diagnose` names it and `add` accepts it: the test of the fan, or of less air at all faces; the lid with begin and
end, a sensor that came loose with the begin within two samples. Of
air that follows the speed, part of which was away in one test, `improve` has to add both, and nothing for a while in
another test or place. A probe that sat elsewhere is nothing that a model should explain: right is any verdict but
*adequate* whose sentence names the sensor or one of its tests.
"""

import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from geom.errors import NoSolution
from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate
from lumped.model.network import Network
from measured.case import Case, Channel, Model, Test
from scripts.published import benchmark_parser, write_json
from validation.diagnosis import diagnose
from validation.effects import effect
from validation.effects.during import During
from validation.inference.result import Diagnosis
from validation.revision.improvement import Supervisor, improve, singletons
from validation.revision.revise import add

NOISE_K, SIGMA_K = 0.1, 0.3
DAY = 86400.0  # s
CLOSE = 2.0  # samples that the begin and the end of a lid may be off by
RECORDED = ("load", "speed_rpm")
Inputs = Mapping[str, np.ndarray]


def network(rng: np.random.Generator, more: Mapping[str, dict]) -> Network:
    """A heated core in a shell that stands in a room, and what else there is; sizes drawn."""
    C, G, film, watts = rng.uniform(300, 900), rng.uniform(1, 4), rng.uniform(0.5, 1.5), rng.uniform(20, 60)
    of = {"input": "load", "at": 1.0, "exponent": 1.0}
    return read_network(
        {
            "network": {"name": "bench", "boundaries": ["ambient"], "settles_s": 1500},
            "nodes": {n: {"C_J_K": c, "prior_sd": 0.1} for n, c in (("core", C), ("shell", 1.5 * C))},
            "links": {
                "joint": {"between": ["core", "shell"], "G_W_K": G, "prior_sd": 0.3},
                "film": {"between": ["shell", "ambient"], "G_W_K": film, "prior_sd": 0.3},
                **more,
            },
            "losses": {"heat": {"kind": "constant", "at": "core", "P_W": watts, "prior_sd": 0.1, "of": of}},
        }
    )


def recorded(
    rng: np.random.Generator,
    truth: Network,
    names: str,
    step: float,
    more: Callable[[str], Inputs],
    length: float = 5400.0,
    loads: Sequence[float] = (0.0, 0.3, 0.6, 1.0),
) -> Case:
    """One test for each letter, by default an hour and a half each, with a load that is switched; read with noise."""
    tests, rows = [], [truth.places[p].mean for p in ("core", "shell")]
    for name in names:
        t = np.arange(0.0, length, step)
        u = {"load": rng.choice(loads, 10)[(10.0 * t / length).astype(int)], **more(name)}
        around = {"ambient": np.full_like(t, rng.uniform(18, 26))}
        start = float(around["ambient"][0])
        test = Test(name, "calibrate", t, u, around, (), start)
        y = simulate(truth, Record(t, test.signals, around, start), {}, rows).y
        y = y + NOISE_K * rng.standard_normal(y.shape)
        channels = [
            Channel(p, p, r, y[:, i], SIGMA_K) for i, (p, r) in enumerate(zip(("core", "shell"), rows, strict=True))
        ]
        seen = {n: v for n, v in u.items() if n in RECORDED}
        tests.append(replace(test, inputs=seen, channels=tuple(channels)))
    return Case("bench", Model(truth), tuple(tests))


def switched(conductance: float) -> dict[str, dict]:
    """What an input that nobody records opens, from the shell to the room."""
    of = {"input": "open", "at": 1.0, "exponent": 1.0}
    return {"open": {"between": ["shell", "ambient"], "G_W_K": conductance, "of": of}}


def without_cause(case: Case) -> Case:
    """The same held against the model that has no such link."""
    links = tuple(x for x in case.model.network.links if x.name != "link:open")
    parameters = tuple(p for p in case.model.network.parameters if p.targets and p.targets[0][0] != "link:open")
    return replace(case, model=Model(replace(case.model.network, links=links, parameters=parameters)))


def accepted(case: Case, said: Diagnosis) -> tuple[During, ...]:
    """What the diagnosis puts first, if it holds for a while and `add` accepts it; () else."""
    first = effect(said.groups[0][0]) if said.groups and said.verdict in ("named", "group", "several") else None
    return (first,) if isinstance(first, During) and add(case, first.name).accepted else ()


def fan(rng: np.random.Generator) -> str:
    """A fan blew at the shell in one of three tests."""
    which = str(rng.choice(list("abc")))
    truth = network(rng, switched(rng.uniform(1.0, 5.0)))
    case = without_cause(recorded(rng, truth, "abc", 20.0, lambda name: {"open": np.full(270, float(name == which))}))
    said = diagnose(case, plan=False)
    found = accepted(case, said)
    return "right" if found and found[0].tests == (which,) else f"{said.verdict}: {said.words}"


def lid(rng: np.random.Generator) -> str:
    """A lid was open for one to five minutes, once, in one of two tests of a sample every ten seconds."""
    begin, length = 10.0 * rng.integers(60, 400), 10.0 * rng.integers(6, 30)
    truth = network(rng, switched(rng.uniform(5.0, 20.0)))
    t = np.arange(0.0, 5400.0, 10.0)
    opened = ((t >= begin) & (t < begin + length)).astype(float)
    case = without_cause(
        recorded(rng, truth, "ab", 10.0, lambda name: {"open": opened if name == "b" else np.zeros_like(t)})
    )
    said = diagnose(case, plan=False)
    for one in accepted(case, said):
        spans = one.event.spans.get("b", ()) if one.event else ()
        if len(spans) == 1 and max(abs(spans[0][0] - begin), abs(spans[0][1] - begin - length)) <= CLOSE * 10.0:
            return "right"
    return f"open {begin:.0f}-{begin + length:.0f} s; {said.verdict}: {said.words}"


def incubator(rng: np.random.Generator) -> str:
    """In a day of a sample every ten seconds a lid was opened three to seven times, for one to three minutes; there is
    always something to cool."""
    count = int(rng.integers(3, 8))
    begins = 6000.0 * np.sort(rng.choice(np.arange(1, 14), count, replace=False)) + 10.0 * rng.integers(0, 300, count)
    ends = begins + 10.0 * rng.integers(6, 19, count)
    truth = network(rng, switched(rng.uniform(5.0, 20.0)))
    t = np.arange(0.0, DAY, 10.0)
    opened = np.sum([(t >= a) & (t < b) for a, b in zip(begins, ends, strict=True)], axis=0, dtype=float)
    case = without_cause(recorded(rng, truth, "a", 10.0, lambda name: {"open": opened}, DAY, (0.3, 0.6, 1.0)))
    said = diagnose(case, plan=False)
    for one in accepted(case, said):
        spans = np.array(one.event.spans.get("a", ()) if one.event else ())
        if spans.shape == (count, 2) and np.abs(spans - np.column_stack([begins, ends])).max() <= CLOSE * 10.0:
            return "right"
    when = ", ".join(f"{a:.0f}-{b:.0f}" for a, b in zip(begins, ends, strict=True))
    return f"open {when} s; {said.verdict}: {said.words}"


def probe(rng: np.random.Generator) -> str:
    """In two of four tests the probe of the shell read a share of the room."""
    share, moved = rng.uniform(0.3, 0.7), set(rng.choice(list("abcd"), 2, replace=False).tolist())
    case = recorded(rng, network(rng, {}), "abcd", 20.0, lambda name: {})
    tests = []
    for t in case.tests:
        core, shell = t.channels
        y = (1.0 - share) * shell.y + share * t.boundaries["ambient"]
        tests.append(replace(t, channels=(core, replace(shell, y=y) if t.name in moved else shell)))
    said = diagnose(replace(case, tests=tuple(tests)), plan=False)
    named = "shell" in said.words or any(f" {name}" in said.words for name in moved)
    return "right" if said.verdict != "adequate" and named else f"{said.verdict}: {said.words}"


def blocked_case(rng: np.random.Generator) -> tuple[Case, str, float]:
    """Air that follows the speed cooled the shell, which no model knew; in one of four tests part of it was away.
    The case, in which test, and what part."""
    which, share, size = str(rng.choice(list("abcd"))), rng.uniform(0.3, 0.8), rng.uniform(2.0, 6.0)

    def inputs(name: str) -> Inputs:
        speed = np.repeat(rng.choice([0.0, 600.0, 1000.0, 1500.0], 10), 27)
        return {"speed_rpm": speed, "open": (speed / 1000.0) ** 0.8 * (1.0 - share * (name == which))}

    return without_cause(recorded(rng, network(rng, switched(size)), "abcd", 20.0, inputs)), which, share


def blocked(rng: np.random.Generator) -> str:
    """Both are added, the air and the blockage, and nothing for a while in another test or place."""
    case, which, share = blocked_case(rng)
    done = improve(case, Supervisor(singletons, suggest=True))
    added = [effect(e.name) for e in done.case.model.effects]
    for_a_while = [e for e in added if isinstance(e, During)]
    follows = any("speed" in e.needs or "speed_rpm" in e.name for e in added)
    where = {(e.base.place, e.tests) for e in for_a_while}  # beside it a film: what blocks a face blocks all its films
    if follows and any(e.base.kind == "blockage" for e in for_a_while) and where == {("shell", (which,))}:
        return "right"
    return f"{share:.0%} away in {which}; {', '.join(e.name for e in added) or 'nothing'}; {done.why}"


def starved(rng: np.random.Generator) -> str:
    """Every film to the room was weaker by one share in one of three tests: a clogged filter, a slow fan, a cover."""
    which, share, drawn = str(rng.choice(list("abc"))), rng.uniform(0.2, 0.6), int(rng.integers(2**31))
    shell, core = rng.uniform(0.5, 1.5), rng.uniform(0.2, 0.8)

    def films(**of: dict) -> dict[str, dict]:
        each = {"film": (["shell", "ambient"], shell), "vent": (["core", "ambient"], core)}
        return {name: {"between": ends, "G_W_K": G, "prior_sd": 0.3, **of} for name, (ends, G) in each.items()}

    truth = network(np.random.default_rng(drawn), films(of={"input": "open", "at": 1.0, "exponent": 1.0}))
    case = recorded(rng, truth, "abc", 20.0, lambda name: {"open": np.full(270, 1.0 - share * (name == which))})
    case = replace(case, model=Model(network(np.random.default_rng(drawn), films())))
    said = diagnose(case, plan=False)
    found = [one for one in accepted(case, said) if one.base.kind == "blockage.all" and one.tests == (which,)]
    return "right" if found else f"{share:.0%} away in {which}; {said.verdict}: {said.words}"


def slipped(rng: np.random.Generator) -> str:
    """The same, and the probe takes up to three minutes to get there by its own mass."""
    return loose(rng, float(rng.uniform(5.0, 180.0)))


def loose(rng: np.random.Generator, settles_s: float = 0.0) -> str:
    """A sensor slipped off in one of three tests, and read a mean of the part and the room from then on."""
    which, place, share = str(rng.choice(list("abc"))), str(rng.choice(["core", "shell"])), rng.uniform(0.2, 0.9)
    since = 20.0 * rng.integers(30, 200)
    case = recorded(rng, network(rng, {}), "abc", 20.0, lambda name: {})

    def read(test: Test) -> Test:
        off = np.where(test.time >= since, share * (test.name == which), 0.0)
        if settles_s:
            off = off * -np.expm1(-np.maximum(test.time - since, 0.0) / settles_s)
        channels = (
            replace(c, y=c.y + (off * (test.boundaries["ambient"] - c.y) if c.name == place else 0.0))
            for c in test.channels
        )
        return replace(test, channels=tuple(channels))

    case = replace(case, tests=tuple(map(read, case.tests)))
    said = diagnose(case, plan=False)
    first = effect(said.groups[0][0]) if said.groups and len(said.groups[0]) == 1 else None
    names = f"sensor.loose@{place}", f"sensor.slip@{place}"
    if isinstance(first, During) and first.base.name in names and first.tests == (which,):
        begin = first.event.every[0][0] if first.event else 0.0
        if abs(begin - since) <= CLOSE * 20.0:
            return "right"
    truth = f"{share:.0%} at {place} in {which} from {since:.0f} s, in {settles_s:.0f} s"
    return f"{truth}; {said.verdict}: {said.words}"


KINDS = {
    "fan": fan,
    "blocked": blocked,
    "starved": starved,
    "loose": loose,
    "slipped": slipped,
    "lid": lid,
    "incubator": incubator,
    "probe": probe,
}


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--cases", type=int, default=100, help="drawn of each kind")
    parser.add_argument("--only", nargs="*", choices=KINDS, default=list(KINDS))
    options = parser.parse_args()
    outcomes: dict[str, list[str]] = {}
    for seed, kind in product(range(options.cases), options.only):
        begin = time.process_time()
        try:
            word = KINDS[kind](np.random.default_rng(seed))
        except NoSolution as fault:
            word = str(fault)
        outcomes.setdefault(kind, []).append(word)
        print(f"{kind} {seed}: {word} ({time.process_time() - begin:.0f} s)", file=sys.stderr, flush=True)
        write_json(options.json, outcomes)
    print("| kind | drawn | right |\n|---|---|---|")
    for kind, words in outcomes.items():
        print(f"| {kind} | {len(words)} | {sum(w == 'right' for w in words)} |")


if __name__ == "__main__":
    main()
