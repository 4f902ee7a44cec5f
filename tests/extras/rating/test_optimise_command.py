"""thermoscope use optimise: a small case end to end, machine files that build, and what is wrong as one message."""

import csv
from pathlib import Path
from types import SimpleNamespace

import pytest
from command_line import refusal
from small_case import small_case

from extras.rating.design.condensations import Condensations
from extras.rating.design.design_problem import temperatures_of
from extras.rating.design.machine_keys import MachineFile, machine_file_text
from extras.rating.optimisation import search
from extras.rating.optimisation.space import Space
from geom import load_machine
from geom.description.reading import read_geometry
from geom.machine_file import families
from lumped.build.pipeline import build
from thermoscope.case_folder.runs import mean_rows

EFFORT = ("--population", "12", "--generations", "4")


def test_a_pareto_set_of_a_case(thermoscope, tmp_path):
    """Less current is cooler and gives less copper loss: of two variables one stays at its bound."""
    case, out = small_case(tmp_path), tmp_path / "designs"
    words = ["--limit", "winding=400", "--vary", "current_A=40:90", "--at", "ambient=20", "--json", "-"]
    said = thermoscope("use", "optimise", case, *words, *EFFORT, "--out", out)
    assert said.code == 0, said.err
    best = said.document["designs"][0]
    assert best["values"]["current_A"] < 50.0
    air = 3.0 + 1.0 / (1.0 / 6.0 + 1.0 / 1.5)
    K = 1.0 / 8.0 + 1.0 / air
    P = 0.02 * best["values"]["current_A"] ** 2
    assert best["peak_degC"] == pytest.approx(20.0 + P * K / (1.0 - 0.00393 * P * K), rel=1e-6)
    rows = list(csv.DictReader((out / "pareto.csv").open()))
    assert len(rows) == len(said.document["designs"])
    page = (out / "pareto.html").read_text()
    assert "parcoords" in page
    assert "scatter3d" in page


def test_a_search_that_is_stopped_gives_the_best_so_far(thermoscope, tmp_path, monkeypatch):
    """Ctrl-C in the third generation."""
    case, out = small_case(tmp_path), tmp_path / "designs"
    usual, calls = search.judged, []

    def judged(problem, X, executor=None):
        calls.append(len(X))
        if len(calls) == 3:
            raise KeyboardInterrupt
        return usual(problem, X, executor)

    monkeypatch.setattr(search, "judged", judged)
    words = ["--limit", "winding=400", "--vary", "current_A=40:90", "--at", "ambient=20", "--json", "-"]
    said = thermoscope("use", "optimise", case, *words, *EFFORT, "--out", out)
    assert said.code == 130
    assert said.document["judged"] == sum(calls[:2]) == 24
    before, stopped = "48 designs are judged, about ", "24 of 48 designs were judged; the best of these are written"
    assert said.err.index(before) < said.err.index(stopped), "how long it takes is said before it begins"
    assert len(list(csv.DictReader((out / "pareto.csv").open()))) == len(said.document["designs"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "no limit is given"),
        (("--limit", "winding=155"), "no flow, jacket or fins that a design could change"),
        (("--limit", "winding=10", "--vary", "current_A"), "limit of 'winding', 10 degC, is exceeded without any load"),
        (
            ("--limit", "winding=30", "--vary", "current_A=80:90", *EFFORT),
            "no design of 48 meets all limits: the nearest one exceeds 'winding <= 30 degC' by",
        ),
        (("--limit", "winding=155", "--vary", "fins"), "'fins' is nothing that a design could change"),
        (("--limit", "winding=155", "--vary", "current_A=9:2"), "'current_A=9:2' is not a range"),
        (("--limit", "winding=155", "--vary", "current_A", "--method", "ga"), "'ga' is not a method"),
        (("--limit", "winding=155", "--vary", "current_A", "--torque", "5"), "nothing says what current"),
        pytest.param(
            ("--limit", "winding=155", "--vary", "current_A", "--cluster", "tcp://127.0.0.1:1"),
            "no Dask scheduler",
            marks=pytest.mark.nightly,  # ten seconds, in which a scheduler may answer
        ),
    ],
)
def test_what_is_wrong_is_one_message(tmp_path, arguments, message):
    asked = ("use", "optimise", small_case(tmp_path), "--at", "ambient=20", "--out", tmp_path / "designs")
    assert message in refusal(tmp_path, *asked, *arguments)


def test_a_design_is_a_machine_file_that_builds(tmp_path):
    file = MachineFile.read(Path("series-dc-100kw-jacket-one"))
    wanted = {"geometry.jacket.channels": 17.0, "geometry.jacket.height_mm": 9.5, "cooling.flow_L_per_min": 11.25}
    path = tmp_path / "design-01.toml"
    path.write_text(machine_file_text(file, wanted, "design-01", ["a design"]))
    machine = load_machine(path)
    assert machine.name == "design-01"
    assert machine.geometry.jacket.channels == 17
    assert machine.geometry.jacket.height == pytest.approx(9.5e-3)
    assert machine.sections["cooling"]["flow_L_per_min"] == 11.25
    assert machine.parts == file.at(wanted).parts
    again = read_geometry(families()["series-dc"].parameters, file.sections["geometry"], "x")
    assert file.value("geometry.jacket.height_mm") == pytest.approx(1e3 * again.jacket.height)


@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("series-dc-100kw-jacket-one", {"cooling.flow_L_per_min", "geometry.jacket.channels", "geometry.housing.fins"}),
        ("series-dc-100kw-jacket-two", {"cooling.flow_L_per_min", "geometry.jacket.turns", "geometry.jacket.rib_mm"}),
        ("series-dc-100kw-air", {"fans.flow_m3_h", "geometry.housing.fin_height_mm"}),
        ("tefc-industrial", {"geometry.housing.fins", "geometry.housing.fin_thickness_mm"}),
        ("ipmsm-48s8p-jacket", {"cooling.flow_L_per_min", "geometry.housing.turns", "geometry.housing.channel_mm"}),
    ],
)
def test_machines_offer_what_they_have(name, keys):
    usual = {v.name: v for v in MachineFile.read(Path(name)).usual()}
    assert keys <= set(usual)
    assert all(v.low < v.usual < v.high for v in usual.values())
    assert all(v.conducts == n.startswith("geometry.") for n, v in usual.items())
    jacket = {"geometry.jacket.channels", "geometry.jacket.turns"} & set(usual)
    assert len(jacket) == (1 if "series-dc-100kw-jacket" in name else 0)


@pytest.mark.parametrize("name", ["series-dc-100kw-air", "series-dc-100kw-jacket-one", "series-dc-100kw-jacket-two"])
def test_what_is_condensed_anew_can_be_built(name):
    """The rib of the two-way jacket leaves no room for its ports at the bound: the geometry lies nearer then."""
    file = MachineFile.read(Path(name))
    space = Space(tuple(file.usual()))
    of = Condensations(SimpleNamespace(space=space, machine_at=file.at), print)
    points = {v: of._far(v) for v in space.variables if v.conducts}
    assert points
    for v, point in points.items():
        assert point is not None
        assert point[v.name] != v.usual
        assert {n: u for n, u in point.items() if n != v.name} == {w.name: w.usual for w in space.variables if w != v}
        assert file.at(point).parts


def test_a_robust_design_is_judged_by_the_upper_end_of_its_band(thermoscope, tmp_path):
    """The copper's own prior of 5 % and the bands of the table widen every temperature."""
    asked = ("use", "optimise", small_case(tmp_path), "--limit", "winding=400", "--vary", "current_A=40:90")
    asked += ("--at", "ambient=20", "--population", "8", "--generations", "1", "--json", "-", "--out")
    done = [thermoscope(*asked, tmp_path / f"designs{k}", *more) for k, more in enumerate([("--robust",), ()])]
    assert [d.code for d in done] == [0, 0], [d.err for d in done]
    robust, plain = (d.document["reference"] for d in done)
    assert 0.1 < (robust["peak_degC"] - plain["peak_degC"]) / (plain["peak_degC"] - 20.0) < 1.0
    assert robust["copper_W"] == pytest.approx(plain["copper_W"], rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--limit", "windng=155"), "'windng' is not a temperature of the machine"),
        (("--limit", "winding=155", "--at", "speed=1"), "'speed' is not an input or boundary"),
        (("--limit", "winding=155", "--vary", "geometry.jacket.heigt_mm=8:20"), "is nothing that a design could"),
        (("--limit", "winding=155", "--cycle", "none"), "no such cycle"),
    ],
)
def test_options_are_checked_before_anything_is_meshed(thermoscope, tmp_path, monkeypatch, arguments, words):
    monkeypatch.setattr("lumped.build.pipeline.build", lambda *_, **__: pytest.fail("meshed"))
    said = thermoscope("use", "optimise", "series-dc-100kw-jacket-one", *arguments, "--out", tmp_path / "designs")
    assert said.code == 2
    assert words in said.err


def test_what_a_limit_may_be_for_is_known_without_a_mesh():
    """Of a machine whose network is made: every mean of it is known from its file."""
    machine = load_machine("pmsm-m1")
    assert set(mean_rows(build(machine).network)) <= temperatures_of(machine, [])
