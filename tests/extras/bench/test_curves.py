"""Warming curves of a case: eq. 8 recovered, equilibrium, the published rule, equal tests pooled."""

from dataclasses import replace

import numpy as np
import pytest
from test_drift import network

from extras.bench.measuring.curves import alike, constant, curve, curves
from extras.bench.measuring.warming import eq8
from lumped.model.build import node_row
from measured.case import Case, Channel, Model, Test

MINUTES = np.arange(0.0, 181.0, 1.0)
AIR = 20.0


def run_of(name, y, current=8.0):
    time = 60.0 * MINUTES
    inputs = {"current_A": np.broadcast_to(np.asarray(current, float), time.shape)}
    channel = Channel(f"T@{name}", "body", node_row(0), np.asarray(y, float), 0.5)
    return Test(name, "calibrate", time, inputs, {"ambient": np.full(time.size, AIR)}, (channel,), AIR)


def true():
    return AIR + 50.0 * (1 - np.exp(-MINUTES / 50.0))


def test_published_curve_is_recovered():
    test = run_of("eq8", eq8(MINUTES, 85.0, -0.652, -0.08))
    found = curve(test, test.channels[0])
    assert [found.warming.a, found.warming.b, found.warming.c] == pytest.approx([85.0, -0.652, -0.08], rel=1e-6)
    assert "the formula starts at 44.3 degC, the record at 20.0 degC" in found.warming.warnings[0]
    assert found.equilibrium.reached


def test_a_load_that_varies_has_no_eq8():
    test = run_of("ramp", true(), np.linspace(4.0, 8.0, MINUTES.size))
    assert not constant(test)
    found = curve(test, test.channels[0])
    assert found.warming is None
    assert "constant load" in found.why


def test_short_record_says_what_it_lacks():
    test = run_of("short", true())
    sparse = replace(test.channels[0], y=np.where(MINUTES % 90 == 0, true(), np.nan))
    found = curve(test, sparse)
    assert found.warming is None
    assert found.equilibrium is None
    assert "eq. 8: 3 readings" in found.why


def test_equal_tests_are_pooled_and_repeat():
    runs = [run_of(f"run-{k}", true() + off) for k, off in enumerate((-0.3, 0.0, 0.3))]
    other = run_of("hotter", true(), 16.0)
    assert [[t.name for t in group] for group in alike([*runs, other])] == [["run-0", "run-1", "run-2"]]
    found = curves(Case("body", Model(network()), (*runs, other)))
    (key, pooled), *more = found.pooled.items()
    assert key == (("run-0", "run-1", "run-2"), "body")
    assert not more
    assert pooled.n == 3
    assert pooled.repeat
    assert found.agrees


def test_rule_counts_per_assembly():
    """10 K too warm of 68.6 degC is 14 %: beyond 7 %, and the case does not agree; the document has all of it."""
    found = curves(Case("body", Model(network()), (run_of("off", true() - 10.0),)))
    assert found.rules["off"][0].verdict == "beyond 7 %"
    assert not found.agrees
    document = found.document()
    assert document["tests"][0]["assemblies"][0]["place"] == "body"
    assert document["tests"][0]["curves"][0]["eq8"]["tau95_min"] > 0
