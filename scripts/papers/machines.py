"""The tests of machines: repeats, the two resistances, three bases, two machines that were not used, table II."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import t as student

from extras.bench.measuring.warming import Repeats, normalised_error, pooled_curves, repeats
from extras.bench.reduction.two_paths import Transfer, TwoPaths, end_errors, of_test, transferred
from geom import load_machine
from lumped.model.network import Network
from measured.case import Case, Test
from scripts.papers.page import Row, Section
from thermoscope.case_folder.folder import Folder, load_case
from thermoscope.case_folder.runs import readings
from validation.bases.base_heat import BaseHeat, base_heat
from validation.bases.which_base import BaseDeviance, base_hypotheses
from validation.calibration.calibrate import calibrated
from validation.parameters.unknowns import working

CASES = Path(__file__).resolve().parents[2] / "cases"
BASE_TESTS = ("wood", "plate", "bench")
BENCHES = ("bench", "bench-2", "bench-3")
OTHERS = ("m2", "m3")
GAPS_MM = {"M1": 1.4, "M2": 0.7, "M3": 1.0}
GAP = "k.liner-gap"
TRUTH = CASES.parent / "simulated" / "pmsm.truth.toml"
DRAWS = 15
TRUE_BASES = {"bench": "1.0 x 0.3 m, emissivity 0.1", "plate": "1.5 x 0.4 m, emissivity 0.03"}


@cache
def m1() -> Folder:
    return load_case(CASES / "pmsm-bases")


@cache
def others() -> dict[str, Transfer]:
    """M1's calibrated model on M2 and M3."""
    return {name: transferred(m1().case, load_case(CASES / "pmsm-machines" / name).case) for name in OTHERS}


@cache
def runs(quantity: str) -> Repeats:
    """Rise over ambient of the three equal tests at their end; `quantity` is "R" or "emf"."""
    rises, u = [], 0.0
    for test in (t for t in m1().case.tests if t.name in BENCHES):
        channel = next(c for c in test.channels if c.name.startswith(quantity))
        seen = np.flatnonzero(np.isfinite(channel.y) & (test.time > 0.75 * test.time[-1]))
        rises.append(float(np.mean(channel.y[seen] - test.boundaries["ambient"][seen])))
        u = max(u, channel.sigma_K)
    return repeats(rises, u)


def repeated() -> Section:
    table: list[tuple[Any, ...]] = [("", "mean of 3 (K)", "largest difference (K)", "limit (K)", "repeats")]
    for name, quantity in (("winding", "R"), ("magnets", "emf")):
        found = runs(quantity)
        word = "yes" if found.repeat else "no"
        table.append((name, f"{found.mean:.1f}", f"{found.spread:.1f}", f"{found.limit:.1f}", word))
    found = runs("R")
    U = 2.0 * found.limit / (1.96 * np.sqrt(2.0))
    two = normalised_error(found.mean + found.spread, found.mean, U, U)
    words = (
        "M1 on the bench three times, rise over ambient in the last quarter; the limit is what 95 % of pairs of "
        "runs stay below if only the meters' errors act. As published, differences are less than the uncertainty. "
        "There is no second M1 here; two machines agree while |E_n| is below 1, and the windings of the two runs "
        f"farthest apart have {abs(two):.2f}."
    )
    return Section("Figures 7 and 8: repeatability", words, table=tuple(table), picture="figure-7.png")


def rises_of(test: Test, quantity: str) -> tuple[Any, Any, float]:
    """Minutes, rises over ambient (K) where they were read, and the sensor's sigma (K)."""
    channel = next(c for c in test.channels if c.name.startswith(quantity))
    seen = np.isfinite(channel.y)
    return test.time[seen] / 60.0, (channel.y - test.boundaries["ambient"])[seen], channel.sigma_K


@cache
def paths() -> dict[str, TwoPaths]:
    """Test -> R_ext and R_w of the calibrated networks at the test's load."""
    out = {}
    for case in (m1().case, *(one.case for one in others().values())):
        for test in case.tests:
            if test.name not in BENCHES[1:]:
                out[test.name] = of_test(case, test)
    return out


def circuits() -> Section:
    head = ("test", "R_ext (K/W)", "R_w (K/W)", "winding (K)", "magnets (K)", "left at 50 to 125 % current (K)")
    rows = [
        (name, f"{p.R_ext:.3f}", f"{p.R_w:.4f}", f"{p.winding_K:.1f}", f"{p.machine_K:.1f}", f"{p.largest_K:.1f}")
        for name, p in paths().items()
    ]
    words = (
        "Any network reduced at its test's load, here those condensed from the geometry. The paper gives the circuit "
        "without values. The bases change R_ext and leave R_w; the residual is what constant resistances miss at "
        "other currents, since films grow with the rise."
    )
    return Section("Figure 10: two resistances", words, table=(head, *rows))


def _settled(case: Case) -> list[tuple[Any, ...]]:
    out = []
    for r in end_errors(case):
        verdict = "within" if r.within else "over"
        both = (f"{r.measured_C:.1f}", f"{r.simulated_C:.1f}", f"{r.difference_K:+.1f}")
        sensor = "winding" if r.channel.startswith("R_") else "magnets"
        out.append((r.test, sensor, *both, f"{r.U95_K:.1f}", f"{r.worst_K:.1f}", verdict))
    return out


HEAD = ("test", "", "measured (degC)", "simulated (degC)", "difference (K)", "95 % (K)", "worst case (K)", "")


def bases() -> Section:
    words = (
        "M1 calibrated on wood, plate and bench with 8 A direct current; `bench-2` chose nothing, `bench-3` was "
        "held out. As published, simulation minus measurement is below the measurement's uncertainty."
    )
    return Section("Figure 14: three bases", words, table=(HEAD, *_settled(m1().case)), picture="figure-14.png")


def machines() -> Section:
    rows = [row for one in others().values() for row in _settled(one.case)]
    words = (
        "The model calibrated on M1, with the dimensions, windings, losses and bases of M2 and M3 and nothing "
        "fitted to their tests. As published, the differences stay below the measurement's uncertainty."
    )
    if any(row[-1] == "over" for row in rows):
        words += " Where one does not (over), the table says so."
    return Section("Figures 15 and 16: M2 and M3", words, table=(HEAD, *rows), picture="figure-15-16.png")


@cache
def drawn() -> tuple[Network, list[dict[str, float]]]:
    """M1 calibrated anew on its three bases, and draws of its parameters from their joint uncertainty."""
    case = m1().case
    network, unknowns = working(case)
    fit = calibrated(network, [t for t in case.tests if t.role == "calibrate"], unknowns, {})
    random, root = np.random.default_rng(0), np.linalg.cholesky(fit.covariance)
    thetas = [fit.theta + root @ random.standard_normal(fit.theta.size) for _ in range(DRAWS)]
    return network, [fit.values, *(unknowns.values(np.clip(theta, *unknowns.bounds)) for theta in thetas)]


@cache
def carried_off(test: str) -> tuple[BaseHeat, list[BaseHeat]]:
    """What base and body carry off at a test's end, as calibrated and by every draw."""
    network, values = drawn()
    first, *others = (base_heat(network, next(t for t in m1().case.tests if t.name == test), v) for v in values)
    return first, others


def interval(test: str, way: str) -> tuple[float, float, float]:
    """Value, low and high (95 %, W/K) of `path_W_K` or `body_W_K`."""
    first, others = carried_off(test)
    value, sd = getattr(first, way), float(np.std([getattr(o, way) for o in others], ddof=1))
    wide = float(student.ppf(0.975, DRAWS - 1)) * sd
    return value, value - wide, value + wide


@cache
def tried() -> list[BaseDeviance]:
    """Every base held against every test of M1."""
    return base_hypotheses(m1().case)


@cache
def hidden() -> dict[str, Any]:
    """What the measurements were made with: only to be set beside what came out."""
    return tomllib.loads(TRUTH.read_text(encoding="utf-8"))


def table_two() -> Section:
    """The gap by its conductivity, body and bases by what they carry off per kelvin, each with its 95 % interval."""
    last = m1().history.last
    value, (low, high) = last.values[GAP], last.intervals[GAP]
    gap = f"{GAPS_MM['M1'] / value:.2f} ({GAPS_MM['M1'] / high:.2f} to {GAPS_MM['M1'] / low:.2f}) mm"
    true = f"hidden {GAPS_MM['M1'] / hidden()['drawn']['conductivity.slot.gap']:.2f} mm"
    rows = [Row("gap of M1", "1.4 mm", gap, f"{true}; as drawn, over the multiplier of its conductivity")]
    for name, published in TRUE_BASES.items():
        heat, _ = carried_off(name)
        ours = (
            f"{_with_interval(name, 'path_W_K')}: {heat.conduction:.1f} W through the foot, "
            f"{heat.convection:.1f} W by convection, {heat.radiation:.1f} W by radiation"
        )
        rows.append(Row(f"base, {name}", published, ours, f"hidden {hidden()[name]['base_path_W_K']:.2f} W/K"))
    rows += [
        Row(f"body, {name}", "-", _with_interval(name, "body_W_K"), f"hidden {hidden()[name]['body_path_W_K']:.2f} W/K")
        for name in BASE_TESTS
    ]
    words = (
        "The paper sets base and gap by hand until the curves agree; here they are fitted to the three tests together, "
        "with 95 % intervals, and beside them stands what the measurements were made with. The bases' dimensions are "
        "those of table II, in the network condensed from the geometry; what is fitted are their contacts and films. "
        "Heat of a base per kelvin of the laminations at the test's end, when stored heat still flows. Gaps of M2 and "
        "M3 (0.7 and 1.0 mm) are taken as drawn, with M1's conductivity."
    )
    return Section("Table II: gap and base", words, tuple(rows))


PUBLISHED_W = {"bench": ("pmsm-m1", 222, 0), "m2": ("pmsm-m2", 246, 77), "m3": ("pmsm-m3", 729, 76)}


def constructive() -> Section:
    """The grey part of table II: the machines as their files have them, and the losses of their tests."""
    losses = ("copper loss, published (W)", "here (W)", "magnetic loss, published (W)", "here (W)")
    table: list[tuple[Any, ...]] = [("machine", "slots / poles", "length (mm)", "conductors per slot", *losses)]
    for test, (name, copper, magnetic) in PUBLISHED_W.items():
        machine, path = load_machine(name), paths()[test]
        g, own = machine.geometry, machine.sections["losses"]
        ours = own["iron"]["hysteresis_W"] + own["iron"]["eddy_W"] + own["magnet"]["P_W"] if magnetic else 0
        size = (f"{1e3 * g.frame.length:.0f}", machine.sections["ratings"]["conductors_per_slot"])
        watts = (copper, f"{path.P_w:.0f}", magnetic, f"{ours:.0f}")
        table.append((name.removeprefix("pmsm-").upper(), f"{g.stator.slots} / {g.rotor.poles}", *size, *watts))
    words = (
        "M1 at 8 A direct current on the bench, M2 and M3 at 16 A and 383 rpm, at rest. The machine files give the "
        "published losses with the winding at 100 degC; the resistances of the simulated machines are drawn around "
        "theirs and measured cold, and copper loses more the hotter it ends: M3's winding is at 165 degC."
    )
    return Section("Table II: machines and losses", words, table=tuple(table))


def _with_interval(test: str, way: str) -> str:
    return "{:.2f} ({:.2f} to {:.2f}) W/K".format(*interval(test, way))


def wrong_base() -> Section:
    """Every base held against every test."""
    ways = ("through the foot (W)", "convection (W)", "radiation (W)")
    head = ("test", "base", "sheet", "deviance over the best", "", *ways)
    rows = [
        (
            h.test,
            h.base,
            "yes" if h.declared else "",
            f"{h.deviance:.1f}",
            "excluded" if h.excluded else "possible",
            f"{h.heat.conduction:z.0f}",
            f"{h.heat.convection:z.0f}",
            f"{h.heat.radiation:z.0f}",
        )
        for h in tried()
        if h.test in BASE_TESTS
    ]
    words = (
        "The paper calibrates each base by hand and cannot ask whether it was the right one. `thermoscope bench "
        "bases`, and `diagnose` before it names an effect, fit all tests together for every base a test may have "
        "stood on; the tests on other bases hold the body's films. A deviance above 10 excludes a base. Bases "
        "that are not excluded differ by less than the meters tell."
    )
    return Section("Figures 12 and 13: which base a test stood on", words, table=(head, *rows))


def pictures() -> dict[str, object]:
    """File name -> matplotlib figure."""
    first = [(m1().case, t) for t in m1().case.tests if t.name not in BENCHES[1:]]
    second = [(one.case, t) for one in others().values() for t in one.case.tests]
    return {"figure-7.png": _repeats(), "figure-14.png": _curves(first), "figure-15-16.png": _curves(second)}


def _repeats() -> Figure:
    """Three equal tests: their readings, their mean, and the band of one reading's 95 % uncertainty around it."""
    figure = Figure((6, 3.4), layout="constrained")
    axes = figure.subplots()
    for name, quantity, color in (("winding", "R", "C0"), ("magnets", "emf", "C1")):
        found = [rises_of(t, quantity) for t in m1().case.tests if t.name in BENCHES]
        for marker, (minutes, rise, _) in zip("o^s", found, strict=True):
            axes.plot(minutes / 60, rise, marker, ms=3, color=color)
        minutes, mean, _ = pooled_curves([m for m, _, _ in found], [rise for _, rise, _ in found])
        wide = 2 * found[0][2]
        axes.plot(minutes / 60, mean, color=color, label=name)
        axes.fill_between(minutes / 60, mean - wide, mean + wide, color=color, alpha=0.2, lw=0)
    axes.set(xlabel="time (h)", ylabel="rise over ambient (K)", title="Three equal tests of M1 on the bench")
    axes.legend()
    return figure


def _curves(tests: list[tuple[Case, Test]]) -> Figure:
    """Rises: lines simulated, marks measured with their 95 % uncertainty."""
    figure = Figure((4.2 * len(tests), 3.4), layout="constrained")
    for axes, (case, test) in zip(np.ravel(figure.subplots(1, len(tests), sharey=True)), tests, strict=True):
        calculated, air = readings(case, test), test.boundaries["ambient"]
        for channel in test.channels:
            word = "winding" if channel.name.startswith("R_") else "magnets"
            (line,) = axes.plot(test.time / 3600, calculated[channel.name] - air, label=word)
            axes.errorbar(test.time / 3600, channel.y - air, 2 * channel.sigma_K, fmt="o", ms=3, color=line.get_color())
        axes.set(xlabel="time (h)", title=test.name)
        axes.legend()
    figure.axes[0].set_ylabel("rise over ambient (K)")
    return figure
