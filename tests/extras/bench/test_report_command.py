"""bench report through the command line: the page, its numbers, exit codes, and what it refuses."""

import csv
import json
import re
import shutil
import tomllib

import numpy as np
import pytest
from test_heat_run import cooling, warming
from test_procedure_commands import NETWORK, warmed

from viz.pages.html import BROWSERS

HEAD = """
[machine]
rated_kW = 7
[heat_run]
title = "motor 42"
class = "F"
{more}
thermometer_K = 0.001
[cold]
room_degC = 20.0
machine_degC = 20.0
resistance_ohm = 0.5
[load]
readings = {load}
[hot]
ambient_degC = 20.0
readings = {cooling}
[meters]
resistance = [{{ range = [0.1, 4.0], percent = 0.0, offset = 1e-6, resolution = 1e-6 }}]
[names]
tested = "A. Smith"
"""


WINDING = """
[test]
time = "time_s"
[columns.current_A]
quantity = "current"
unit = "A"
[columns.T_air]
quantity = "temperature"
unit = "degC"
place = "ambient"
[columns.R_ohm]
quantity = "resistance"
unit = "ohm"
place = "winding"
cold = { reading = 1.0, at_degC = 20.0 }
reference_degC = 20
meter = { percent = 0.01, offset = 1e-5, resolution = 1e-5, range = [0.4, 4.0] }
after = { file = "cooling.csv", column = "R_ohm", ambient_degC = 20.0, rated_kW = 7 }
"""


def text_of(T0=120.0, more="", until=400.0, tail="", first_s=20.0):
    """A record of exact meters, whose first reading is the temperature T0 (degC)."""
    readings = cooling(first_s, T0)
    factor = 0.5 * (235.0 + T0) / 255.0 / readings[0][1]
    rows = [[float(t), float(R * factor)] for t, R in readings]
    load = [list(map(float, row)) for row in warming(until, 10.0)]
    return HEAD.format(more=more, load=load, cooling=rows) + tail


def without_readings(more=""):
    """The record without what was read in the run."""
    return re.sub(r"\[(cold|load|hot)\]\n(\w+ = .*\n)+", "", text_of(more=more))


@pytest.fixture
def report(thermoscope, tmp_path, monkeypatch):
    """report(text) -> Answer of the command on a record; its files are in tmp_path/out, printed by nobody."""
    monkeypatch.setattr("thermoscope.plugin.write_pdf", lambda page: None)

    def run(text, *more):
        (tmp_path / "motor.toml").write_text(text)
        return thermoscope("bench", "report", "motor.toml", "--out", "out", *more, cwd=tmp_path)

    return run


def test_machine_that_passes(report, tmp_path):
    """100 K of 105 K, known exactly: 5 K in hand; page, CSV and JSON say the same."""
    done = report(text_of(), "--json", "-")
    assert done.code == 0, done.err
    found = done.document
    assert found["sentence"] == "class F: 100.0 ± 0.0 K of 105.0 K, passes with 5.0 K in hand after the uncertainty"
    assert json.loads((tmp_path / "out/motor-42.json").read_text()) == found
    page = (tmp_path / "out/motor-42.html").read_text()
    assert found["sentence"] in page
    assert "<td>ETD</td>" in page
    rows = list(csv.DictReader((tmp_path / "out/motor-42.csv").open()))
    written = {(r["table"], r["row"], r["column"]): r["value"] for r in rows}
    assert float(written["rises", "1", "rise (K)"]) == pytest.approx(found["rises"][0]["rise_K"])
    etd = next(r["row"] for r in rows if r["value"] == "ETD")
    assert written["rises", etd, "rise (K)"] == ""


def test_machine_that_fails_by_1_K(report):
    done = report(text_of(T0=126.0))
    assert done.code == 1
    assert "class F: 106.0 ± 0.0 K of 105.0 K, fails by 1.0 K after the uncertainty" in done.out.replace("\n", " ")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (text_of(T0=126.0).replace("thermometer_K = 0.001", "thermometer_K = 2.0"), "within the uncertainty"),
        (text_of(until=150.0), "not steady"),
        (text_of().replace("ambient_degC = 20.0", "ambient_degC = 8.0"), "no limit to judge by"),
        (text_of(more='standard = "IEC 60349"'), "no limit to judge by"),
        (re.sub(r"\[load\]\nreadings = .*\n", "", text_of()), "no temperature was logged under load"),
        (re.sub(r"\[hot\]\n.*\n.*\n", "", text_of()), "no rise was measured"),
    ],
)
def test_machine_that_cannot_be_judged(report, text, words):
    done = report(text, "--json", "-")
    assert done.code == 1
    assert done.document["verdict"] == "cannot be judged"
    assert words in done.document["sentence"]


def test_unsteady_machine_that_is_too_hot_already_fails(report):
    """It would only get hotter."""
    assert report(text_of(T0=150.0, until=150.0), "--json", "-").document["verdict"] == "fails"


def test_traction_is_judged_by_the_limit_of_its_contract(report):
    done = report(
        text_of(more='standard = "IEC 60349"', tail='[limit]\nK = 180\nsource = "contract 12"\n'), "--json", "-"
    )
    assert done.code == 0, done.err
    assert done.document["decides"] == "resistance, exponentials"
    assert {"clause": "contract 12", "limit_K": 180.0}.items() <= done.document["limits"][-1].items()


def test_part_tests_in_place_of_the_load(report):
    text = without_readings()
    parts = "".join(
        f'[[superposition]]\nname = "{n}"\nsign = {s}\nrise_K = {K}\nsd_K = 0.5\n'
        for n, s, K in (("open", 1, 40), ("short", 1, 60), ("no load", -1, 8))
    )
    done = report(text + parts, "--json", "-")
    assert done.code == 0, done.err
    assert done.document["decides"] == "superposition"
    assert done.document["sentence"].startswith("class F: 92.0 ± 1.7 K of 105.0 K, passes with 11.3 K in hand")


def test_power_and_detectors(report):
    more = "[power_30min]\nreadings = [[0, 50.0], [1800, 48.0]]\n[etd]\ndegC = [110.0, 112.5]\n"
    found = report(text_of(tail=more).replace("rated_kW = 7", "rated_kW = 500"), "--json", "-").document
    assert found["power_30min"]["power_kW"] == pytest.approx(49.0)
    etd = next(r for r in found["rises"] if r["method"] == "ETD")
    assert (etd["rise_K"], etd["limit_K"]) == (92.5, 115.0)


def test_signature_is_that_of_numbers_and_names(report):
    """Comments change nothing; another name, or another digit, is another signature."""
    texts = [text_of(), "# a comment\n" + text_of(), text_of().replace("A. Smith", "B. Smith"), text_of(T0=120.001)]
    keys = [report(text, "--json", "-").document["signature"]["record"] for text in texts]
    assert keys[0] == keys[1]
    assert len(set(keys)) == 3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "key 'rated_kW' is missing"),
        (text_of(tail="[hat]\nsize = 1\n"), "unknown key 'hat'"),
        (text_of().replace('class = "F"', 'class = "G"'), "class = 'G'"),
        (text_of(more="clas = 1"), "unknown key 'clas'"),
        (text_of(more='duty = "S11"'), "duty = 'S11'"),
        (text_of(more='duty = "S2"'), "the duty S2 has no rated_min"),
        (text_of(more='duty = "S4"'), "the duty S4 has no cycle_min"),
        (text_of(more='duty = "S9"'), "the duty S9 has no loads"),
        (text_of(more='duty = "S10"\nloads = [[1, 1, 1]]\ntest_load = 1.0'), "loads is not a list of pairs"),
        (text_of(more='case = "tclab"'), "case and [cold], [load] or [hot] are both given"),
        (text_of(tail="[limit]\nK = 180\n"), "key 'source' is missing"),
        (text_of(tail="[power_30min]\nreadings = [[0, 50], [600, 50]]\n"), "10.0 min of power"),
        (text_of(tail="[power_30min]\nreadings = [[0, 0], [1800, 50]]\n"), "powers above 0"),
        (text_of(tail='[[superposition]]\nname = "a"\nsign = 0\nrise_K = 1\nsd_K = 1\n'), "sign = 0"),
        (text_of(first_s=61.0), "60 s is the latest"),
        (text_of().replace("[[20.0, ", "[[120.0, "), "the time 35 does not come after"),
        (text_of().replace("machine_degC = 20.0", "machine_degC = 25.0"), "5.0 K off the room"),
        (text_of().replace("rated_kW = 7", "rated_kW = 6000"), "beyond 5000 kW"),
        (without_readings('case = "nowhere"'), "no such case folder"),
        (without_readings('case = "tclab"'), "measures no winding by its resistance"),
        (without_readings('case = "tclab"\ntest = "mars"'), "test = 'mars'"),
    ],
)
def test_bad_input(report, tmp_path, text, words):
    """One message, exit code 2, and nothing half-written."""
    done = report(text)
    assert done.code == 2
    assert words in done.err
    assert len(done.errors) == 1
    assert not (tmp_path / "out").exists()


def test_no_file_is_one_message(thermoscope, tmp_path):
    done = thermoscope("bench", "report", "nothing.toml", cwd=tmp_path)
    assert (done.code, len(done.errors)) == (2, 1)


def test_way_back_along_the_network_of_a_case(thermoscope, tmp_path, monkeypatch):
    """From readings that begin 30 s late the network of the case finds the truth at switching off within 0.1 K."""
    monkeypatch.setattr("thermoscope.plugin.write_pdf", lambda page: None)
    off, later = 72000.0, np.arange(30.0, 331.0, 15.0)
    load = np.arange(0.0, off + 1.0, 600.0)
    T = warmed(np.append(load, off + later), off_s=off, step=1.0)[0]
    ohm = (235.0 + T) / 255.0
    (tmp_path / "tests").mkdir()
    (tmp_path / "network.toml").write_text(NETWORK)
    (tmp_path / "case.toml").write_text(
        '[case]\nname = "two"\nnetwork = "network.toml"\nsample_s = 600\n[tests.run]\nrole = "calibrate"\n'
    )
    (tmp_path / "tests/run.toml").write_text(WINDING)
    rows = "".join(f"{t:g},15,20,{R:.6f}\n" for t, R in zip(load, ohm, strict=False))
    (tmp_path / "tests/run.csv").write_text(f"time_s,current_A,T_air,R_ohm\n{rows}")
    rows = "".join(f"{t:g},{R:.6f}\n" for t, R in zip(later, ohm[load.size :], strict=True))
    (tmp_path / "tests/cooling.csv").write_text(f"time_s,R_ohm\n{rows}")
    (tmp_path / "heat-run.toml").write_text('[machine]\nrated_kW = 7\n[heat_run]\nclass = "B"\ncase = "."\n')
    done = thermoscope("bench", "report", tmp_path, "--out", tmp_path / "out", "--json", "-")
    assert done.code == 0, done.err
    by_method = {r["method"]: r["temperature_degC"] for r in done.document["rises"]}
    assert by_method["resistance, network of two"] == pytest.approx(T[load.size - 1], abs=0.1)
    assert by_method["resistance, IEC 60034-1"] == pytest.approx(T[load.size], abs=0.01)
    assert done.document["duty"]["missing"] == ""


@pytest.mark.skipif(not any(map(shutil.which, BROWSERS)), reason="no Chromium")
def test_pdf_is_one_page(thermoscope, tmp_path):
    (tmp_path / "motor.toml").write_text(text_of())
    assert thermoscope("bench", "report", "motor.toml", cwd=tmp_path).code == 0
    assert len(re.findall(rb"/Type\s*/Page\b", (tmp_path / "out/motor-42.pdf").read_bytes())) == 1


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("case", "test", "verdict"),
    [("pmsm-bases", "bench", "passes"), ("pmsm-machines/m2", "m2", "passes"), ("pmsm-machines/m3", "m3", "fails")],
)
def test_machines_of_the_second_paper(thermoscope, root, tmp_path, monkeypatch, case, test, verdict):
    """The true rise at switching off lies within the fits' own uncertainty; what the standard counts is lower."""
    monkeypatch.setattr("thermoscope.plugin.write_pdf", lambda page: None)
    truth = tomllib.loads((root / "simulated/pmsm.truth.toml").read_text())[test]
    rise = truth["winding_degC"] - truth["ambient_degC"]
    folder = root / "cases" / case
    found = thermoscope("bench", "report", folder, "--out", tmp_path, "--json", "-").document
    assert found["verdict"] == verdict
    assert found["signature"]["case"] == case
    assert len(found["signature"]["key"]) == 20
    for row in found["rises"]:
        if row["method"].endswith(("exponentials", f"network of {case}")):
            assert row["rise_K"] == pytest.approx(rise, abs=row["U95_K"])
    assert np.isfinite(found["rises"][0]["rise_K"])
    assert found["rises"][0]["rise_K"] < rise


def test_documented_record_is_one(report, root):
    """Every key of the record on the page is known, and its numbers are judged."""
    page = (root / "docs/how-to/heat-run.md").read_text(encoding="utf-8")
    (text,) = [block.split("```")[0] for block in page.split("```toml\n")[1:]]
    done = report(text, "--json", "-")
    assert done.code == 0, done.err
    assert {row["method"] for row in done.document["rises"] if row["rise_K"] is not None} >= {"ETD", "superposition"}
