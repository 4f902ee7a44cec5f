"""One fact, one number, one colour: terminal, JSON, report, workbench, viewer and pictures of a case agree."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from html import unescape
from pathlib import Path

import pytest
from motor_case import with_motor
from small_case import small_case

from extras.workbench import tables as rows
from extras.workbench.appearance import appearance_of
from geom.table import percent
from thermoscope.case_folder import runs
from thermoscope.case_folder.folder import load_case
from thermoscope.commands.show.viewer import viewer_page
from viz.colours import VERDICT
from viz.data import sensors, short
from viz.figures.candidates import posterior
from viz.figures.errors import before_after
from viz.figures.paper import svg

pytestmark = pytest.mark.heavy
ROOT = Path(__file__).parents[2]
CSS = {"within": "ok", "hot": "bad", "cold": "cold"}
PLACES = dict.fromkeys(("T_winding", "T_yoke", "T_flange"), (0.0, 0.0, 0.0))
EFFECT = "convection@flange"
DRAWN = ROOT / "tests" / "viz" / "pages" / "viewer_in_node.js"


@pytest.fixture(scope="module")
def told(thermoscope, tmp_path_factory):
    """What each medium says of one case: the text, document or page by its name."""
    case = small_case(tmp_path_factory.mktemp("told"), 6.0, step=20.0)
    thermoscope("calibrate", case)
    media = {"wrong": load_case(case), "wrong page": page(thermoscope, case)}
    media["before"] = thermoscope("compare", case, "--json", "-").document
    media["diagnose"] = thermoscope("diagnose", case, "--json", case / "d.json").out
    media["diagnosis"] = json.loads((case / "d.json").read_text())
    media["diagnosed page"] = page(thermoscope, case)
    media["add"] = thermoscope("add", case, EFFECT, "--json", case / "a.json").out
    media["step"] = json.loads((case / "a.json").read_text())
    media["compare"] = thermoscope("compare", case, "--json", "-").document
    media["right"], media["page"] = load_case(case), page(thermoscope, case)
    return media


def page(thermoscope, case) -> str:
    """The report of a case, its arrows as the terminal has them."""
    assert thermoscope("report", case).code == 0
    return unescape((case / "out" / "report.html").read_text()).replace("→", "->").replace("\u00a0", " ")


def numbers(text: str, pattern: str) -> set[str]:
    return set(re.findall(pattern, text))


def test_what_was_found_is_one_sentence(told):
    """The error before is that of the calibrated model, on the same test, as `compare` printed it then."""
    found = told["step"]["found"]
    before, after = (next(t for t in told[key]["tests"] if t["name"] == "town") for key in ("before", "compare"))
    pair = f"Held out {before['rmse_K']:.2f} -> {after['rmse_K']:.2f} K"
    assert found.startswith("Found: forced convection by vehicle wind at flange. ")
    assert pair in found
    assert f'<span class="good">{found}</span>' in told["page"], "green, and the same words"
    assert " ".join(told["add"].split()).startswith(found)
    assert runs.finding_words(told["right"], appearance_of(told["right"]).errors) == found
    undone = replace(told["right"], history=told["right"].history.back_to(1))
    assert runs.finding_words(undone, told["compare"]) == ""
    worst = max((c["rmse_K"], c["channel"], c["limit_K"]) for t in told["compare"]["tests"] for c in t["channels"])
    assert f"at most {worst[0]:.1f} K, {short(worst[1])} in" in found
    assert f"(limit {worst[2]:.1f})" in found
    last, second = told["right"].history.last, "convection@yoke"
    step = replace(last, effect=second, effects=(EFFECT, second), rmse_K={"town": (after["rmse_K"] + 1.0, 0.0)})
    twice = replace(told["right"], history=told["right"].history.and_then(step))
    both = runs.finding_words(twice, told["compare"])
    assert both.startswith("Found: forced convection by vehicle wind at yoke. ")
    assert f"Held out {after['rmse_K'] + 1.0:.2f} -> {after['rmse_K']:.2f} K; since calibration, with " in both
    assert f"vehicle wind at flange, from {before['rmse_K']:.2f} K. Left" in both, "one step, one before"


def test_the_error_of_the_held_out_test_is_one_pair_of_numbers(told):
    """In the table of `add`, the bars of report and workbench; nowhere another pair for it."""
    before, after = (next(t for t in told[key]["tests"] if t["name"] == "town") for key in ("before", "compare"))
    pair = f"{before['rmse_K']:.2f} -> {after['rmse_K']:.2f} K"
    step = next(t for t in told["step"]["tests"] if t["name"] == "town")["rmse_K"]
    assert (step["before"], step["after"]) == pytest.approx((before["rmse_K"], after["rmse_K"]), rel=1e-4), (
        "model.toml has eight digits"
    )
    bars = svg(before_after(told["step"]["tests"]), "bars").replace("→", "->")
    assert pair in unescape(bars).replace("\u00a0", " ")
    look = appearance_of(told["right"])
    (bar,) = (b for b in rows.tests(look, 1.0, {"town": step["before"]}) if b["name"] == "town")
    assert f"{bar['before']} -> {bar['rmse']} K" == pair
    arrows = r"\d+\.\d+ -> \d+\.\d+ K"
    others = {f"{t['rmse_K']['before']:.2f} -> {t['rmse_K']['after']:.2f} K" for t in told["step"]["tests"]}
    assert numbers(told["page"], arrows) <= others
    assert numbers(told["diagnose"] + told["diagnosed page"], arrows) <= others | {
        f"{t['rmse_K']:.2f} -> {t['rmse_K']:.2f} K" for t in told["before"]["tests"]
    }, "what a refit would do is told as a share: the model that stands has other numbers"


def test_the_odds_are_one_number(told):
    """Of the leading cause: in the table, the report's list and the workbench."""
    best = told["diagnosis"]["candidates"][0]
    odds = percent(best["probability"])
    (lead,) = (x for x in told["diagnosis"]["explanations"] if x["cause"] == EFFECT)
    assert lead["probability"] == pytest.approx(best["probability"])
    assert rows.candidates(told["diagnosis"], ())[0]["score"] == odds
    assert numbers(told["diagnose"], r"(?m)^(.*?)  forced convection by vehicle wind at flange") == {odds}
    assert f">\u00a0{odds}<" in unescape(svg(posterior(told["diagnosis"]["explanations"]), "odds")), "and the picture"
    code = rf'<code class="code">{EFFECT}</code>'
    assert re.search(rf"{code}</td><td>{re.escape(odds)}</td>", told["diagnosed page"])


@pytest.mark.parametrize("stage", ["wrong", "right"])
def test_a_sensor_has_one_colour(told, stage):
    """Its dot, its residual, the workbench's list and the report's table."""
    folder, html = told[stage], told["page" if stage == "right" else "wrong page"]
    look, css = appearance_of(folder), (ROOT / "extras/workbench/page.css").read_text()
    over = 0
    for test in folder.case.tests:
        comparison = look.curves[test.name]
        dots = {s.name: s for s in sensors(comparison, PLACES)}
        for channel, bar in zip(comparison.channels, rows.channels(look, test.name, 1.0), strict=True):
            dot = dots[channel.name]
            assert comparison.residual_curve(channel).colour == dot.colour == VERDICT[bar["tone"]]
            assert bar["verdict"] == ("within" if dot.verdict == "within" else "over")
            if bar["tone"] != "within":
                over += 1
                assert f'<span class="{CSS[bar["tone"]]}">over ({bar["tone"]})</span>' in html
    assert (over > 0) == (stage == "wrong")
    (fell,), (left,) = (re.findall(rf"\.bar \.{part} {{ background: (.*?);", css) for part in ("was", "now"))
    assert fell == left, "what fell is pale in the workbench as in the report, of one colour"
    assert {VERDICT[name].lower() for name in CSS} <= numbers(css.lower(), r"#[0-9a-f]{6}")


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
def test_the_viewer_colours_its_sensors_alike(tmp_path):
    """At every instant as the test as a whole says, so that the list beside it has no other colour."""
    folder = with_motor(small_case(tmp_path, step=20.0))
    (tmp_path / "v.html").write_text(viewer_page(folder, lambda message: None))
    found = subprocess.run(["node", DRAWN, tmp_path / "v.html", "0", "0"], capture_output=True, text=True, check=True)
    first = runs.by_interest(folder)[0]
    dots = sensors(runs.comparison_of(folder, first), folder.positions)
    verdicts = json.loads(found.stdout)["verdicts"]
    assert [list(VERDICT)[i] for i in verdicts] == [s.verdict for s in dots]
    assert {"within", "cold"} <= {s.verdict for s in dots}
