"""Figures: written, not blank, and carrying the numbers they were given."""

import os
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from fictional import HISTORY, candidates, comparison
from PIL import Image

from extras.bench import figure as screening
from geom.errors import InputError
from viz.colours import BLUE, VERDICT
from viz.data import Comparison
from viz.figures import bands as uncertain, candidates as scores, curves, errors, paper
from viz.figures.bands import intervals
from viz.labels import minus, signed, spread_labels
from viz.live import sensor as live_sensor

EFFECTS = {
    "margin": 1.0,
    "simultaneous": 1.8,
    "effects": [
        {"effect": e, "words": w, "value": v, "active": abs(v) > 1.8}
        for e, w, v in (
            ("A", "convection", -19.2),
            ("B", "emissivity", -17.4),
            ("AB", "convection x emissivity", 4.6),
            ("E", "end-winding impregnation", 0.2),
            ("F", "speed", 0.4),
        )
    ],
}
RANKED = [{"factor": "base", "measure": 0.44, "conf95": 0.16}, {"factor": "speed", "measure": 0.01, "conf95": 0.01}]
DRIFT = {"cause": "sensor.drift@T_base", "words": "sensor drifts during the test at T_base", "probability": 0.06}
EXPLANATIONS = [
    {"cause": cause, "words": words, "probability": p, "alone": alone, "partners": [DRIFT] if alone < p else []}
    for cause, words, p, alone in (
        ("wind@flange", "wind at flange.right", 0.93, 0.8),
        ("nothing", "nothing is missing", 0.05, 0.05),
        ("heat@yoke", "heat of unknown cause at yoke", 0.016, 0.016),
    )
]
HOUR = np.linspace(0.0, 3600.0, 61)
WARM = 20.0 + 60.0 * (1.0 - np.exp(-HOUR / 1200.0))
PLACES = [
    uncertain.Predicted("sensor T_yoke_degC", WARM, 0.03 * (WARM - 20.0), WARM + 1.0),
    uncertain.Predicted("armature", WARM + 20.0, 0.2 * (WARM - 20.0)),
]
VALUE = {"name": "link.a-b", "value": 1.2, "unit": "1", "ci95": [1.1, 1.3], "prior": [1.0, 0.5, 2.0]}
VALUE |= {"identified": True}


def driven(c):
    """With an input that changes: it is drawn below the sensors."""
    flow = np.linspace(0.0, 2.0, len(c.test.time))
    return replace(c, test=replace(c.test, inputs={"fan_flow_mps": flow, "steady_A": 3.0}))


DRAW = {
    "predicted": lambda png: uncertain.predicted(HOUR, PLACES, title="road-1", png=png),
    "curves": lambda png: curves.measured_and_model(driven(comparison(before=True)), png=png),
    "intervals": lambda png: intervals([VALUE], png=png),
    "residuals": lambda png: curves.residuals(comparison(), png=png),
    "before_after": lambda png: errors.before_after(HISTORY[-1]["tests"], floor_K=0.6, png=png),
    "staircase": lambda png: errors.staircase(HISTORY, floor_K=0.6, png=png),
    "scores": lambda png: scores.scores(
        [{**c, "words": c["effect"].replace("@", " at ")} for c in candidates()], png=png
    ),
    "posterior": lambda png: scores.posterior(EXPLANATIONS, png=png),
    "screened": lambda png: screening.screened(EFFECTS, title="magnets", png=png),
    "ranking": lambda png: screening.ranking(RANKED, measure="Sobol ST", png=png),
    "confusion": lambda png: scores.confusion(["a@x", "b@y"], np.array([[1.0, 0.83], [0.83, 1.0]]), png=png),
}
SHOWS = {
    "intervals": ["link.a-b", "1.2 (1.1 … 1.3)", "how sure they are"],
    "predicted": ["yoke", "± 1.7 K", "armature", "no sensor", "± 11.4 K", "road-1", "95 % band (°C)"],
    "curves": ["flange.right", "earlier model", "measured and modelled (°C)", "fan flow (m/s)"],
    "residuals": ["flange.right", "measured − model (K)", "time (min)"],
    "before_after": ["4.85 → 0.93 K", "road-2", "rms error (K)", "pale: what fell"],
    "staircase": ["road-2 (hold-out)", "+ forced", "vehicle", "rms error (K)", "strong: never used"],
    "scores": ["convection at flange.right", "12.3 W/m2/K", "as probable as nothing"],
    "posterior": ["wind at flange.right", "93 %", "with: sensor drifts", "nothing is missing", "probability (%)"],
    "screened": ["convection x emissivity", "AB", "half-normal quantile", "Lenth, all at once", "|high - low| (K)"],
    "ranking": ["base", "speed", "Sobol ST"],
    "confusion": ["a@x", "b@y", ".83"],
}


@pytest.mark.parametrize("name", DRAW)
def test_figure_is_drawn_and_labelled(name, tmp_path):
    figure = DRAW[name](tmp_path / "f.png")
    assert np.asarray(Image.open(tmp_path / "f.png").convert("L")).std() > 8
    text = paper.svg(figure, name).replace("\u00a0", " ")
    assert [word for word in SHOWS[name] if word not in text] == []


def test_what_drove_a_test_is_promised_only_where_something_changed():
    steady = comparison()
    for c, inputs in ((driven(steady), True), (steady, False)):
        assert ("what drove it" in curves.measured_and_model(c)._suptitle.get_text()) == inputs


def test_a_curve_has_the_colour_of_its_sensor():
    c = comparison()
    colours = {ch.name: c.residual_curve(ch).colour for ch in c.test.channels}
    assert colours.pop("flange.right") == BLUE
    assert set(colours.values()) == {VERDICT["within"]}


def test_sensor_that_was_never_read_is_left_out():
    c = comparison()
    silent = replace(c.test.channels[0], y=np.full(len(c.test.time), np.nan))
    c = replace(c, test=replace(c.test, channels=(silent, *c.test.channels[1:])))
    text = paper.svg(curves.residuals(c), "r")
    assert silent.name not in text
    assert "flange.right" in text


def test_of_many_residuals_the_worst_have_names():
    c = comparison()
    first, y = c.test.channels[0], c.model[c.test.channels[0].name]
    many = tuple(replace(first, name=f"T{k}", y=y + k) for k in range(8))
    limits = dict.fromkeys([x.name for x in many], 2.5)
    (ax,) = curves.residuals(Comparison(replace(c.test, channels=many), dict.fromkeys(limits, y), limits)).axes
    assert sorted(text.get_text() for text in ax.texts) == [f"T{k}" for k in range(2, 8)]
    assert "pale: 2 more" in ax.get_title("left")


def test_long_test_is_drawn_in_hours_with_few_points():
    c = comparison()
    many = 50_000
    time = np.linspace(0.0, 36_000.0, many)
    channels = tuple(replace(ch, y=np.interp(time, 10 * c.test.time, ch.y)) for ch in c.test.channels)
    test = replace(c.test, time=time, channels=channels, inputs={})
    model = {k: np.interp(time, 10 * c.test.time, y) for k, y in c.model.items()}
    svg = paper.svg(curves.measured_and_model(Comparison(test, model, c.limits)), "long")
    assert "time (h)" in svg
    assert len(svg) < 400_000


@pytest.mark.parametrize("share", [0.3, 0.99])
def test_words_at_a_level_do_not_run_into_the_title(share):
    top = 1.12 * max(max(path) for path in errors.error_paths(HISTORY).values())
    figure = errors.staircase(HISTORY, plain_K=share * top)
    figure.canvas.draw()
    (words,) = (t for t in figure.axes[0].texts if t.get_text() == "best plain model")
    title = figure.axes[0].title if figure.axes[0].title.get_text() else figure.axes[0]._left_title
    assert not words.get_window_extent().overlaps(title.get_window_extent())


LEVELS = ("sensors' uncertainty", "best plain model")


def test_words_at_two_close_levels_stand_beside_each_other():
    figure = errors.staircase(HISTORY, floor_K=0.6, plain_K=0.65)
    figure.canvas.draw()
    words = [t.get_window_extent() for t in figure.axes[0].texts if t.get_text() in LEVELS]
    assert len(words) == 2
    assert not words[0].overlaps(words[1])


def test_staircase_path_starts_before_the_first_revision():
    assert errors.error_paths(HISTORY)["road-2", "hold-out"] == [6.4, 4.85, 0.93]


def test_svg_ids_of_two_plots_do_not_meet():
    ids = [set(re.findall(r'id="([^"]+)"', paper.svg(DRAW["staircase"](None), name))) for name in ("one", "two")]
    assert ids[0]
    assert not ids[0] & ids[1]


def test_svg_follows_the_page_theme():
    svg = paper.svg(DRAW["residuals"](None), "r")
    assert "var(--ink, #1f2933)" in svg
    assert not re.search(r"(?<!, )#1f2933", svg)


def test_labels_keep_their_distance_and_order():
    out = np.array(spread_labels([0.0, 0.01, 0.02, 1.0], 0.0, 1.0, 0.1))
    assert (np.diff(out) >= 0.1 - 1e-12).all()
    assert 0 <= out.min() <= out.max() <= 1


def test_channel_without_model_curve_is_named():
    c = comparison()
    with pytest.raises(InputError, match=r"no model curve for flange\.right"):
        Comparison(c.test, {k: v for k, v in c.model.items() if k != "flange.right"}, c.limits)


def test_a_value_far_from_what_was_expected_is_an_arrow_at_the_edge():
    far = {**VALUE, "words": "link of a and b", "value": 9.0, "ci95": [8.0, 10.0]}
    (ax,) = intervals([far, VALUE]).figure.axes
    assert [label.get_text() for label in ax.get_yticklabels()] == ["link.a-b", "link of a and b"]
    marks = {line.get_marker(): line.get_xdata()[0] for line in ax.lines if len(line.get_xdata()) == 1}
    assert set(marks) == {"o", ">"}
    assert marks[">"] < ax.get_xlim()[1]


def test_empty_history_is_refused():
    with pytest.raises(InputError, match="at least one revision"):
        errors.staircase([])


def test_what_would_have_to_differ_is_drawn_with_what_cannot(tmp_path):
    names = ("parameter", "others", "here", "sd", "possible", "relative", "unit")
    rows = ("capacity.stator", 1.0, 2.7, 6.0, False, True, "1"), ("bias of T", 0.1, -0.9, -4.0, True, False, "K")
    found = {"limit": 3.0, "differences": [{"test": "run4", "nats": 9.0, **dict(zip(names, r))} for r in rows]}
    figure = scores.differences(found, png=tmp_path / "differences.png")
    (ax,) = figure.axes
    assert [t.get_text() for t in ax.get_yticklabels()] == ["bias of T in run4", "capacity.stator in run4"]
    assert [t.get_text().strip("\u00a0") for t in ax.texts] == ["−1 K", "x 2.7"]
    colours = [bar.get_facecolor() for bar in ax.patches]
    assert colours[0] != colours[1]


def test_the_band_around_readings_is_what_counts_as_within():
    """As wide as twice the limit of the sensor, on paper and in the browser."""
    c = comparison()
    channel = next(ch for ch in c.channels if ch.name == "flange.right")
    c = replace(c, limits={**c.limits, channel.name: 3.7})
    figure = curves.measured_and_model(c)
    ax = next(ax for ax in figure.axes if ax.get_title(loc="left") == "flange.right")
    around = ax.collections[-1].get_paths()[0].vertices
    at = around[:, 0] == np.median(around[1:, 0])
    assert np.ptp(around[at, 1]) == pytest.approx(2 * 3.7)
    low, high, *_, residual = live_sensor(c, channel.name).data
    assert np.asarray(high.y) - np.asarray(low.y) == pytest.approx(2 * 3.7)
    assert np.nanmax(np.abs(residual.y)) == pytest.approx(np.nanmax(np.abs(c.residual(channel)[c.thin])))


def test_readings_without_neighbours_are_dots():
    """A line through one reading is nothing: every fifth instant is read, as a resistance is."""
    dense = comparison()
    first = dense.channels[0]
    sparse = np.where(np.arange(len(first.y)) % 5 == 0, first.y, np.nan)
    one = replace(dense, test=replace(dense.test, channels=(replace(first, y=sparse),)))
    for draw, shown in ((curves.measured_and_model, sparse), (curves.residuals, one.residual(one.channels[0]))):
        dots = [line for line in draw(one).axes[0].lines if line.get_marker() == "o"]
        assert len(dots) == 1
        np.testing.assert_array_equal(dots[0].get_ydata(), shown[np.isfinite(shown)])
    assert not [line for line in curves.residuals(dense).axes[0].lines if line.get_marker() == "o"]


def test_a_printed_sign_is_the_one_of_mathematics():
    assert [signed(-1.94), signed(0.04), signed(-0.04), signed(12.0, 0)] == ["−1.9", "+0.0", "+0.0", "+12"]
    assert minus("-0.5") == "−0.5"


def test_curves_of_a_page_are_the_same_from_two_processes_and_beside_other_threads():
    """A thread beside others forks nothing: what they hold locked would stay so in the other process."""

    def draws(count):
        return [lambda i=i: (paper.svg(curves.residuals(comparison()), f"r{i}"), os.getpid()) for i in range(count)]

    with ThreadPoolExecutor(1) as pool:
        alone = pool.submit(paper.draw_all, draws(4)).result()
    assert {pid for _, pid in alone} == {os.getpid()}
    assert [text for text, _ in paper.draw_all(draws(4))] == [text for text, _ in alone]
