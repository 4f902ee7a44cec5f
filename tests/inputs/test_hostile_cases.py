"""A case whose names are an attacker's, through every command that writes: nothing runs, nothing leaves its folder."""

import csv
import ctypes
import itertools
import json
import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import openpyxl
import pytest
import tomlkit
from command_line import RUN, answered
from hostile import CANARY, Tags, hostile_names
from input_cases import case_of

from extras.export.compilers import has_zig, here
from geom.description.names import DEVICES, FORBIDDEN, is_plain
from geom.escapes import xml_text

RUNS = {"iframe", "onerror", "onload", "onmouseover", "srcdoc"}  # tags and attributes that names bring
RESERVED = set("@#")  # of effects at places
NAMES = [n for n in hostile_names(900) if is_plain(n) and not set(n) & RESERVED and n.strip() == n and n]
FILES = [
    n for n in NAMES if not set(n) & FORBIDDEN and n.strip(" .") == n and n.split(".")[0].strip().upper() not in DEVICES
]
OLD = ("winding", "yoke", "flange", "ambient", "current_A", "T_winding", "T_yoke", "T_flange", "wind", "copper")
WRITES = (
    *(("compare", "--json", "c.json"), ("doctor", "--json", "-"), ("simulate", "--out", "out/s"), ("effects",)),
    *(("export", "--as", "xlsx"), ("export", "--as", "csv", "--out", "out/t"), ("export", "--as", "c")),
    *(("export", "--as", "json"), ("export", "--as", "matlab"), ("export", "--as", "observer")),
    *(("calibrate", "--anyway"), ("report", "--out", "out/r"), ("curves",), ("picture", "curves")),
    *(("diagnose", "--json", "d.json"), ("plan",), ("rate", "--limit", "{hot}=155"), ("improve", "--yes")),
    *(("add", "mass@{hot}"), ("render", "--out", "out/q")),
    *(("watch", "--follow", "three/tests/stand.csv", "--out", "out/w"), ("undo",)),
)


def renamed(node, names):
    if isinstance(node, dict):
        return {names.get(k, k): v if k in ("kind", "quantity") else renamed(v, names) for k, v in node.items()}
    if isinstance(node, list):
        return [renamed(value, names) for value in node]
    return names.get(node, node)


def hostile_case(folder, names, tests):
    """The small case under other names of nodes, boundary, input, columns, a loss and tests."""
    case, new = case_of(folder), dict(zip(OLD, names, strict=True))
    for file in (case / "network.toml", *(case / "tests").glob("*.toml")):
        content = tomllib.loads(file.read_text())
        for name, column in content.get("columns", {}).items():
            if name == "current":
                column["input"] = "current_A"
        file.write_text(tomlkit.dumps(renamed(content, new)), encoding="utf-8")
    for file in (case / "tests").glob("*.csv"):
        head, *rows = csv.reader(file.read_text().splitlines())
        with file.open("w", newline="", encoding="utf-8") as out:
            csv.writer(out).writerows([[new.get(name, name) for name in head], *rows])
    settings = tomllib.loads((case / "case.toml").read_text())
    for old, name in zip(("stand", "road", "town"), tests, strict=True):
        settings["tests"][name] = {**settings["tests"].pop(old), "file": f"tests/{old}.csv"}
    settings["case"]["name"] = names[0]
    (case / "case.toml").write_text(tomlkit.dumps(settings), encoding="utf-8")
    return case


def distinct(pool, i, count):
    """`count` names from place i on, round and round."""
    return list(itertools.islice(itertools.cycle(pool), i * count, i * count + count))


@pytest.mark.nightly
@pytest.mark.parametrize("i", range(10))
def test_every_writing_command(tmp_path, i):
    """Ten names a case, 100 in all; three commands each see every case, the others one in two."""
    work = tmp_path / "work"
    work.mkdir()
    hot, *others = distinct(NAMES, i, len(OLD))
    case = hostile_case(work, [hot, *others], distinct(FILES, i, 3))
    inputs = {p: p.read_bytes() for p in case.rglob("*") if p.is_file()}
    codes = {}
    for k, words in enumerate(WRITES):
        if k < 3 or (i + k) % 2:
            done = answered(words[0], case, *(w.replace("{hot}", hot) for w in words[1:]), cwd=work)
            codes[words] = done.code
            assert "a fault of the program" not in done.err, (words, done.err)
            assert done.out.replace("\n", "").isprintable()
            assert done.err.replace("\n", "").isprintable()
    assert codes[WRITES[0]] in (0, 1)
    assert codes[WRITES[2]] == 0
    assert [p for p in tmp_path.rglob(f"*{CANARY}*") if p.name == CANARY] == []
    assert {p.relative_to(tmp_path).parts[0] for p in tmp_path.rglob("*")} == {"work"}
    assert {p: p.read_bytes() for p in inputs if p.name != "model.toml"} == inputs
    for file in work.rglob("*"):
        checked(file)


@pytest.mark.nightly
@pytest.mark.skipif(not (has_zig() or any(map(shutil.which, ("gcc", "clang")))), reason="needs a C compiler")
def test_a_unit_is_compiled_and_loaded_and_nothing_runs(tmp_path):
    hot, *others = distinct(NAMES, 0, len(OLD))
    case = hostile_case(tmp_path, [hot, *others], distinct(FILES, 0, 3))
    done = answered("export", case, "--as", "fmu", "--out", "unit", cwd=tmp_path)
    assert done.code == 0, done.err
    (unit,) = tmp_path.rglob("*.fmu")
    with zipfile.ZipFile(unit) as archive:
        mine = tuple(f"binaries/{platform}/" for platform in (here().fmi2, here().fmi3))
        binary = next(n for n in archive.namelist() if n.startswith(mine) and n.endswith(here().ending))
        ctypes.CDLL(archive.extract(binary, tmp_path / "loaded"))
    assert [p for p in tmp_path.rglob(f"*{CANARY}*") if p.name == CANARY] == []


def checked(file):
    """What was written is what its ending says, and holds no formula."""
    if file.suffix == ".json":
        json.loads(file.read_text(encoding="utf-8"))
    elif file.suffix == ".toml":
        tomllib.loads(file.read_text(encoding="utf-8"))
    elif file.suffix == ".xlsx":
        cells = [c for sheet in openpyxl.load_workbook(file).worksheets for row in sheet for c in row]
        assert not [c for c in cells if c.data_type == "f"]
    elif file.suffix == ".html":
        page = Tags()
        page.feed(file.read_text(encoding="utf-8"))
        assert not [tag for tag in page.tags if RUNS & {tag[0], *tag[1:]}]
    elif file.suffix == ".csv" and "tests" not in file.parts:
        with file.open(newline="", encoding="utf-8") as lines:
            assert not [c for row in csv.reader(lines) for c in row if c[:1] in {"=", "+", "@"}]


EVIL = f"import pathlib\npathlib.Path({str(CANARY)!r}).write_text('')\n"


@pytest.fixture
def hostile_folder(tmp_path):
    """Modules, a package with an entry point, and an egg, as a case folder could bring them."""
    for name in ("evil", "numpy", "typer", "rich", "json", "tomlkit"):
        (tmp_path / f"{name}.py").write_text(EVIL)
    for kind, meta in (("evil-1.0.dist-info", "METADATA"), ("evil2.egg-info", "PKG-INFO")):
        info = tmp_path / kind
        info.mkdir()
        (info / meta).write_text(f"Metadata-Version: 2.1\nName: {kind.split('.')[0].split('-')[0]}\nVersion: 1.0\n")
        groups = ("thermoscope.effects", "thermoscope.quantities", "thermoscope.formats", "numba_extensions")
        (info / "entry_points.txt").write_text("".join(f"[{g}]\ninit = evil\n" for g in groups))
    return tmp_path


@pytest.mark.nightly
@pytest.mark.parametrize(
    "start",
    [
        ["-m", "thermoscope", "explain", "effects"],
        ["-c", "import sys; sys.path.append(''); import numpy\nfrom geom.plugins import plugins; plugins('effects')"],
    ],
)
def test_nothing_is_imported_from_the_folder_of_a_case(hostile_folder, start):
    before = sorted(hostile_folder.rglob("*"))
    flags = ["-P"] if start[0] == "-c" else []
    process = subprocess.run(
        [sys.executable, *flags, *start], cwd=hostile_folder, capture_output=True, text=True, timeout=300, check=False
    )
    assert process.returncode == 0, process.stderr
    assert sorted(hostile_folder.rglob("*")) == before


@pytest.mark.nightly
def test_a_pipe_that_closes_and_no_stdout_at_all(tmp_path):
    """One message, no traceback, exit code 2; without a stdout the document is written all the same."""
    command = [sys.executable, "-c", RUN, "test", "quantities"]
    read, write = os.pipe()
    os.close(read)
    process = subprocess.run([*command, "--json", "-"], stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert (process.returncode, len(process.stderr.splitlines())) == (2, 1), process.stderr
    assert "closed" in process.stderr
    file = tmp_path / "q.json"
    shell = f'"$0" -c "$1" test quantities --json {file} >&-'
    process = subprocess.run(["sh", "-c", shell, sys.executable, RUN], stderr=subprocess.PIPE, text=True, check=False)
    assert (process.returncode, process.stderr) == (0, "")
    assert json.loads(file.read_text())


def test_a_fault_nobody_foresaw_is_one_line(monkeypatch):
    def fails(json=None):
        raise ZeroDivisionError("by\nzero")

    monkeypatch.setattr("thermoscope.commands.test.doctor.quantities", fails)
    done = answered("test", "quantities")
    assert (done.code, done.out) == (2, "")
    assert done.errors == ["error: ZeroDivisionError: by zero; a fault of the program: --debug shows where"]
    with pytest.raises(ZeroDivisionError):
        answered("test", "quantities", "--debug")


def test_ctrl_c_while_a_command_is_loaded_is_one_line(monkeypatch):
    def stopped(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("thermoscope.cli.narrowed_app", stopped)
    done = answered("explain", "effects")
    assert done.code == 130
    assert done.err.startswith("stopped: inputs are as they were")


def test_json_makes_no_folders(tmp_path):
    done = answered("test", "quantities", "--json", tmp_path / "no" / "q.json")
    assert done.code == 2
    assert "a folder that is not there" in done.err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no folder that even its owner may not write to")
def test_json_is_tried_before_any_work(tmp_path):
    """A case that is not there would be the next fault."""
    done = answered("test", "compare", tmp_path / "none", "--json", "/proc/x.json")
    assert done.code == 2
    assert done.errors[-1].startswith("error: --json /proc/x.json: cannot be written")


def test_a_file_name_that_is_no_text(tmp_path):
    """Bytes that no UTF-8 says: refused by its name, as escapes."""
    name = os.fsdecode(b"\xff\xfe")
    done = answered("compare", tmp_path / name)
    assert done.code == 2
    assert r"\udcff\udcfe" in done.errors[0]
    (tmp_path / f"{name}.csv").write_text("t,T\n0,1\n")
    assert answered("new", tmp_path / f"{name}.csv", "--yes", cwd=tmp_path).code == 2


@pytest.mark.nightly
@pytest.mark.parametrize("i", range(7))
def test_a_recording_with_hostile_headers_becomes_a_case(tmp_path, i):
    """Twenty names a file, 140 in all, every piece among them.

    What `new` writes is read again, and names nothing that a file may not."""
    work = tmp_path / "work"
    work.mkdir()
    some = hostile_names()[20 * i : 20 * i + 20]
    names = [xml_text(name.replace("\0", "\1")) for name in some]  # zero bytes and halves of letters are no text
    with (work / f"{names[3].replace('/', '_')[:60]}.csv").open("w", newline="") as out:
        rows = [[f"{20 + k + 3 * j + 0.5 * (j % 2)}" for k in range(len(names))] for j in range(40)]
        heads = ["time_s", "T winding [degC]", "power [W]", *(f"{name} [degC]" for name in names)]
        csv.writer(out).writerows([heads, *([60 * j, 20 + j, 100, *row] for j, row in enumerate(rows))])
    done = answered("new", next(work.iterdir()), "--yes", "--out", "made", cwd=work)
    assert done.code == 0, done.err
    assert (done.out + done.err).replace("\n", "").isprintable()
    assert answered("compare", work / "made", "--json", "-").code in (0, 1)
    assert answered("export", work / "made", "--as", "c").code == 0
    assert [p for p in tmp_path.rglob("*") if p.name == CANARY] == []
    assert {p.relative_to(tmp_path).parts[0] for p in tmp_path.rglob("*")} == {"work"}
    for file in (work / "made").rglob("*.*"):
        checked(file)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("deep.json", b"[" * 100_000 + b"]" * 100_000),
        ("odd.mf4", b"MDF     4.10" + b"\xff" * 200),
        ("odd.tdms", b"TDSm" + b"\xff" * 200),
    ],
)
def test_what_makes_a_package_stumble_is_one_message(tmp_path, name, content):
    """No warning of the package's own, no trace of an object that was half made, no fault of the program."""
    (tmp_path / name).write_bytes(content)
    command = [sys.executable, "-c", RUN, "test", "new", name, "--yes"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    first, *lines = done.stderr.splitlines()
    assert done.returncode == 2
    assert first == f"reading {name}"
    assert lines
    assert lines[0].startswith(f"error: {name}")
    assert not any("Traceback" in line or "WARNING" in line for line in lines)
    assert "fault of the program" not in done.stderr
