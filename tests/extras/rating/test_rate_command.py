"""thermoscope use rate: ratings of a small case, with bands; what is wrong is one message."""

import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from small_case import small_case

from extras.rating.commands.rate import rating_summary
from extras.rating.request import places, rated_point
from geom.description.roles import Identity, Role
from lumped.model.build import bare_network
from lumped.model.network import Row
from thermoscope.case_folder.folder import load_machine_file

CYCLE = """
[cycle]
initial_degC = 20
[duty]
type = "S3"
period_s = 120
duty_percent = 50
cycles = 1
[load]
current_A = 200
[boundaries]
ambient = 20
"""
HOIST = (
    CYCLE.replace("current_A = 200", "torque_Nm = 200\nspeed_rpm = 1450")
    + """[induction-machine]
pole_pairs = 2
Rs20_ohm = 0.02
Rr20_ohm = 0.02
Ls_leakage_H = 2e-4
Lr_leakage_H = 2e-4
Lm_H = 7e-3
magnetising_A = 60
current_limit_A = 200
voltage_limit_V = 50
cage = "winding"
"""
)
HOLES = "torque_Nm,speed_rpm,copper_W\n0,0,0\n50,0,20\n0,1000,0\n"


def test_s2_begins_where_it_is_told(thermoscope, tmp_path):
    """The nearer to the limit it begins, the less is left; beyond it nothing is, and a word is no load."""
    common = ("use", "rate", small_case(tmp_path), "--limit", "winding=120", "--at", "ambient=20")
    cold, warm = (thermoscope(*common, "--start", s, "--json", "-").document for s in ("cold", "50"))
    assert re.search(
        r"Largest in the tests [\d.]+ A: (the limit is )?[\d.]+ % (in hand|below it)\.", rating_summary(cold).sentence
    )
    of = [{r["form"]: r for r in d["ratings"]} for d in (cold, warm)]
    assert of[0]["S1"]["value"] == pytest.approx(of[1]["S1"]["value"])
    for form in ("S2 60 min", "S2 60 s", "S2 10 s"):
        assert of[1]["S1"]["value"] < of[1][form]["value"] < of[0][form]["value"]
        low, high = of[1][form]["ci95"]
        assert low < of[1][form]["value"] < high
    hot = thermoscope(*common, "--start", "400")
    assert hot.code == 2
    assert "at rest under current_A = 400 'winding' is" in hot.err
    word = thermoscope(*common, "--start", "warm")
    assert word.code == 2
    assert "'warm' is not a start" in word.err


def test_the_continuous_rating_is_the_rest_of_the_network(thermoscope, tmp_path):
    """G from winding to air: 8 in series with (3 + (6 in series with 1.5)); R grows with the winding's temperature."""
    said = thermoscope(
        "use", "rate", small_case(tmp_path), "--limit", "winding=120", "--at", "ambient=20", "--json", "-"
    )
    assert said.code == 0, said.err
    document = said.document
    air = 3.0 + 1.0 / (1.0 / 6.0 + 1.0 / 1.5)
    heat = 100.0 / (1.0 / 8.0 + 1.0 / air)
    amps = (heat / (0.02 * (1.0 + 0.00393 * 100.0))) ** 0.5
    rows = {r["form"]: r for r in document["ratings"]}
    assert rows["S1"]["value"] == pytest.approx(amps, rel=3e-3)
    low, high = rows["S1"]["ci95"]
    assert low < amps < high
    values = [rows[f]["value"] for f in ("S1", "S6 40 %", "S2 60 s", "S2 10 s")]
    assert values == sorted(values)
    assert 0.0 < document["overload"]["from_warm_s"] < document["overload"]["from_cold_s"]
    derated = {(d["of"], d["value"]): d for d in document["derating"]}
    assert derated["ambient", 60.0]["share"] == pytest.approx(0.6**0.5, rel=5e-3)
    here = derated["ambient", 20.0]["share_ci95"]
    assert here == pytest.approx([low / rows["S1"]["value"], high / rows["S1"]["value"]], rel=1e-2)
    for d in derated.values():
        assert d["share_ci95"][0] < d["share"] < d["share_ci95"][1]
        assert d["share_before"] is None


def test_ratings_stand_beside_those_of_the_model_before(thermoscope, tmp_path):
    """Convection that was added carries more away: before it the same surroundings allowed less."""
    case = small_case(tmp_path)
    assert thermoscope("add", case, "convection@flange").code == 0
    asked = ("--limit", "winding=120", "--at", "ambient=20")
    said = thermoscope("use", "rate", case, *asked, "--json", "-")
    assert said.code == 0, said.err
    first = said.document["ratings"][0]
    more = 100.0 * (first["value"] / first["before"] - 1.0)
    assert more > 1.0
    assert f"{more:.3g} % more than the model before its last step said." in rating_summary(said.document).sentence
    derated = {(d["of"], d["value"]): d for d in said.document["derating"]}
    assert derated["ambient", 20.0]["share_before"] == pytest.approx(first["before"] / first["value"], rel=5e-3)
    warm = derated["ambient", 60.0]
    assert 0.0 < warm["share_before"] < warm["share"] < derated["ambient", 20.0]["share"]


def test_what_is_wrong_is_one_message(thermoscope, tmp_path):
    case, holes = small_case(tmp_path), tmp_path / "map.csv"
    holes.write_text(HOLES)
    for arguments, message in {
        ("--limit", "winding=10"): "the limit of 'winding', 10 degC, is exceeded without any load",
        ("--limit", "coil=120"): "no temperature 'coil' to limit",
        (): "no limit is given",
        ("--limit", "winding=120", "--losses", str(holes)): "1 of 4 points are missing, the first at 50 Nm, 1000 1/min",
    }.items():
        said = thermoscope("use", "rate", case, *arguments)
        assert said.code == 2
        assert message in said.err.splitlines()[-1]


SPUN = """
[network]
name = "spun"
boundaries = ["ambient"]
[nodes.body]
C_J_K = 6000
[links.body-air]
between = ["body", "ambient"]
G_W_K = 2
[losses.copper]
kind = "copper"
at = "body"
R20_ohm = 0.01
alpha_1_K = 0
currents = ["current_A"]
[losses.windage]
kind = "windage"
at = "body"
P_W = 50
of = { input = "speed_rpm", at = 1000, exponent = 2 }
"""


def test_a_speed_that_overheats_the_machine_by_itself_is_left_out_with_a_note(thermoscope, tmp_path):
    """50 W at 1,000 rpm and 2 W/K reach 100 K at 2,000 rpm; below, copper has what windage leaves."""
    (tmp_path / "network.toml").write_text(SPUN)
    (tmp_path / "case.toml").write_text('[case]\nname = "spun"\nnetwork = "network.toml"\n')
    at = ("--at", "current_A=100", "--at", "speed_rpm=1000", "--at", "ambient=20", "--no-bands", "--json", "-")
    said = thermoscope("use", "rate", tmp_path, "--limit", "body=120", "--top", "2500", *at)
    assert said.code == 0, said.err
    rest = {r["speed_rpm"]: r["value"] for r in said.document["envelope"] if r["form"] == "S1"}
    speeds = [0.0, 500.0, 1000.0, 1500.0]
    assert list(rest) == speeds
    assert list(rest.values()) == pytest.approx([np.sqrt((200.0 - 5e-5 * n**2) / 0.01) for n in speeds], rel=2e-3)
    assert "at 2000, 2500 1/min a limit is exceeded without any load; --top RPM" in said.err
    spun = thermoscope("use", "rate", tmp_path, "--limit", "body=120", "--load", "speed_rpm", *at)
    assert (spun.code, spun.document["envelope"]) == (0, [])


def test_a_role_stands_for_its_places_but_a_place_that_is_called_so_for_itself():
    rows = dict.fromkeys(("winding.field", "armature", "yoke"), Row(np.array([0]), np.ones(1)))
    what = {"winding.field": Identity(Role.WINDING), "armature": Identity(Role.WINDING), "yoke": Identity(Role.IRON)}
    limits = places({"winding": 155.0, "yoke": 120.0}, rows, what)
    assert limits == {"winding.field": 155.0, "armature": 155.0, "yoke": 120.0}
    rows = dict.fromkeys(("winding", "end", "head", "yoke"), rows["yoke"])
    what = dict.fromkeys(("winding", "end", "head"), Identity(Role.WINDING))
    for asked in ({"winding": 155.0, "end": 140.0}, {"end": 140.0, "winding": 155.0}):
        assert places(asked, rows, what) == {"winding": 155.0, "end": 140.0, "head": 155.0}


def test_a_cycle_and_a_map(thermoscope, tmp_path):
    """Half of the time under load: the share of the cycle's load is larger than that of its peak for ever."""
    case = small_case(tmp_path)
    (case / "cycles").mkdir()
    (case / "cycles" / "town.toml").write_text(CYCLE)
    asked = ("--limit", "winding=120", "--at", "ambient=20", "--cycle", "town")
    said = thermoscope("use", "rate", case, *asked, "--json", "-")
    assert said.code == 0, said.err
    continuous = said.document["ratings"][0]["value"]
    cycle = said.document["cycle"]
    assert cycle["share"] * 200.0 == pytest.approx(continuous * 2.0**0.5, rel=0.08)
    assert 0.0 < cycle["until_s"] < 3600.0
    assert thermoscope("use", "rate", case, *asked, "--map").err.splitlines()[-1].endswith("and a limit in reach")


def test_a_cycle_of_a_cage_machine_multiplies_both_currents(thermoscope, tmp_path):
    """An S3 of torque; the cage's current is not an input of the model itself, and its loss goes with its square."""
    case = small_case(tmp_path)
    network = case / "network.toml"
    network.write_text(network.read_text() + '\n[losses.cage]\nkind = "constant"\nat = "winding"\nP_W = 1\n')
    (case / "cycles").mkdir()
    (case / "cycles" / "hoist.toml").write_text(HOIST)
    words = ["--limit", "winding=120", "--at", "ambient=20", "--cycle", "hoist", "--json", "-", "--no-bands"]
    said = thermoscope("use", "rate", case, *words)
    assert said.code == 0, said.err
    cycle = said.document["cycle"]
    assert 0.1 < cycle["share"] < 10.0
    assert cycle["short_of_s"] == {"torque_Nm": pytest.approx(60.0, abs=11.0)}
    assert "misses what was wanted by more than 1 %" in said.err


def test_a_machine_without_tests_stands_at_its_ratings():
    """Its coolant enters as [cooling] says; the air around is what IEC 60034-1 rates in."""
    machine = load_machine_file(Path("series-dc-100kw-jacket-one"))
    net = bare_network("n", {"body": 1.0}, ("ambient", "coolant"))
    net = replace(net, declared={"coolant": Identity(role=Role.COOLANT)})
    point = rated_point(SimpleNamespace(built=SimpleNamespace(machine=machine)), net)
    expected = {"current_A": 511.0, "speed_rpm": 1000.0, "flow_l_min": 8.0, "ambient": 40.0, "coolant": 20.0}
    assert point == expected
