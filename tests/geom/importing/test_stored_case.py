"""`model import FILE.mot --case`: the temperatures that a file stores, as a steady test that compare reads."""

import json

import pytest
from foreign_machines import motor_cad, pyleecan, saved

import thermoscope as ts
from geom import import_draft
from geom.errors import InputError
from geom.machine_file import machine_from
from lumped.build.pipeline import build
from lumped.integration.steady import steady
from lumped.machine.motor import rated_inputs
from thermoscope.commands.model.import_file import import_

PLACES = {"Housing [Active]": "housing", "Stator Tooth (C2)": "stator.core.gap", "Winding (Avg)": "winding.copper"}
AROUND = "T_Ambient=22\n"


def stored(temperatures):
    rows = [
        f"Temperature_Validation_Legend[{k}]={name}\nTemperature_Validation_Temperature[{k}]={value}\n"
        for k, (name, value) in enumerate(temperatures.items(), 5)  # the small machine stores one below that
    ]
    return AROUND + "".join(rows)


def own(folder, ambient, places=PLACES, values=None):
    """What the network of the small machine has at rest (degC)."""
    draft = import_draft(saved(folder, motor_cad(), "plain.mot"))
    machine = machine_from(draft.sections(), draft.name)
    network = build(machine).network
    rows = [network.places[place].mean for place in places.values()]
    around = {"ambient": ambient, "coolant": 30.0}
    return dict(zip(places, steady(network, rated_inputs(machine), around, values, rows).y))


def of_machine(folder, more):
    return saved(folder, motor_cad(more, **{"Temperature_Validation_Legend[3]": "Spare"}), "small.mot")


def test_a_case_of_stored_temperatures_is_compared_with_its_own_network(tmp_path, capsys):
    """Stored is what the network has at rest: nothing is over. The stored ambient goes before the file's other one."""
    truth = own(tmp_path, 25.0)
    file = of_machine(tmp_path, stored({"Ambient": 25.0, **truth, "Rotor Cage [X]": 50.0, "Magnet": 61.0}))
    assert import_(file, case=tmp_path / "case", target=str(tmp_path / "doc.json")) == 0
    shown, test = " ".join(capsys.readouterr().out.split()), json.loads((tmp_path / "doc.json").read_text())["test"]
    assert "compares 4 of 7 stored temperatures" in shown
    assert "speed_rpm 1500" in shown
    assert "armature-copper-loss 100 W" in shown
    assert "thermoscope test compare" in shown
    assert not test["foreign_losses"]
    assert test["boundaries"] == {"ambient": 25.0, "coolant": 30.0}
    doubts = {row["sensor"]: row["doubt"] for row in test["readings"]}
    assert doubts["Rotor Cage [X]"] == doubts["Spare"] == "its name is not understood"
    (stored_test,) = ts.open(tmp_path / "case").compare().tests
    assert {c.channel: c.verdict for c in stored_test.channels if c.channel in PLACES} == dict.fromkeys(
        PLACES, "within"
    )
    assert max(c.rmse_K for c in stored_test.channels if c.channel in PLACES) < 0.05


@pytest.mark.nightly
def test_losses_that_cannot_have_made_the_temperatures_give_way_and_the_contact_that_differs_is_named(tmp_path, capsys):
    """Stored under 300 W, where the file has 100, and with a contact a fifth as good: the tool says which."""
    places = PLACES | {
        "Stator Back Iron": "stator.core",
        "Wdg (Average)": "winding",
        "Rotor Lam [F]": "rotor.core",
        "Magnet": "magnets",
        "Endcap [F]": "endcap.left",
    }
    contact = "contact.housing|stator.core"
    truth = own(tmp_path, 25.0, places, {contact: 0.2, "loss.armature-copper-loss": 3.0})
    file = of_machine(tmp_path, stored({"Ambient": 25.0, **truth}))
    assert import_(file, case=tmp_path / "case", target=str(tmp_path / "doc.json")) == 0
    shown, test = " ".join(capsys.readouterr().out.split()), json.loads((tmp_path / "doc.json").read_text())["test"]
    assert test["foreign_losses"]
    found = test["nearest"]
    assert found["one_free"][0]["name"] == contact
    assert found["one_free"][0]["factor"] == pytest.approx(0.2, rel=0.1)
    assert found["one_free"][0]["rms"] < 0.2 * found["one_free"][1]["rms"]
    assert "did not make these temperatures" in shown
    assert "tells no loss from the films" in shown
    assert "P_W = 100" not in (tmp_path / "case" / "machine.toml").read_text()
    assert ts.open(tmp_path / "case").compare().tests


def test_what_cannot_be_compared_is_said_and_nothing_is_written(tmp_path):
    case = tmp_path / "case"
    with pytest.raises(InputError, match="stores no temperatures"):
        import_(saved(tmp_path, pyleecan()), case=case)
    with pytest.raises(InputError, match="none of its stored temperatures"):
        import_(of_machine(tmp_path, AROUND), case=case)
    with pytest.raises(InputError, match="no temperature of 'ambient'"):
        import_(saved(tmp_path, motor_cad(), "small.mot"), case=case)
    with pytest.raises(InputError, match="without --out"):
        import_(saved(tmp_path, motor_cad(AROUND), "small.mot"), tmp_path, case=case)
    assert not case.exists()
    case.mkdir()
    with pytest.raises(InputError, match="is there already"):
        import_(saved(tmp_path, motor_cad(AROUND), "small.mot"), case=case)
