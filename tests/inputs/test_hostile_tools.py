"""Hostile names through what reads other programs' machines, a fleet's recordings and a bench's records."""

import csv
import json
import shutil
import tomllib

import numpy as np
import pytest
import tomlkit
from command_line import answered
from foreign_machines import motor_cad, pyleecan, whole
from hostile import CANARY, hostile_names
from test_hostile_cases import FILES, NAMES, OLD, checked, distinct, hostile_case

from geom.escapes import xml_text
from simulated.bench.kinds import write_case
from simulated.bench.plant import Plant, drawn

pytestmark = pytest.mark.nightly
MACHINE = "ipmsm-48s8p-jacket"
EACH = 30  # names a test


def ran(work, *words):
    """The exit code of a command; whatever it wrote is text, lies in the folder, and runs nothing."""
    done = answered(*words, cwd=work)
    assert done.code in (0, 1, 2), done.err
    assert "a fault of the program" not in done.err, (words, done.err)
    assert (done.out + done.err).replace("\n", "").isprintable()
    return done.code


def clean(tmp_path):
    """Nothing lies beside the folder `work`, and every file in it is what its ending says."""
    assert [p for p in tmp_path.rglob(f"*{CANARY}*") if p.name == CANARY] == []
    assert {p.relative_to(tmp_path).parts[0] for p in tmp_path.rglob("*")} == {"work"}
    for file in (tmp_path / "work").rglob("*.*"):
        if file.is_file():
            checked(file)


@pytest.fixture
def work(tmp_path):
    (tmp_path / "work").mkdir()
    return tmp_path / "work"


def of_pyleecan(file, name):
    machine = pyleecan(name=name, stator__mat_type__name=name, stator__winding__conductor__cond_mat__name=name)
    file.write_text(json.dumps(machine))


def of_motor_cad(file, name):
    line = " ".join(name.encode(errors="replace").decode().split("\n"))
    legend = {"Temperature_Validation_Legend[3]": line, "Housing_Water_Jacket_Fluid_Name": line}
    file.write_text(motor_cad(f"DataFile_Notes={line}\n", Title=line, **legend), encoding="utf-8")


def of_drawing(file, name):
    sheet = whole()
    letters = "".join(c for c in xml_text(name) if c not in '<>/\\":;?*=`|,' and c.isprintable())
    sheet.circle(f"stator {letters}"[:200], 69.0)
    sheet.space.add_text(name.encode(errors="replace").decode().replace("\n", "^J"), dxfattribs={"layer": "0"})
    sheet.document.saveas(file)


def of_loss_map(file, name):
    speed, torque = (a.ravel() for a in np.meshgrid(np.linspace(1e3, 9e3, 5), np.linspace(0.0, 200.0, 5)))
    heads = ["Speed [rpm]", "Torque [Nm]", "Stator_Copper_Loss [W]", f"Iron_Loss {xml_text(name)} [W]", xml_text(name)]
    with file.open("w", newline="", encoding="utf-8", errors="replace") as out:
        csv.writer(out).writerows([heads, *zip(speed, torque, 0.02 * torque**2, 0.01 * speed, speed)])


IMPORTS = {
    "json": (of_pyleecan, ()),
    "mot": (of_motor_cad, ()),
    "dxf": (of_drawing, ("--stack-mm", 80)),
    "csv": (of_loss_map, ("--machine", MACHINE)),
}


@pytest.mark.parametrize("ending", IMPORTS)
@pytest.mark.parametrize("i", range(5))
def test_machines_of_other_programs(tmp_path, work, ending, i):
    """Thirty names a test, 150 of each kind, every piece among them.

    What is written is one machine file, whatever the other calls things."""
    make, options = IMPORTS[ending]
    (work / "in").mkdir()
    for k, name in enumerate(hostile_names()[EACH * i : EACH * (i + 1)]):
        file = work / "in" / f"m{k}.{ending}"
        make(file, name)
        code = ran(work, "import", file, "--out", f"out/{k}", *options)
        written = [p for p in (work / "out" / str(k)).rglob("*") if p.is_file()]
        assert [p.suffix for p in written] == [".toml"] * (code == 0), name
    shutil.rmtree(work / "in")
    clean(tmp_path)


@pytest.mark.parametrize("i", range(2))
def test_a_fleet_a_bench_and_other_machines(tmp_path, work, i):
    hot, *others = distinct(NAMES, 7 * i, len(OLD))
    case = hostile_case(work, [hot, *others], distinct(FILES, i, 3))
    second = shutil.copytree(case, work / "second")
    units = [work / "units" / f"{name[:60]}@2026-0{k + 1}.csv" for k, name in enumerate(distinct(FILES, i + 9, 6))]
    units[0].parent.mkdir()
    for k, unit in enumerate(units):
        shutil.copy(case / "tests" / f"{('stand', 'road', 'town')[k % 3]}.csv", unit)
    assert ran(work, "fleet", case, "units", "--json", "fleet.json") < 2
    assert ran(work, "calibrate", case, "--anyway") < 2
    for words in (
        ("carry", case, second, "--json", "carry.json"),
        ("two-paths", case, "--winding", hot, "--machine", others[0], "--json", "paths.json"),
        *(("bases", case), ("add", case, f"mass@{hot}"), ("remove", case, f"mass@{hot}")),
        ("answer", case, others[2], f"{hot}: 0.3 K"),
        *(("viewer", case, "--out", "viewer.html"), ("film", case, "--out", "film.gif")),
        ("picture", case, "network", "--out", "network.png"),
        *(("picture", case, "losses", "--out", "losses.png"), ("crosscheck", case)),
        ("watch", case, "--follow", units[0], "--out", "w", "--json", "w.json"),
        ("live", case, "--follow", units[0], "--out", "l", "--json", "l.json"),
        ("model", "machines", "--copy", MACHINE, "--out", f"m/{hot.replace('/', '')[:40]}"),
    ):
        ran(work, *(("bench", *words) if words[0] in ("carry", "two-paths", "bases", "live") else words))
    clean(tmp_path)


@pytest.mark.parametrize("i", range(4))
def test_a_law_and_a_heat_run(tmp_path, work, i):
    """Every header of a table of steady tests, every text of a record."""
    heat, inlet, flow, speed, *sensors = distinct([n for n in NAMES if not set(n) & set("[](){}*?,")], i, 7)
    F, N, T = (x.ravel() for x in np.meshgrid([1.0, 2.0, 4.0, 6.0], [0.0, 2e3, 5e3, 1e4], [40.0, 80.0]))
    P = 800.0 + 300.0 * np.sqrt(F) + 0.1 * N
    rise = P / (60.0 * (F / 6) ** 0.5 + 150.0 * (N / 1e4) ** 1.2)
    with (work / "steady.csv").open("w", newline="", encoding="utf-8") as out:
        heads = [heat, inlet, flow, speed, *(f"T_{s}" for s in sensors)]
        csv.writer(out).writerows([heads, *zip(P, T, F, N, T + rise, T + 1.1 * rise, T + 0.9 * rise)])
    follows = ("--follows", f"{flow}=l/min", "--follows", f"{speed}=rpm")
    words = (
        *("--heat", heat, "--coolant", inlet),
        *follows,
        *("--temperatures", "T_*", "--out", "law", "--json", "law.json"),
    )
    ran(work, "bench", "law", "steady.csv", *words)
    name = sensors[0]
    record = {
        "machine": {"rated_kW": 7},
        "heat_run": {"title": name, "class": "F", "thermometer_K": 0.001},
        "cold": {"room_degC": 20.0, "machine_degC": 20.0, "resistance_ohm": 0.5},
        "load": {"readings": [[t, 80.0 - 60.0 * float(np.exp(-t / 60))] for t in range(0, 600, 10)]},
        "hot": {"ambient_degC": 20.0, "readings": [[t, 0.7 - 1e-4 * t] for t in range(20, 300, 15)]},
        "names": {"tested": name, "approved": sensors[1]},
    }
    meter = {"range": [0.1, 4.0], "percent": 0.0, "offset": 1e-6, "resolution": 1e-6}
    record["meters"] = {"resistance": [meter]}
    (work / "record.toml").write_text(tomlkit.dumps(record), encoding="utf-8")
    assert tomllib.loads((work / "record.toml").read_text(encoding="utf-8"))["heat_run"]["title"] == name
    ran(work, "bench", "report", "record.toml", "--out", "page", "--json", "page.json")
    ran(work, "bench", "protocol", "record.toml", "--json", "protocol.json")
    clean(tmp_path)


def test_rows_of_a_bench(tmp_path, work):
    """Every header that the bench does not know, and every name of the test that its rows become."""
    case = write_case("servo", work / "servo")
    (case / "bench.toml").write_text(f"silence_s = 0.5\n{(case / 'bench.toml').read_text()}")
    row = Plant(drawn("servo", 7, "nothing")).row()
    for k, name in enumerate(distinct(NAMES, 3, 6)):
        with (work / "rows.csv").open("w", newline="", encoding="utf-8") as out:
            csv.writer(out).writerows([[*row, name], *([*row.values(), 1.0] for _ in range(3))])
        for test in (hostile_names()[17 * k], distinct(FILES, k, 1)[0]):
            ran(work, "bench", "live", case, "--follow", "rows.csv", f"--test={test}", "--out", "l", "--json", "l.json")
    shutil.rmtree(case)
    clean(tmp_path)
