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
FAMILY = (
    HOUSE
    + """
from geom.machine_file import machine_from
from lumped.integration.audit import audit
from lumped.integration.simulate import Record, simulate
from lumped.machine.losses import ASSUMED_W
from thermoscope.pipeline import build

machine = machine_from({"machine": {"name": "rod", "family": "rod"}, "geometry": {"rod": {"length_mm": 100.0}}})
network = build(machine, size_m=0.02).network
time = np.linspace(0.0, 4e5, 400)
record = Record(time, {}, {"ambient": np.full_like(time, 20.0)}, 20.0)
run = simulate(network, record, {}, [network.places[n].mean for n in ("rod", "tube")])
heat = audit(network, record, {})
print(json.dumps({"parts": {p.name: p.role for p in machine.parts}, "end": run.y[-1].tolist(), "assumed_W": ASSUMED_W,
                  "mismatch": heat.mismatch, "volume": machine.parts[0].volume}))
"""
)
RECORDING = (
    HOUSE
    + """
from thermoscope.recordings.formats import read_frame
from thermoscope.importing.source import read_source

file = Path(sys.argv[1]) / "bench.acme"
np.array([[k, 10.0, 20.0 + k] for k in range(5)], "<f4").tofile(file)
table, source = read_frame(file), read_source(file)
print(json.dumps({"columns": list(table.columns), "last": table.iloc[-1].tolist(), "units": source.units}))
"""
)
SENSOR = (
    HOUSE
    + """
from thermoscope.recordings.sheet import read_sheet
from thermoscope.recordings.units import converted

sheet = read_sheet({"test": {"time": "time_s"}, "columns": {
    "T": {"quantity": "pt1000", "unit": "kohm", "place": "winding"}}}, "a sheet")
(column,) = sheet.columns
print(json.dumps({"degC": converted(np.array([1.0, 1.385055]), "pt1000", "kohm").tolist(), "sigma_K": column.sigma_K,
                  "hot": column.is_temperature, "place": column.place, "feeds": column.feeds}))
"""
)
FILM = (
    HOUSE
    + """
from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate

network = read_network({
    "network": {"name": "ball", "boundaries": ["air"]}, "nodes": {"ball": {"C_J_K": 100.0}},
    "links": {"film": {"between": ["ball", "air"], "area_m2": 0.0314, "natural": {"surface": "sphere", "size_m": 0.1}}},
    "losses": {"heat": {"at": "ball", "kind": "constant", "P_W": 5.0}}}, "network.toml")
time = np.linspace(0.0, 2e4, 300)
run = simulate(network, Record(time, {}, {"air": np.full_like(time, 20.0)}, 20.0), {}, [network.places["ball"].mean])
print(json.dumps({"rise": float(run.y[-1, 0]) - 20.0}))
"""
)


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
        done = subprocess.run([sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True,
                              env=environment, timeout=500)  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


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


def test_a_sensor_reads_by_its_own_law(used):
    """IEC 60751: 1385.055 ohm at 100 degC."""
    found = json.loads(used(SENSOR))
    assert found["degC"] == pytest.approx([0.0, 100.0], abs=1e-3)
    assert found == {**found, "sigma_K": 0.3, "hot": True, "place": "winding", "feeds": ""}


def test_a_correlation_carries_heat(used):
    """5 W from 0.0314 m2 of a sphere: at 30 K Ra = 2.5e6 and Nu = 20.0 (by hand), so h = 5.31 W/m2/K."""
    assert json.loads(used(FILM))["rise"] == pytest.approx(5.0 / (5.31 * 0.0314), rel=0.02)


def test_a_picture_is_drawn_by_the_command(used, root, tmp_path):
    code = "import sys; sys.argv[0] = 'thermoscope'; from thermoscope.cli import main; main()"
    case = root / "cases" / "tclab"
    used(code, "show", "picture", case, "largest", "--out", tmp_path / "largest.png")
    assert (tmp_path / "largest.png").read_bytes().startswith(b"\x89PNG")
