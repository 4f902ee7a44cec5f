"""Loss maps of other tools: watts, units and places as the file has them, whatever its form; what is wrong is said."""

import math
import tomllib

import numpy as np
import pytest
import scipy.io

from geom import InputError, load_machine
from lumped.declarations.loss_tables import loss_laws
from lumped.machine.motor import rated_inputs
from lumped.schemas.reader import Table
from measured.importing.loss_map import read_loss_map
from thermoscope.commands.model.import_file import import_

MACHINE = "ipmsm-48s8p-jacket"  # 2730 rpm, with losses of copper, iron, magnets, bearings and windage
SPEED, TORQUE = np.linspace(1000.0, 12000.0, 12), np.linspace(0.0, 280.0, 11)  # rpm, N m
DIGITS = 5e-5  # five digits are written
N, T = np.meshgrid(SPEED, TORQUE, indexing="ij")


def watts(n, torque):
    """By loss, as laws of textbooks: what the maps are made from."""
    copper, iron = 1000.0 * (torque / 280) ** 2, 420.0 * (n / 3000) ** 1.5
    return {
        "Stator_Copper_Loss_DC": copper,
        "Stator_Copper_Loss_AC": 0.5 * copper * (n / 1e4) ** 2,
        "Stator_Iron_Loss": 0.9 * iron,
        "Rotor_Iron_Loss": 0.1 * iron,
        "Magnet_Loss": 60.0 * (n / 3000) ** 2,
        "Friction_Loss": 30.0 * n / 3000,
        "Windage_Loss": 4.0 * (n / 3000) ** 3,
    }


PLACES = {
    "copper": ("Stator_Copper_Loss_DC", "winding.copper"),
    "copper-ac": ("Stator_Copper_Loss_AC", "winding"),
    "iron": ("Stator_Iron_Loss", "stator.core"),
    "rotor-iron": ("Rotor_Iron_Loss", "rotor.core"),
    "magnet": ("Magnet_Loss", "magnets"),
    "mechanical": ("Friction_Loss", {"bearing.left": 0.5, "bearing.right": 0.5}),
    "windage": ("Windage_Loss", "airgap"),
}


def text(path, columns, sign=","):
    rows = [sign.join(columns), *(sign.join(f"{x:.9g}" for x in row) for row in zip(*columns.values()))]
    path.write_text("\n".join(rows).replace(".", "." if sign == "," else ","))
    return path


def lab(folder, n=N, torque=T, **more):
    """As Motor-CAD Lab exports it: a matrix per quantity, sums beside their parts."""
    losses = watts(n, torque)
    sums = {
        "Stator_Copper_Loss": losses["Stator_Copper_Loss_DC"] + losses["Stator_Copper_Loss_AC"],
        "Iron_Loss": losses["Stator_Iron_Loss"] + losses["Rotor_Iron_Loss"],
        "Total_Loss": sum(losses.values()),
        "Efficiency": 95.0 + 0 * n,
        "Electromagnetic_Torque": 1.01 * torque,
    }
    scipy.io.savemat(folder / "lab.mat", {"Speed": n, "Shaft_Torque": torque, **losses, **sums, **more})
    return folder / "lab.mat"


def long(folder):
    columns = {"Drehzahl [1/min]": N.ravel(), "Drehmoment [Nm]": T.ravel()}
    return text(folder / "long.csv", columns | {k: v.ravel() for k, v in watts(N, T).items()}, sign=";")


def in_radians(folder):
    """And kW, without a word about either."""
    columns = {"speed": N.ravel() * math.pi / 30, "torque": T.ravel()}
    return text(folder / "si.csv", columns | {k: v.ravel() / 1e3 for k, v in watts(N, T).items()})


def axes_as_vectors(folder):
    scipy.io.savemat(folder / "vectors.mat", {"map": {"Speed": SPEED, "Torque": TORQUE, **watts(N, T)}})
    return folder / "vectors.mat"


def both_directions(folder):
    """Motor and generator: the motor's half counts."""
    n, torque = np.meshgrid(SPEED, np.linspace(-280.0, 280.0, 21), indexing="ij")
    losses = watts(n, torque)
    losses["Magnet_Loss"] = np.where(torque < 0, 9.9 * losses["Magnet_Loss"], losses["Magnet_Loss"])
    scipy.io.savemat(folder / "both.mat", {"Speed": n, "Shaft_Torque": torque, **losses})
    return folder / "both.mat"


def imported(file, folder, **options):
    """The losses of the file that was written, as tables."""
    assert import_(file, folder / "out", machine=MACHINE, **options) == 0
    (written,) = (folder / "out").iterdir()
    load_machine(written)
    return tomllib.loads(written.read_text(encoding="utf-8"))["losses"]


def size(table, **inputs):
    """W of one loss at constant inputs, at the temperature of the map."""
    law = loss_laws({"it": Table(dict(table), "it")})["it"]
    return float(np.mean(law.size({name: np.array([value]) for name, value in inputs.items()})))


@pytest.mark.parametrize("form", [lab, long, in_radians, axes_as_vectors, both_directions])
def test_every_form_gives_the_watts_and_places(form, tmp_path):
    losses = imported(form(tmp_path), tmp_path)
    assert losses.keys() == PLACES.keys()
    for name, (column, at) in PLACES.items():
        assert losses[name]["at"] == at
        for n, torque in ((3000.0, 140.0), (-11000.0, 28.0)):
            expected = watts(abs(n), torque)[column]
            assert size(losses[name], speed_rpm=n, torque_Nm=torque) == pytest.approx(expected, rel=DIGITS), name


def test_a_map_within_an_envelope_ends_at_its_edge(tmp_path):
    """80 kW: torques of its own at each speed. Between them straight lines, beyond them the nearest."""
    most = np.minimum(280.0, 80e3 / (SPEED * math.pi / 30))[:, None]
    torque = most * np.linspace(0.0, 1.0, 41)
    losses = imported(lab(tmp_path, SPEED[:, None] + 0 * torque, torque), tmp_path)
    inside = size(losses["copper"], speed_rpm=6000.0, torque_Nm=70.0)
    assert inside == pytest.approx(watts(6000.0, 70.0)["Stator_Copper_Loss_DC"], rel=0.02)
    edge = watts(12000.0, most[-1, 0])["Stator_Copper_Loss_DC"]
    assert size(losses["copper"], speed_rpm=12000.0, torque_Nm=280.0) == pytest.approx(edge, rel=1e-4)


def test_points_without_numbers_are_left_out(tmp_path):
    """As a tool writes what the machine does not reach."""
    losses = imported(lab(tmp_path, Magnet_Loss=np.where(N * T > 1e6, np.nan, watts(N, T)["Magnet_Loss"])), tmp_path)
    assert size(losses["magnet"], speed_rpm=6000.0, torque_Nm=140.0) == pytest.approx(240.0, rel=DIGITS)
    last = watts(12000.0, 56.0)["Stator_Copper_Loss_DC"]  # of 28, 56, 84 N m: 84 at 12000 rpm are beyond
    assert size(losses["copper"], speed_rpm=12000.0, torque_Nm=280.0) == pytest.approx(last, rel=DIGITS)


def test_a_grid_is_one_loss_by_the_name_of_its_file(tmp_path):
    for corner, axes in (
        ("speed \\ torque [Nm]", (SPEED, TORQUE)),
        ("torque | speed", (TORQUE, SPEED)),
        ("", (SPEED, TORQUE)),
    ):
        first, second = np.meshgrid(*axes, indexing="ij")
        P = 420.0 * ((first if axes[0] is SPEED else second) / 3000) ** 1.5
        lines = [",".join([corner, *map(str, axes[1])])]
        lines += [",".join(map(str, [a, *row])) for a, row in zip(axes[0], P)]
        (tmp_path / "iron_loss.csv").write_text("\n".join(lines))
        given = read_loss_map(tmp_path / "iron_loss.csv", {}, 3000.0)
        assert [*given.axes] == ["speed_rpm", "torque_Nm"]
        assert given.losses["iron"][1] == pytest.approx(420.0 * (N / 3000) ** 1.5)


def over_currents(folder, **more):
    d, q = np.meshgrid(np.linspace(-300.0, 0.0, 7), np.linspace(0.0, 300.0, 7), indexing="ij")
    losses = {"Copper_Loss": 0.0168 * (d**2 + q**2) / 2, "Iron_Loss": 1.0 + 1e-3 * abs(300 + d) + 2e-3 * q}
    scipy.io.savemat(folder / "currents.mat", {"Id_Peak": d, "Iq_Peak": q, **losses, **more})
    return folder / "currents.mat"


def test_a_map_over_currents_follows_the_speed(tmp_path):
    losses = imported(over_currents(tmp_path, Speed=3000.0), tmp_path)
    point = {"id_A": -100.0, "iq_A": 200.0}
    assert size(losses["copper"], **point) == pytest.approx(0.0168 * 5e4 / 2)
    slow, fast = (size(losses["iron"], **point, speed_rpm=n) for n in (3000.0, 6000.0))
    assert slow == pytest.approx(1.6)
    assert fast == pytest.approx(2**1.5 * slow)


@pytest.mark.parametrize(
    ("more", "options", "expected"),
    [
        ({}, {}, 20.0),
        ({"Winding_Temperature": 90.0}, {}, 90.0),
        ({"Winding_Temperature": 90.0}, {"copper_degC": 120.0}, 120.0),
    ],
)
def test_copper_follows_its_temperature_from_the_map_s(more, options, expected, tmp_path, capsys):
    losses = imported(lab(tmp_path, **more), tmp_path, **options)
    assert losses["copper"]["reference_degC"] == expected
    assert losses["copper"]["alpha_1_K"] == 0.00393
    assert "alpha_1_K" not in losses["copper-ac"]
    assert ("--copper-degc" in capsys.readouterr().out) is (not more and not options)


def test_the_rated_point_has_what_the_map_reads(tmp_path):
    """A torque stands in the machine's file, rated or assumed; where no loss reads it, it is not an input."""
    assert "torque_Nm" not in rated_inputs(load_machine(MACHINE))
    imported(lab(tmp_path), tmp_path)
    assert rated_inputs(load_machine(tmp_path / f"out/{MACHINE}-lab.toml"))["torque_Nm"] == 280.0
    over = imported(over_currents(tmp_path, Speed=3000.0), tmp_path / "currents")
    assert over["iron"]["speed"] == "id_A"
    rated = rated_inputs(load_machine(tmp_path / f"currents/out/{MACHINE}-currents.toml"))
    assert (rated["id_A"], rated["iq_A"]) == (150.0, 150.0)


def one_row(folder):
    return text(folder / "bad.csv", {"speed": N[0] + 0 * T[0], "torque": T[0], "Iron_Loss": T[0]})


def scattered(folder):
    points = {"speed": np.arange(9.0) ** 2, "torque": np.arange(9.0), "Iron_Loss": np.arange(9.0)}
    return text(folder / "bad.csv", points)


def negative(folder):
    return text(folder / "bad.csv", {"speed": N.ravel(), "torque": T.ravel(), "Iron_Loss": 5 - T.ravel()})


def square(folder):
    scipy.io.savemat(folder / "bad.mat", {"Speed": SPEED, "Torque": np.arange(12.0), "Iron_Loss": np.ones((12, 12))})
    return folder / "bad.mat"


def damaged(folder):
    path = lab(folder)
    path.write_bytes(path.read_bytes()[:900])
    return path


WRONG = {
    "one speed": (one_row, {}, "over speed and torque, or over id and iq"),
    "points in no rows": (scattered, {}, "9 points have 9 values of the first axis"),
    "a negative loss": (negative, {"units": "power=W"}, "a loss is -275 W"),
    "a foreign unit": (long, {"units": "speed=furlong"}, "'speed=furlong' is not a unit of a loss map"),
    "axes that may stand either way": (square, {}, "Speed may stand down or along 12 x 12 points"),
    "a damaged file": (damaged, {}, "not readable as a MATLAB file"),
    "iron over currents without a speed": (over_currents, {}, "over id and iq says no speed"),
    "a machine of plain numbers": (long, {"machine": "series-dc-100kw"}, "its losses are plain numbers"),
}


@pytest.mark.parametrize("fault", WRONG)
def test_faults_write_nothing(fault, tmp_path):
    form, options, message = WRONG[fault]
    with pytest.raises(InputError, match=message):
        import_(form(tmp_path), tmp_path / "out", **{"machine": MACHINE, **options})
    assert not (tmp_path / "out").exists()


def test_a_file_that_is_like_another_gives_its_losses_up(tmp_path):
    (tmp_path / "my.toml").write_text(f'[machine]\nname = "my"\nlike = "{MACHINE}"\n[ratings]\nspeed_rpm = 3000\n')
    assert import_(lab(tmp_path), tmp_path / "out", machine=str(tmp_path / "my.toml")) == 0
    machine = load_machine(tmp_path / "out/my-lab.toml")
    assert {table["kind"] for table in machine.sections["losses"].values()} == {"map"}
