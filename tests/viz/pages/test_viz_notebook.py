"""Results show themselves: what a notebook would display carries the numbers and is safe to show."""

import sys
from types import SimpleNamespace

import numpy as np
from fictional import documents

import thermoscope as ts
from geom.table import Table, TableResult
from lumped.integration.steady import Steady
from lumped.model.build import bare_network
from measured.case import Model
from validation.comparison.compare import ChannelError, Comparison, TestError
from validation.inference.result import Candidate, Diagnosis
from validation.revision.revise import Change, Revision
from viz import Report

ERROR = ChannelError("T_<b>", "flange", 10, 600.0, 5.07, -4.0, 7.0, 0.5, 9.0, 1.0)
COMPARED = Comparison("road", 2, ("x@y",), (TestError("road-2", "hold-out", (ERROR,)),))
FOUND = Candidate("convection@flange", 31.4, 7.9, 12.3, "W/K", (10.0, 14.0), "named")


def test_errors_are_a_table_and_names_are_escaped():
    shown = COMPARED._repr_html_()
    assert "5.07" in shown
    assert "over" in shown
    assert "T_&lt;b&gt;" in shown
    assert "<b>," not in shown


def test_a_diagnosis_says_its_verdict():
    d = Diagnosis("named", "missing: convection", ("convection@flange",), (), (FOUND,), (), (), (), 5.0, 0.5, 7.9)
    assert "Missing: convection" in d._repr_html_()
    assert "12.3 (10 ... 14)" in d._repr_html_()


def test_a_step_shows_both_errors():
    change = Change("road-2", "hold-out", 4.85, 0.93)
    model = Model(bare_network("one", {"a": 5.0}, ("ambient",)))
    r = Revision("add", "x@y", model, True, "fell", (change,), (), COMPARED, COMPARED, True)
    assert "4.85" in r._repr_html_()
    assert "0.93" in r._repr_html_()


def test_network_and_report_show_themselves():
    assert "1 state," in bare_network("one", {"a": 5.0}, ("ambient",))._repr_html_()
    compare, diagnose = documents()
    framed = Report("road-test", comparison=compare, diagnosis=diagnose)._repr_html_()
    assert framed.startswith('<iframe title="report" srcdoc=')
    assert "<script" not in framed


def test_every_public_result_is_a_table_and_a_frame():
    """What `import thermoscope` promises as a result says itself in HTML and as a DataFrame."""
    network = bare_network("one", {"a": 5.0}, ("ambient",))
    steady = Steady(("a", "ambient"), np.array([40.0, 20.0]), np.zeros(0), None)
    shown = [COMPARED, FOUND, network, steady, ts.effects(), ts.open("tclab")]
    assert all(isinstance(one, TableResult) for one in shown)
    assert all("<table>" in one._repr_html_() for one in [COMPARED, FOUND, steady, ts.effects(), ts.open("tclab")])
    results = {t for n in dir(ts) if isinstance(t := getattr(ts, n), type) and not issubclass(t, Exception)}
    assert all(issubclass(t, TableResult) for t in results - {ts.Effect, ts.Parameter, ts.Record})
    assert list(steady.to_frame()["degC"]) == [40.0, 20.0]
    assert list(FOUND.to_frame()["effect"]) == ["convection@flange"]
    assert {"title", "proof"} <= set(ts.effects().to_frame().columns)
    assert len(ts.effects().to_frame()) == len(ts.effects()) > 20
    for kind in (ts.Case, ts.Comparison, ts.Diagnosis, ts.Revision, ts.Field, ts.Machine, ts.Run, ts.Steady):
        assert issubclass(kind, TableResult)
        assert kind.tables is not TableResult.tables


def test_what_is_long_is_cut_and_counted():
    table = Table("t", ["n"], [[i] for i in range(100)])
    assert "and 70 more" in table.html()


def test_long_work_in_a_notebook_shows_a_bar_that_goes_when_it_ends(monkeypatch):
    seen = []
    display = SimpleNamespace(HTML=str, display=lambda first, display_id: SimpleNamespace(update=seen.append))
    shell = SimpleNamespace(kernel=True)
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell, display=display))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    ts.open("tclab").compare()
    assert any("<progress" in line for line in seen)
    assert seen[-1] == ""
    count = len(seen)
    del shell.kernel  # a terminal's
    ts.open("tclab").compare()
    assert len(seen) == count
