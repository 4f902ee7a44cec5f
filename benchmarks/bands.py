"""Do the 95 % bands hold the truth where no sensor is? Machines that know all their temperatures, a third unmeasured.

    python benchmarks/bands.py --kinds jacket brushed incubator disc --count 8 --json FILE

Every machine loses a third of its thermometers, drawn by its seed; the user's network is calibrated on what is left,
and its bands are held against the truth in the tests that it was not calibrated on: where a thermometer sits or was
taken away, the temperature there; in parts that never had one, their mean.
Coverage of a kind is the share of instants inside, meaned over places and machines; its interval comes from machines.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from hidden.kinds import KINDS
from hidden.truth.archetype import Archetype, heated, measured
from hidden.truth.change import NOTHING
from hidden.user import case_of
from scipy import stats

from lumped.model.network import Row
from measured.case import Case
from scripts.published import benchmark_parser, table, write_rows
from validation import calibrate
from validation.bands import Place, bands, parameter_posterior

FIRST_SEED = {"dev": 900_000, "test": 950_000}  # none of the other benchmarks' machines
SILENT = 3  # one thermometer in so many is left out
REPORTED = ("jacket", "brushed", "incubator", "disc")


@dataclass(frozen=True)
class Held:
    """One place of one machine in one test.  inside : share of instants;  width, error : mean (K)"""

    kind: str
    seed: int
    place: str
    test: str
    seen: bool
    inside: float
    width: float
    error: float


def unmeasured(kind: Archetype, seed: int) -> set[str]:
    """Thermometers that are left out, in the user's words."""
    names = [kind.called.get(n, n) for n in kind.thermometers]
    return {
        str(n) for n in np.random.default_rng([seed, 11]).choice(names, max(1, len(names) // SILENT), replace=False)
    }


def without(case: Case, silent: set[str]) -> Case:
    return replace(
        case, tests=tuple(replace(t, channels=tuple(c for c in t.channels if c.name not in silent)) for t in case.tests)
    )


def machine(name: str, seed: int) -> Iterator[Held]:
    """Every place of one machine in every test that its calibration did not see."""
    kind, silent = KINDS[name], unmeasured(KINDS[name], seed)
    case = without(case_of(f"{name}-{seed}", name, measured(kind, seed, NOTHING)), silent)
    case = replace(case, model=calibrate(case).model)
    network, of = case.model.network, parameter_posterior(case)
    measured_places = {c.place for t in case.tests for c in t.channels}
    spots = {kind.called.get(n, n): spot for n, spot in kind.thermometers.items()}
    nodes = [n for n in kind.parts if n in network.states]
    asked = [Place(n, Row(np.array([network.column(n)]), np.ones(1))) for n in nodes]
    for plan in (p for p in kind.plans if p.role != "calibrate"):
        test, true = next(t for t in case.tests if t.name == plan.name), heated(kind, plan, seed, NOTHING)
        found = bands(of, test, asked)
        for k, node in enumerate(nodes):
            spot = spots.get(node)
            T = true.mean(kind.parts[node], kind.spans.get(node, (0.0, 1.0))) if spot is None else true.at_spot(spot)
            off = np.abs(found.y[:, k] - T)
            yield Held(
                name,
                seed,
                node,
                plan.name,
                node in measured_places,
                float(np.mean(off <= found.half95[:, k])),
                float(2.0 * found.half95[:, k].mean()),
                float(off.mean()),
            )


def rows(held: list[Held]) -> list[dict]:
    """Coverage and width per kind, with and without a sensor."""
    out = []
    for kind in (*dict.fromkeys(h.kind for h in held), "all"):
        mine = [h for h in held if kind in (h.kind, "all")]
        for seen, word in ((False, "without a sensor"), (True, "with a sensor")):
            some = [h for h in mine if h.seen is seen]
            each = [
                np.mean([h.inside for h in some if (h.kind, h.seed) == one])
                for one in dict.fromkeys((h.kind, h.seed) for h in some)
            ]
            mean = float(np.mean([h.inside for h in some]))
            half = float(stats.sem(each) * stats.t.ppf(0.975, len(each) - 1)) if len(each) > 1 else 0.0
            out.append(
                {
                    "case": kind,
                    "measure": f"inside the 95 % band, {word}",
                    "unit": "1",
                    "ours": mean,
                    "n": len(some),
                    "ci95": [max(mean - half, 0.0), min(mean + half, 1.0)],
                    "width_K": float(np.mean([h.width for h in some])),
                    "error_K": float(np.mean([h.error for h in some])),
                }
            )
    return out


def markdown(found: list[dict]) -> str:
    body = []
    for r in found:
        span = f"{100 * r['ci95'][0]:.0f} to {100 * r['ci95'][1]:.0f}"
        kelvin = (f"{r[key]:.1f}" for key in ("width_K", "error_K"))
        body.append([r["case"], r["measure"].split(", ")[1], f"{100 * r['ours']:.1f}", span, *kelvin, r["n"]])
    return table(["machine", "places", "inside (%)", "95 %", "width (K)", "error (K)", "n"], body)


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--kinds", nargs="+", choices=tuple(KINDS), default=list(REPORTED))
    parser.add_argument("--count", type=int, default=8, help="machines of every kind")
    parser.add_argument("--seeds", choices=tuple(FIRST_SEED), default="dev")
    parser.add_argument("--all", action="store_true", help="also every place")
    a = parser.parse_args()
    held = []
    for kind in a.kinds:
        for seed in range(FIRST_SEED[a.seeds], FIRST_SEED[a.seeds] + a.count):
            own = list(machine(kind, seed))
            held += own
            for h in own if a.all else ():
                word = "seen" if h.seen else ""
                print(
                    f"{h.kind:10s} {h.seed} {h.test:16s} {h.place:16s} {word:4s} {h.inside:5.2f} "
                    f"width {h.width:6.1f} error {h.error:5.1f}",
                    flush=True,
                )
    found = rows(held)
    print(markdown(found))
    write_rows(a.json, "bands", found, seeds=a.seeds)


if __name__ == "__main__":
    main()
