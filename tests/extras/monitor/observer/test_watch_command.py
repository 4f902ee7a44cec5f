"""thermoscope use watch: rows from a file and from a pipe; what is wrong with them is one message."""

import json
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from command_line import RUN
from small_case import HEADER, measured, small_case, write_csv

BOTH = ("--sensor", "T_winding", "--sensor", "T_yoke")


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return small_case(tmp_path_factory.mktemp("watch"), strength=0.0)


@pytest.fixture(scope="module")
def rows(case):
    file = case.parent / "live.csv"
    write_csv(file, measured(7, False, 0.0, step=2.0))
    return file


@pytest.fixture(scope="module")
def document(thermoscope, case, rows):
    done = thermoscope("use", "watch", case, "--follow", rows, *BOTH, "--json", "-", cwd=case.parent)
    assert done.code == 0, done.err
    return done.document


def test_the_document_says_what_was_estimated(case, rows, document):
    assert document["case"] == "three"
    assert document["like"] == "stand"
    assert document["samples"] == 1500
    assert [(s["sensor"], s["given"]) for s in document["sensors"]] == [
        ("T_winding", True),
        ("T_yoke", True),
        ("T_flange", False),
    ]
    last = np.loadtxt(rows, delimiter=",", skiprows=1)[-1]
    winding = next(p for p in document["places"] if p["place"] == "winding")
    assert abs(winding["end_C"] - last[4]) < 0.5
    assert {h["place"] for h in document["missing_heat"]} == {"winding", "yoke", "flange"}
    assert document["events"] == []
    assert document["withheld"][0]["sensor"] == "T_flange"
    assert document["withheld"][0]["rmse_K"] < 1.0
    table = np.genfromtxt(case.parent / document["file"], delimiter=",", names=True)
    assert table.size == 1500


@pytest.mark.heavy
def test_a_pipe_gives_what_the_file_gives(case, rows, document):
    """A line a minute, and the same temperatures."""
    words = ["use", "watch", case, "--follow", "-", *BOTH, "--json", "pipe.json"]
    command = [sys.executable, "-c", RUN, *map(str, words)]
    done = subprocess.run(command, cwd=case.parent, input=rows.read_text(), capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert sum(" min  winding " in line for line in done.stdout.splitlines()) == 50
    piped = json.loads((case.parent / "pipe.json").read_text())
    for a, b in zip(piped["places"], document["places"], strict=True):
        assert abs(a["end_C"] - b["end_C"]) < 0.01


BAD = {
    "no column": (HEADER.replace("current", "amps") + "\n0,1,2,3,4,5,6\n", "column 'current' is not in the header"),
    "a word": (f"{HEADER}\n0,1,0,20,20,293,20\n1,one,0,20,20,293,20\n", "'one' is not a number"),
    "time": (f"{HEADER}\n0,1,0,20,20,293,20\n0,1,0,20,20,293,20\n", "time 0 does not come after the one before"),
    "begins": (f"{HEADER}\n0,,0,20,20,293,20\n", "column 'current' begins with no number"),
    "empty": ("", "holds no row"),
    "header alone": (HEADER + "\n", "holds no row"),
    "sensors": ("time_s,current,air\n0,1,20\n", "no sensor of the machine"),
}


@pytest.mark.parametrize("kind", BAD)
def test_wrong_rows_are_one_message(thermoscope, case, tmp_path, kind):
    text, message = BAD[kind]
    (tmp_path / "live.csv").write_text(text)
    done = thermoscope("use", "watch", case, "--follow", "live.csv", cwd=tmp_path)
    assert done.code == 2
    assert message in done.err
    assert done.err.count("error:") == 1
    assert not list(tmp_path.glob("**/watch-*"))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["watch", "{case}", "--follow", "nothing.csv"], "no such file"),
        (["watch", "{case}", "--follow", "{rows}", "--sensor", "T_rotor"], "no sensor 'T_rotor'"),
        (["watch", "{case}", "--follow", "{rows}", "--like", "moon"], "no test 'moon'"),
        (["export", "{case}", "--as", "c", "--sensor", "T_yoke", "--out", "c"], "--as c has no sensors"),
        (["export", "{case}", "--as", "observer", "--sensor", "T_rotor", "--out", "c"], "no sensor 'T_rotor'"),
    ],
)
def test_wrong_options_are_one_message(thermoscope, case, rows, tmp_path, words, message):
    done = thermoscope("use", *(o.format(case=case, rows=rows) for o in words), cwd=tmp_path)
    assert (done.code, done.err.count("error:")) == (2, 1)
    assert message in done.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("ending", "write"), [("xlsx", "to_excel"), ("parquet", "to_parquet"), ("csv.gz", "to_csv")])
def test_rows_of_every_format_are_read(thermoscope, case, rows, tmp_path, ending, write):
    """Packed, and with instants among them, as a workbook has them."""
    table = pd.read_csv(rows).head(59)
    if ending != "csv.gz":
        table["time_s"] = pd.Timestamp("2026-03-28 12:00") + pd.to_timedelta(table["time_s"], unit="s")
    file = tmp_path / f"live.{ending}"
    getattr(table, write)(file, index=False)
    (tmp_path / "live.log").write_text("\n".join(rows.read_text().splitlines()[:60]))
    done, plain = (
        thermoscope("use", "watch", case, "--follow", name, "--json", "-", cwd=tmp_path) for name in (file, "live.log")
    )
    assert done.code == plain.code == 0, done.err
    assert done.document["samples"] == 59
    assert done.document["duration_s"] == pytest.approx(plain.document["duration_s"])
    for a, b in zip(done.document["places"], plain.document["places"], strict=True):
        assert a["end_C"] == pytest.approx(b["end_C"], abs=0.01)


def test_an_exported_observer_says_what_it_takes(thermoscope, case, tmp_path):
    words = ["--as", "observer", *BOTH, "--out", tmp_path, "--json", "-"]
    done = thermoscope("use", "export", case, *words, cwd=tmp_path)
    assert done.code == 0, done.err
    assert done.document["sensors"] == ["T_winding", "T_yoke"]
    assert done.document["inputs"] == ["current_A", "ambient"]
    assert done.document["state_bytes"] < 10_000
    assert "Sensors y (degC, NAN" in (tmp_path / "thermal_observer_sizes.h").read_text()


def test_cells_that_say_that_nothing_was_read_are_empty_as_in_a_test(thermoscope, case, rows, tmp_path):
    header, *lines = rows.read_text().splitlines()[:60]
    at = header.split(",").index("T_winding")
    cells = [line.split(",") for line in lines]
    for row, word in zip(cells[5:9], ("n/a", "NaN", "#N/A", ""), strict=True):
        row[at] = word
    (tmp_path / "live.csv").write_text("\n".join([header, *map(",".join, cells)]))
    done = thermoscope("use", "watch", case, "--follow", "live.csv", "--json", "-", cwd=tmp_path)
    assert done.code == 0, done.err
    assert done.document["samples"] == 59


def test_a_recorders_own_file_is_read_as_new_reads_it(thermoscope, case, rows, tmp_path):
    """Semicolons, decimal commas, a clock of its own, under the names that the sheet knows."""
    header, *lines = rows.read_text().splitlines()[:60]
    other = header.replace("time_s", "Zeit (s)").replace(",", ";")
    (tmp_path / "raw.csv").write_text("\n".join([other, *(x.replace(",", ";").replace(".", ",") for x in lines)]))
    (tmp_path / "plain.csv").write_text("\n".join([header, *lines]))
    raw, plain = (
        thermoscope("use", "watch", case, "--follow", f"{name}.csv", "--json", "-", cwd=tmp_path)
        for name in ("raw", "plain")
    )
    assert raw.code == plain.code == 0, raw.err
    assert raw.document["places"] == plain.document["places"]


def test_a_sensor_that_dies_is_not_called_lost_before(thermoscope, case, rows, tmp_path):
    """Rows of a file are read many at once; each minute says what stood then."""
    header, *lines = rows.read_text().splitlines()[:400]  # 2 s apart
    at = header.split(",").index("T_winding")
    cells = [[c if i < 200 or j != at else "" for j, c in enumerate(x.split(","))] for i, x in enumerate(lines)]
    (tmp_path / "live.csv").write_text("\n".join([header, *map(",".join, cells)]))
    done = thermoscope("use", "watch", case, "--follow", "live.csv", cwd=tmp_path)
    minutes = " ".join(done.out.partition("watched;")[0].split()).split(" min ")[1:]
    lost = ["T_winding lost" in line for line in minutes]
    assert lost == [60 * k > 200 * 2 + 30 for k in range(len(minutes))], "after half a minute without a reading"


def as_recorded(header, lines):
    """A preamble, semicolons, decimal commas, a row of units, a clock of its own with a unit."""
    cells = [line.split(",") for line in lines]
    minutes = [f"{float(row[0]) / 60:.6f}" for row in cells]
    rows = [";".join([t, *row[1:]]).replace(".", ",") for t, row in zip(minutes, cells, strict=True)]
    names = header.replace("time_s", "Zeit").replace(",", ";")
    units = ";".join(["min", *[""] * header.count(",")])
    return "\n".join(["Logger 7;serial 1234", "", names, units, *rows]) + "\n"


def piped(case, text, tmp_path):
    words = ["use", "watch", case, "--follow", "-", "--json", "pipe.json"]
    command = [sys.executable, "-c", RUN, *map(str, words)]
    done = subprocess.run(command, cwd=tmp_path, input=text, capture_output=True, timeout=120)
    file = tmp_path / "pipe.json"
    return done.returncode, done.stderr.decode(), json.loads(file.read_text()) if file.exists() else None


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252"])
def test_a_pipe_is_read_as_a_file_of_the_same_recorder(thermoscope, case, rows, tmp_path, encoding):
    header, *lines = rows.read_text().splitlines()[:60]
    text = as_recorded(header, lines).replace("Logger 7", "Gerät 7 [°C]").encode(encoding)
    (tmp_path / "raw.csv").write_bytes(text)
    plain = thermoscope("use", "watch", case, "--follow", "raw.csv", "--json", "-", cwd=tmp_path)
    code, said, document = piped(case, text, tmp_path)
    assert plain.code == code == 0, said
    assert document["samples"] == plain.document["samples"] == 59
    for a, b in zip(document["places"], plain.document["places"], strict=True):
        assert a["end_C"] == pytest.approx(b["end_C"], abs=1e-3)


UNREADABLE = {
    "decimal commas": ("0,1,0,20,20,293,20\n1,0,20,0,20,0,20,0,293,0\n", "10 values under 7 names"),
    "a row cut off": ("0,1,0,20,20,293,20\n1,0,20\n", "the row was cut off"),
    "zeros": ("0,1,0,20,20,293,20\n\0\n", "zero bytes"),
}


@pytest.mark.parametrize("kind", UNREADABLE)
def test_a_pipe_that_would_be_misread_is_one_message(case, tmp_path, kind):
    text, message = UNREADABLE[kind]
    code, said, _ = piped(case, f"{HEADER}\n{text}".encode(), tmp_path)
    assert (code, said.count("error:")) == (2, 1), said
    assert message in " ".join(said.split())


def test_a_recorders_own_file_without_a_clock_is_refused(thermoscope, case, rows, tmp_path):
    """Its rows were taken as 1 s apart, in silence."""
    lines = [line.replace(",", ";").partition(";")[2] for line in rows.read_text().splitlines()[:60]]
    (tmp_path / "raw.csv").write_text("\n".join(lines))
    done = thermoscope("use", "watch", case, "--follow", "raw.csv", cwd=tmp_path)
    assert (done.code, done.err.count("error:")) == (2, 1)
