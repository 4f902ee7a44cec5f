"""What a small file may ask of the machine: refused before it is kept, by a limit that says its name and its cure."""

import gzip
import os
import re
import struct
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest

from geom import import_step, load_machine
from geom.errors import InputError
from geom.limits import LIMITS
from geom.meshing.mesher import COARSE, build_mesh
from measured.importing.source import read_source
from measured.recordings.formats import read_recording
from scripts.limits_page import PAGE, page

HEADER = "time_s,T_winding,air\n"
ROWS = [[float(k), 20.0 + k, 20.0] for k in range(40)]
MEMORY_MB = 400  # of a process that reads a small file: packages alone take about 200


def text(path, rows=ROWS, end=""):
    content = HEADER + "".join(",".join(map(str, row)) + "\n" for row in rows) + end
    path.write_bytes(gzip.compress(content.encode()) if path.suffix == ".gz" else content.encode())
    return path


def book(path, **cells):
    openpyxl = pytest.importorskip("openpyxl")
    workbook = openpyxl.Workbook()
    for row in [HEADER.strip().split(","), *ROWS]:
        workbook.active.append(row)
    for where, value in cells.items():
        workbook.active[where] = value
    workbook.save(path)
    return path


def parquet(path):
    pa, pq = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    columns = dict(zip(HEADER.strip().split(","), zip(*ROWS, strict=True), strict=True))
    pq.write_table(pa.table({name: list(values) for name, values in columns.items()}), path)
    return path


FILES = {"a.csv": text, "a.csv.gz": text, "a.xlsx": book, "a.parquet": parquet}


def test_page_of_limits_is_current():
    """After a change: python -m scripts.limits_page"""
    assert PAGE.read_text(encoding="utf-8") == page()


@pytest.mark.parametrize(
    ("reader", "limit", "low"), [(read_recording, "rows", 20), (read_source, "cells", 60), (read_source, "bytes", 200)]
)
@pytest.mark.parametrize("name", FILES)
def test_what_is_too_much_is_refused_by_name_and_read_with_the_limit_raised(
    tmp_path, monkeypatch, name, limit, low, reader
):
    file = FILES[name](tmp_path / name)
    monkeypatch.setenv(f"THERMOSCOPE_MOST_{limit.upper()}", str(low))
    with pytest.raises(InputError) as refused:
        reader(file)
    found = re.search(rf"{re.escape(str(file))}.*the limit '{limit}', raised by (\w+)=(\d+)", str(refused.value))
    monkeypatch.setenv(found[1], "1_000_000")
    assert reader(file).rows == len(ROWS)


@pytest.mark.parametrize("name", ["a.csv", "a.csv.gz"])
def test_as_many_lines_as_the_limit_says_are_read_and_one_more_is_not(tmp_path, monkeypatch, name):
    file = text(tmp_path / name)
    monkeypatch.setenv("THERMOSCOPE_MOST_ROWS", str(len(ROWS) + 1))  # with its header
    assert read_source(file).rows == len(ROWS)
    monkeypatch.setenv("THERMOSCOPE_MOST_ROWS", str(len(ROWS)))
    with pytest.raises(InputError, match=f"holds at least {len(ROWS) + 1} rows; at most {len(ROWS)} rows"):
        read_source(file)


@pytest.mark.parametrize("name", ["a.csv", "a.csv.gz"])
def test_rows_of_nothing_count(tmp_path, monkeypatch, name):
    file = text(tmp_path / name, end=",,\n" * 1000)
    monkeypatch.setenv("THERMOSCOPE_MOST_ROWS", "500")
    with pytest.raises(InputError, match="limit 'rows'"):
        read_source(file)


def test_seconds_of_reading_are_bounded(tmp_path, monkeypatch):
    instants = iter(range(0, 10**6, 1000))
    monkeypatch.setattr("geom.limits.time.monotonic", lambda: next(instants))
    with pytest.raises(InputError, match="limit 'seconds'"):
        read_recording(text(tmp_path / "a.csv"))


MEASURED = """
import sys
from pathlib import Path
from geom.errors import InputError
from measured.importing.source import read_source
try:
    print(read_source(Path(sys.argv[1])).rows)
except InputError as fault:
    print(fault)
status = Path("/proc/self/status").read_text()  # ru_maxrss would begin at that of the process that started this one
print(int(status.partition("VmHWM:")[2].split()[0]) // 1024)
"""


def measured_MB(file):
    """What reading a file said, and the most memory it took (MB)."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("THERMOSCOPE_MOST")}
    done = subprocess.run([sys.executable, "-c", MEASURED, file], capture_output=True, text=True, env=environment)
    said, memory_MB = done.stdout.splitlines()
    return said, int(memory_MB)


@pytest.mark.skipif(sys.platform != "linux", reason="memory of a process is counted differently elsewhere")
@pytest.mark.parametrize(
    ("cell", "word"),
    [("XFD1048576", "limit 'columns'"), ("ALL1048576", "limit 'cells'"), ("B1048576", str(len(ROWS) + 1))],
)
def test_a_cell_far_away_takes_no_memory(tmp_path, cell, word):
    """Filled up, that would be up to 17 billion cells; a few columns wide it is one more row."""
    file = book(tmp_path / "a.xlsx", **{cell: 1.0})
    said, memory_MB = measured_MB(file)
    assert word in said
    assert memory_MB < MEMORY_MB


@pytest.mark.nightly
def test_a_text_is_never_in_memory_whole(tmp_path):
    """A million short lines, of which each alone takes 60 bytes: 16 MB of numbers, and the packages."""
    (tmp_path / "a.txt").write_text("t (s);T \u03a9 (\xb0C)\n" + "".join(f"{k};20,5\n" for k in range(10**6)))
    said, memory_MB = measured_MB(tmp_path / "a.txt")
    assert said == "1000000"
    assert memory_MB < 130


def test_long_words_are_not_read_letter_by_letter(tmp_path):
    """A thousand cells of one long text, in a file of some kB: its letters are looked at a few times in all."""
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    zeros, text = pyarrow.array([0] * 1000, pyarrow.int8()), pyarrow.array(["x" * 4 * 10**6])
    columns = {"time_s": [*map(float, range(1000))], "T": [20.0] * 1000}
    words = pyarrow.DictionaryArray.from_arrays(zeros, text)
    parquet.write_table(pyarrow.table({**columns, "note": words}), tmp_path / "a.parquet")
    source = read_source(tmp_path / "a.parquet")
    begin = time.process_time()
    assert not source.is_numeric("note")
    assert time.process_time() - begin < 1.0  # s; 4 where each letter is looked at


def spoilt(path, part, change):
    """A workbook of which one part is another."""
    with zipfile.ZipFile(book(path.with_name("plain.xlsx"))) as plain, zipfile.ZipFile(path, "w", 8) as out:
        for name in plain.namelist():
            out.writestr(name, change(plain.read(name)) if name == part else plain.read(name))
    return path


SHEET, DEEP, MANY = "xl/worksheets/sheet1.xml", 200_000, 5_100_000
LAUGH = b"".join(b'<!ENTITY a%d "%s">' % (i + 1, b"&a%d;" % i * 10) for i in range(9))
LAUGH = b'<!DOCTYPE x [<!ENTITY a0 "hahahahahaha">' + LAUGH + b"]>"
SPOILT = {
    "entities": (SHEET, lambda d: LAUGH + d.replace(b"<v>20</v>", b"<v>&a9;</v>", 1), "amplification"),
    "rows in rows": (
        SHEET,
        lambda d: d.replace(b"</sheetData>", b"<row>" * DEEP + b"</row>" * DEEP + b"</sheetData>"),
        "without end",
    ),
    "millions of empty rows": (  # of a sheet that claims no size
        SHEET,
        lambda d: re.sub(rb"<dimension[^>]*>", b"", d).replace(
            b"</sheetData>", b"<row/>" * 4_000_000 + b"</sheetData>"
        ),
        "more than 1,048,576 rows",
    ),
    "elements that nobody knows": (
        SHEET,
        lambda d: d.replace(b"</sheetData>", b"<a/>" * MANY + b"</sheetData>"),
        "limit 'rows'",
    ),
    "styles": ("xl/styles.xml", lambda d: d.replace(b"<xf ", b"<xf /><xf ", 1) + b" " * 2**24, "limit 'part_bytes'"),
}


@pytest.mark.skipif(sys.platform != "linux", reason="memory of a process is counted differently elsewhere")
@pytest.mark.parametrize("kind", SPOILT)
def test_parts_of_a_workbook_that_grow_take_no_memory(tmp_path, kind):
    part, change, words = SPOILT[kind]
    said, memory_MB = measured_MB(spoilt(tmp_path / "a.xlsx", part, change))
    assert words in said
    assert memory_MB < MEMORY_MB


def test_sheets_of_one_part_are_read_once(tmp_path):
    def many(content):
        sheet = re.search(rb"<sheet [^>]*/>", content)[0]
        return content.replace(sheet, b"".join(sheet.replace(b'"Sheet"', b'"s%d"' % k) for k in range(2000)))

    assert read_source(spoilt(tmp_path / "a.xlsx", "xl/workbook.xml", many)).rows == len(ROWS)


def test_blocks_of_an_mf4_that_follow_each_other_in_a_circle(tmp_path):
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF() as mdf:
        mdf.append([asammdf.Signal([20.0, 21.0, 22.0], [0.0, 1.0, 2.0], name="T_winding", unit="degC")])
        file = Path(mdf.save(tmp_path / "a.mf4"))
    content = bytearray(file.read_bytes())
    for kind in (b"##DG", b"##CN"):
        at, spoilt_content = content.find(kind), content.copy()
        struct.pack_into("<Q", spoilt_content, at + 24, at)
        file.write_bytes(spoilt_content)
        with pytest.raises(InputError, match=f"{kind.decode()} at byte {at} comes twice"):
            read_recording(file)


def test_limits_of_meshes_and_step_files(tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_MOST_MESH_POINTS", "50")
    with pytest.raises(InputError, match="limit 'mesh_points'"):
        build_mesh(load_machine("tefc-industrial"), **COARSE)
    monkeypatch.setenv("THERMOSCOPE_MOST_STEP_BYTES", "10")
    file = tmp_path / "wire.step"
    file.write_text("ISO-10303-21;")
    with pytest.raises(InputError, match="limit 'step_bytes'"):
        import_step(file)


@pytest.mark.nightly
def test_a_wire_of_a_kilometre_is_refused_before_it_is_meshed(tmp_path):
    import cadquery as cq

    ring, wire = cq.Workplane().circle(50).circle(40).extrude(100), cq.Workplane().circle(0.5).extrude(1e6)
    cq.Assembly().add(ring, name="housing").add(wire, name="wire").export(str(tmp_path / "motor.step"))
    (tmp_path / "motor.step.toml").write_text('[materials]\nhousing = "aluminium-cast"\nwire = "copper"\n')
    with pytest.raises(InputError, match="limit 'mesh_points'"):
        build_mesh(import_step(tmp_path / "motor.step"))


def test_a_limit_that_is_no_number_is_said(monkeypatch):
    for limit in LIMITS:
        monkeypatch.setenv(limit.variable, "many")
        with pytest.raises(InputError, match=limit.variable):
            limit.check(1.0, "here")
