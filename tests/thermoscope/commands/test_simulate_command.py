"""thermoscope use simulate: tests, duties and drives in, temperatures out."""

import json
from dataclasses import replace

import numpy as np
import pytest

from geom.errors import InputError
from lumped.condensation.recovery import PartShape, Shapes
from lumped.drives.drive import Vehicle
from lumped.model.build import bare_network, node_source
from lumped.transfer.laws import Fixed
from thermoscope.case_folder.cycle import load_cycle
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.runs import hot_spots
from thermoscope.commands.use.simulate import simulate

DUTY = """
[cycle]
initial_degC = 25
[duty]
type = "S3"
period_s = 600
duty_percent = 40
cycles = 20
[load]
current_A = 100
[inputs]
vehicle_speed_mps = 0
[boundaries]
ambient = 25
"""

DRIVE = """
[cycle]
time = "time_s"
[columns.speed]
quantity = "vehicle_speed"
unit = "km/h"
[columns.slope]
quantity = "share"
unit = "%"
input = "slope_percent"
[columns.air]
quantity = "temperature"
unit = "degC"
place = "ambient"
[vehicle]
mass_kg = 9000
wheel_radius_m = 0.48
gear = 4.52
[series-machine]
power_W = 100e3
speed_rpm = 1000
voltage_V = 220
current_A = 511
"""
ROAD = [f"{t},{min(t, 60) / 60 * 40},0.2,{20 + t / 600}" for t in range(0, 601, 30)]
TABLE = "\n".join(["time_s,speed,slope,air", *ROAD])

PM = """
[duty]
type = "S1"
duration_s = 3000
[cycle]
[load]
torque_Nm = 80
speed_rpm = 2000
[boundaries]
ambient = 25
[pm-machine]
pole_pairs = 4
R20_ohm = 4.67e-3
Ld_H = 1e-4
Lq_H = 2.5e-4
psi_Vs = 0.07
current_limit_A = 400
voltage_limit_V = 200
magnet = "flange"
"""

INDUCTION = (
    PM[: PM.index("[pm-machine]")].replace("2000", "1450")
    + """[induction-machine]
pole_pairs = 2
Rs20_ohm = 0.02
Rr20_ohm = 0.02
Ls_leakage_H = 2e-4
Lr_leakage_H = 2e-4
Lm_H = 7e-3
magnetising_A = 60
current_limit_A = 400
voltage_limit_V = 325
cage = "flange"
cage_loss = "copper"
stator_loss = "copper"
"""
)


def ran(case, cycle, tmp_path):
    file = tmp_path / "document.json"
    assert simulate(str(case), cycle and str(cycle), tmp_path / "out", str(file)) == 0
    return json.loads(file.read_text())


def cycle_file(folder, text, table=""):
    (folder / "cycles").mkdir(exist_ok=True)
    (folder / "cycles" / "mine.toml").write_text(text)
    if table:
        (folder / "cycles" / "mine.csv").write_text(table)
    return "mine"


def closes(run):
    assert run["energy_balance"] < 1e-5
    assert run["loss_mismatch"] < 1e-3
    assert run["losses"]
    for loss in run["losses"]:
        assert loss["injected_J"] == pytest.approx(loss["declared_J"], rel=5e-3)


def test_all_tests_of_a_case_give_a_csv_each(case, tmp_path):
    document = ran(case, None, tmp_path)
    assert [run["name"] for run in document["runs"]] == ["stand", "road", "town"]
    for run in document["runs"]:
        closes(run)
        with open(run["file"]) as file:
            head = file.readline().strip().split(",")
        assert head[0] == "time_s"
        assert head.count("time_s") == 1
        assert not any(name.startswith("running ") for name in head)  # marks of a test that only laws read
        assert {"current_A", "ambient", "T winding (degC)", "T sensor T_winding (degC)"} <= set(head)
        body = np.loadtxt(run["file"], delimiter=",", skiprows=1)
        assert body.shape[1] == len(head)
        end = next(p["end_C"] for p in run["places"] if p["place"] == "winding")
        assert body[-1, head.index("T winding (degC)")] == pytest.approx(end, rel=1e-5)


def test_a_duty_ends_near_its_mean_load(case, tmp_path):
    """S3 40 %: the mean copper loss is that of 40 % of the time, at least the cold one and not twice as much."""
    run = ran(case, cycle_file(case, DUTY), tmp_path)["runs"][0]
    closes(run)
    cold = 0.4 * 0.02 * 100**2
    assert cold < run["losses"][0]["mean_W"] < 2 * cold
    assert run["coupling"]["rounds"] == 0


def test_a_vehicle_on_a_slope_heats_its_machine(case, tmp_path):
    """40 km/h up 0.2 %: the current that carries the load, and temperatures that agree with it."""
    run = ran(case, cycle_file(case, DRIVE, TABLE), tmp_path)["runs"][0]
    closes(run)
    assert run["coupling"]["residuals_K"][-1] < 1e-3
    with open(run["file"]) as file:
        head = file.readline().strip().split(",")
    last = dict(zip(head, np.loadtxt(run["file"], delimiter=",", skiprows=1)[-1], strict=True))
    vehicle = Vehicle(9000.0, 0.48, 4.52)
    load = vehicle.wheel_torque(40 / 3.6, 0.002) / vehicle.efficiency
    assert last["torque_Nm"] == pytest.approx(load, rel=0.01)
    assert last["speed_rpm"] == pytest.approx(1000.0, rel=0.02)
    assert last["ambient"] == pytest.approx(21.0)


def test_a_permanent_magnet_machine_runs_from_torque_and_speed(case, tmp_path):
    run = ran(case, cycle_file(case, PM), tmp_path)["runs"][0]
    closes(run)
    assert run["coupling"]["residuals_K"][-1] < 1e-3 < run["coupling"]["residuals_K"][0]


def test_a_cage_machine_runs_from_torque_and_speed(case, tmp_path):
    """Beside the copper that the stator's loss becomes, a cage whose loss the network names."""
    network = case / "network.toml"
    network.write_text(network.read_text() + '\n[losses.bars]\nkind = "constant"\nat = "flange"\nP_W = 1\n')
    run = ran(case, cycle_file(case, INDUCTION.replace('cage_loss = "copper"', 'cage_loss = "bars"')), tmp_path)[
        "runs"
    ][0]
    assert run["loss_mismatch"] < 1e-3
    assert run["energy_balance"] < 1e-4
    assert run["coupling"]["residuals_K"][-1] < 1e-3 < run["coupling"]["residuals_K"][0]
    with open(run["file"]) as file:
        head = file.readline().strip().split(",")
    last = dict(zip(head, np.loadtxt(run["file"], delimiter=",", skiprows=1)[-1], strict=True))
    copper = 3 * 0.02 * (1 + 0.00393 * (last["T winding (degC)"] - 20)) * last["current_A"] ** 2
    cage = 3 * 0.02 * (1 + (last["T flange (degC)"] - 20) / 245) * last["cage_current_A"] ** 2
    shaft = last["torque_Nm"] * last["speed_rpm"] * np.pi / 30
    assert last["electrical_W"] == pytest.approx(shaft + copper + cage, rel=1e-4)


def test_what_the_limits_leave_undone_is_said(case, tmp_path, capsys):
    """60 A cannot give 80 N m with 0.07 Vs and 4 pole pairs: 1.5 p psi I is 25 N m without reluctance."""
    weak = PM.replace("current_limit_A = 400", "current_limit_A = 60")
    run = ran(case, cycle_file(case, weak), tmp_path)["runs"][0]
    assert run["short_of"] == {"torque_Nm": 1.0}
    assert "torque_Nm: for 100 % of the time short" in capsys.readouterr().out
    assert ran(case, cycle_file(case, PM), tmp_path)["runs"][0]["short_of"] == {}


def test_a_model_alone_runs_a_cycle(case, tmp_path):
    text = (case / "case.toml").read_text()
    (case / "case.toml").write_text(text[: text.index("[tests")])
    assert "sensor" not in str(ran(case, cycle_file(case, DUTY), tmp_path))
    with pytest.raises(InputError, match=r"nothing to run.*--cycle"):
        simulate(str(case), None, tmp_path, None)


def test_sensors_lag(case, tmp_path):
    """A slow sensor reads less of the same peak, and later."""
    before = ran(case, cycle_file(case, DUTY), tmp_path)["runs"][0]
    sensor = next(p["place"] for p in before["places"] if p["place"].startswith("sensor "))
    name = sensor.removeprefix("sensor ")
    for file in (case / "tests").glob("*.toml"):
        text = file.read_text()
        file.write_text(text.replace(f"[columns.{name}]", f"[columns.{name}]\nlag_s = 60"))
    after = ran(case, "mine", tmp_path)["runs"][0]
    lead, late = (next(p for p in r["places"] if p["place"] == sensor) for r in (before, after))
    assert late["max_C"] < lead["max_C"]
    assert late["max_at_s"] > lead["max_at_s"]


SLIPS = {
    "unknown key": (DUTY.replace("period_s", "periodd_s"), "'period_s' is missing|periodd_s"),
    "two drives": (PM + INDUCTION[INDUCTION.index("[induction") :], "two drives"),
    "loss": (
        INDUCTION.replace('cage_loss = "copper"', 'cage_loss = "coper"'),
        "no loss 'coper'.*did you mean 'copper'",
    ),
    "flux": (INDUCTION.replace("magnetising_A = 60", "magnetising_A = 600"), "above current_limit_A = 400"),
    "regeneration": (DRIVE.replace("gear = 4.52", "gear = 4.52\nregeneration = 60"), "regeneration = 60"),
    "place": (PM.replace('magnet = "flange"', 'magnet = "flang"'), "'flang'.*did you mean 'flange'"),
}


@pytest.mark.parametrize(("text", "message"), SLIPS.values(), ids=SLIPS)
def test_slips_are_named(case, text, message):
    cycle_file(case, text, TABLE)
    network = load_case(case).case.model.network
    with pytest.raises(InputError, match=message):
        load_cycle(case / "cycles" / "mine.toml", network, {})


def test_an_unknown_cycle_lists_those_there_are(case, tmp_path):
    cycle_file(case, DUTY)
    with pytest.raises(InputError, match="did you mean 'mine'"):
        simulate(str(case), "mne", tmp_path, None)


def test_the_shipped_duty_runs(root, tmp_path):
    run = ran(root / "cases" / "hust-ipmsm", "s3-40", tmp_path)["runs"][0]
    closes(run)
    assert run["duration_s"] == 7200.0


def test_the_hottest_point_is_that_of_the_hottest_instant():
    """A coil of three points whose one shape turns round: its third point is hottest when its mean is largest."""
    net = bare_network("coil", {"coil": 100.0, "coil#1": 1.0, "yoke": 50.0}, ("air",))
    net = net.extended(sources=[node_source(net, "heat", "copper", {"coil": 1.0}, Fixed(1.0))])
    V = np.column_stack([np.ones(3), [-1.0, 0.0, 1.0]])
    shape = PartShape(np.arange(3), None, V, np.array([0.25, 0.5, 0.25]), np.array([0, 1]))
    yoke = PartShape(np.arange(1), None, np.ones((1, 1)), np.ones(1), np.array([2]))
    z = np.array([[20.0, 0.0, 20.0, 20.0], [60.0, -9.0, 30.0, 20.0], [80.0, 5.0, 40.0, 20.0]])
    found = hot_spots(replace(net, recovery=Shapes({"coil": shape, "yoke": yoke})), z)
    assert list(found) == ["hottest point of coil"]
    row = found["hottest point of coil"]
    assert (z[:, row.index] @ row.weights).tolist() == [20.0, 51.0, 85.0]
    assert hot_spots(net, z) == {}


def test_a_part_that_is_heated_by_a_share_of_another_ones_loss_has_a_hottest_point_too():
    net = bare_network("coil", {"coil": 100.0, "yoke": 50.0, "shaft": 9.0}, ("air",))
    net = net.extended(sources=[node_source(net, "heat", "copper", {"coil": 0.6, "yoke": 0.4}, Fixed(1.0))])
    one = {
        name: PartShape(np.array([k]), None, np.ones((1, 1)), np.ones(1), np.array([k]))
        for k, name in enumerate(("coil", "yoke", "shaft"))
    }
    found = hot_spots(replace(net, recovery=Shapes(one)), np.full((2, 4), 20.0))
    assert list(found) == ["hottest point of coil", "hottest point of yoke"]
