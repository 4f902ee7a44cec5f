"""Every file of docs/how-to/extend.md, installed as a package would be, and used: a family, a format, a sensor ..."""

import json
import os
import re
import subprocess
import sys
import tomllib

import pytest

HOUSE = """
import json, sys
from pathlib import Path
import numpy as np
"""
FAMILY = """
from geom.machine_file import machine_from
from lumped.integration.balance import audit
from lumped.integration.simulate import Record, simulate
from lumped.model.sites import ASSUMED_W
from lumped.build.pipeline import build

machine = machine_from({"machine": {"name": "rod", "family": "rod"}, "geometry": {"rod": {"length_mm": 100.0}}})
network = build(machine, size_m=0.02).network
time = np.linspace(0.0, 4e5, 400)
record = Record(time, {}, {"ambient": np.full_like(time, 20.0)}, 20.0)
run = simulate(network, record, {}, [network.places[n].mean for n in ("rod", "tube")])
heat = audit(network, record, {})
print(json.dumps({"parts": {p.name: p.role for p in machine.parts}, "end": run.y[-1].tolist(), "assumed_W": ASSUMED_W,
                  "mismatch": heat.mismatch, "volume": machine.parts[0].volume}))
"""
RECORDING = """
from measured.recordings.formats import read_recording
from measured.importing.source import read_source

file = Path(sys.argv[1]) / "bench.acme"
np.array([[k, 10.0, 20.0 + k] for k in range(5)], "<f4").tofile(file)
table, source = read_recording(file), read_source(file)
last = [table[name][-1] for name in table.columns]
print(json.dumps({"columns": table.columns, "last": last, "units": source.units}))
"""
SENSOR = """
from measured.recordings.sheet import read_sheet
from measured.recordings.tables import load_table

columns = {
    "pt": {"quantity": "pt1000", "unit": "kohm", "place": "winding"},
    "ratio": {"quantity": "resistance_ratio", "unit": "%", "place": "winding", "sigma": 0.393, "cold_degC": 25},
    "spot": {"quantity": "infrared_spot", "unit": "K", "place": "housing", "emissivity": 0.5},
    "flux": {"quantity": "heat_flux", "unit": "kW/m2"}}
sheet = read_sheet({"test": {"time": "time_s"}, "columns": columns}, "a sheet")
file = Path(sys.argv[1]) / "a.csv"
rows = [(k, 1.385055, 139.3, 293.15 + 60.0 * (k > 1), 2.0 + k) for k in range(4)]
file.write_text("time_s,pt,ratio,spot,flux\\n" + "".join(",".join(map(str, row)) + "\\n" for row in rows))
read = load_table(file, sheet)
first, last = ({n: v[k] for n, v in read.values.items()} for k in (0, -1))
feeds, hot = {c.name: c.feeds for c in sheet.columns}, [c.name for c in sheet.columns if c.is_temperature]
print(json.dumps({"first": first, "last": last, "sigma_K": dict(read.sigma_K), "feeds": feeds, "hot": hot}))
"""
RISES = """
from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate

def rise(link, loss, inputs, until_s):
    data = {"network": {"name": "one", "boundaries": ["air"]}, "nodes": {"body": {"C_J_K": 100.0}},
            "links": {"film": {"between": ["body", "air"], **link}}, "losses": {"heat": {"at": "body", **loss}}}
    network, time = read_network(data, "network.toml"), np.linspace(0.0, until_s, 300)
    inputs = {n: np.full_like(time, u) for n, u in inputs.items()}
    record = Record(time, inputs, {"air": np.full_like(time, 20.0)}, 20.0)
    return float(simulate(network, record, {}, [network.places["body"].mean]).y[-1, 0]) - 20.0

sun = {"kind": "constant", "P_W": 10.0, "of": {"input": "heat_flux_W_m2", "at": 1000.0}}
ball = {"area_m2": 0.0314, "natural": {"surface": "sphere", "size_m": 0.1}}
print(json.dumps([rise({"G_W_K": 0.5}, sun, {"heat_flux_W_m2": 500.0}, 4e3),
                  rise(ball, {"kind": "constant", "P_W": 5.0}, {}, 2e4)]))
"""


@pytest.fixture(scope="module")
def used(root, tmp_path_factory):
    """used(code, *arguments) -> what it prints, where the page's package is installed."""
    page = (root / "docs" / "how-to" / "extend.md").read_text()
    *modules, project = re.findall(r"```(?:python|toml)\n(.*?)```", page, re.DOTALL)
    home = tmp_path_factory.mktemp("acme")
    for text in modules:
        (home / re.match(r"# (\w+\.py)", text)[1]).write_text(text)
    info = home / "acme-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme\nVersion: 1.0\n")
    groups = tomllib.loads(project)["project"]["entry-points"]
    lines = [x for g, points in groups.items() for x in (f"[{g}]", *(f"{n} = {t}" for n, t in points.items()))]
    (info / "entry_points.txt").write_text("\n".join(lines))

    def run(code, *arguments):
        path = os.pathsep.join([str(home), str(root)])
        environment = {**os.environ, "PYTHONPATH": path, "THERMOSCOPE_CACHE": str(home / "cache")}
        command = [sys.executable, "-c", HOUSE + code, *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=500)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.mark.nightly
def test_a_family_goes_all_the_way_to_a_network(used):
    """Its assumed loss leaves through the tube, the rod is warmer than the tube, volumes are those of a cylinder."""
    found = json.loads(used(FAMILY))
    rod, tube = found["end"]
    assert found["parts"] == {"rod": "winding", "tube": "housing"}
    assert rod > tube > 20.5
    assert found["assumed_W"] > 0
    assert abs(found["mismatch"]) < 1e-3
    assert found["volume"] == pytest.approx(3.14159 * 0.02**2 * 0.1, rel=1e-5)


def test_a_format_is_read_by_compare_and_by_new(used, tmp_path):
    found = json.loads(used(RECORDING, tmp_path))
    assert found["columns"] == ["time_s", "I [A]", "T_winding [degC]"]
    assert found["last"] == [4.0, 10.0, 24.0]


@pytest.fixture(scope="module")
def read(used, tmp_path_factory):
    return json.loads(used(SENSOR, tmp_path_factory.mktemp("read")))


def test_a_sensor_reads_by_its_own_law(read):
    """IEC 60751: 1385.055 ohm at 100 degC. Copper at 1.393 times its resistance of 25 degC: 100 K warmer."""
    assert read["last"]["pt"] == pytest.approx(100.0, abs=1e-3)
    assert read["last"]["ratio"] == pytest.approx(125.0, abs=1e-9)


def test_a_spot_as_warm_as_its_surroundings_is_that_and_a_mirror_is_warmer_than_it_looks(read):
    """Emissivity 0.5, 80 degC seen: (2 * 353.15^4 - 293.15^4)^(1/4) K, by hand 392.5 K."""
    assert read["first"]["spot"] == pytest.approx(20.0, abs=1e-9)
    assert read["last"]["spot"] == pytest.approx(392.46 - 273.15, abs=0.05)


def test_a_deviation_is_in_the_unit_of_the_readings(read):
    """1.2 ohm over 3.79 ohm/K at 100 degC; 0.393 % over 0.393 %/K. A heat flux has none: it drives an input."""
    assert read["sigma_K"]["pt"] == pytest.approx(1.2 / 3.79, rel=2e-3)
    assert read["sigma_K"]["ratio"] == pytest.approx(1.0, rel=1e-6)
    assert set(read["sigma_K"]) == set(read["hot"]) == {"pt", "ratio", "spot"}


def test_a_heat_flux_drives_an_input_in_its_own_unit(read):
    assert read["feeds"] == {"pt": "", "ratio": "", "spot": "", "flux": "heat_flux_W_m2"}
    assert read["last"]["flux"] == pytest.approx(5000.0)


@pytest.mark.nightly
def test_a_loss_follows_the_heat_flux_and_a_correlation_carries_heat(used):
    """500 W/m2 into 0.01 m2 leave through 0.5 W/K: 10 K.

    5 W from 0.0314 m2 of a sphere: at 30 K Ra = 2.5e6 and Nu = 20.0 (by hand), so h = 5.31 W/m2/K.
    """
    plate, ball = json.loads(used(RISES))
    assert plate == pytest.approx(10.0, rel=1e-4)
    assert ball == pytest.approx(5.0 / (5.31 * 0.0314), rel=0.02)


@pytest.mark.nightly
def test_a_picture_is_drawn_by_the_command(used, root, tmp_path):
    code = "import sys; sys.argv[0] = 'thermoscope'; from thermoscope.cli import main; main()"
    case = root / "cases" / "tclab"
    used(code, "show", "picture", case, "largest", "--out", tmp_path / "largest.png")
    assert (tmp_path / "largest.png").read_bytes().startswith(b"\x89PNG")
