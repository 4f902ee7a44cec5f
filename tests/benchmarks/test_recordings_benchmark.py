"""Recordings from raw file to last improvement: what is kept back, and what the table says."""

import numpy as np
import pytest
import recordings as bench


def test_of_a_single_file_the_last_third_of_its_rows_is_kept_back(tmp_path):
    rows = [f"{i},{20 + i}" for i in range(300)]
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "log.csv").write_text("\n".join(["time_s,T", *rows]) + "\n")
    (source,) = bench.of_folder(tmp_path, tmp_path / "scratch")
    assert (source.name, source.kept) == ("one", ("last",))
    text = [f.read_text().splitlines() for f in source.files]
    assert all(lines[0] == "time_s,T" for lines in text)
    assert [line for lines in text for line in lines[1:]] == rows


def test_of_files_alike_a_third_is_kept_back_and_others_are_a_recording_of_their_own(tmp_path):
    (tmp_path / "two").mkdir()
    for name in "abcdef":
        (tmp_path / "two" / f"{name}.csv").write_text("time_s,T\n0,20\n")
    (tmp_path / "two" / "short.csv").write_text("time_s,other\n0,20\n")
    (source,) = bench.of_folder(tmp_path, tmp_path / "scratch")
    assert (len(source.files), source.kept) == (6, ("c", "f"))


def test_the_table_holds_the_last_step_against_the_best_yardstick():
    yards = {"persistence": 12.0, "black_box": 3.0, "free_network": 2.0}
    good = bench.Row("good", 4, 1, 2, yards, [("start", 9.0), ("calibrate", 4.0), ("wind@a|b", 2.2)], 2.0, cpu_s=61.4)
    none = bench.Row("none", fault="no column is a temperature")
    assert np.allclose(good.ratios, (1.1, 1.0))
    assert np.isnan(none.ratios).all()
    lines = bench.recordings_table([good, none]).splitlines()
    cells = [c.strip() for c in lines[2].replace("\\|", "/").strip("|").split("|")]
    assert cells[:9] == ["good", "4 (1)", "12.00", "3.00", "2.00", "", "", "4.00", "**2.20**"]
    assert cells[9:] == ["**2.00**", "1.10 / 1.00", "wind@a/b", "61"]
    assert lines[-1] == "none: no column is a temperature"
    assert "median 1.10 / 1.00, worst 1.10 / 1.00 of 1" in lines[-3]


@pytest.mark.parametrize(("name", "published"), [("hust", "9.00"), ("tclab", "")])
def test_the_model_of_the_authors_is_told_where_the_case_declares_it(name, published):
    yards = {"persistence": 12.0, "black_box": 3.0, "free_network": 2.0}
    row = bench.Row(name, 4, 1, 2, yards, [("start", 9.0), ("calibrate", 4.0)], 4.0, published=True)
    head, _, cells = (line.split("|")[1:-1] for line in bench.recordings_table([row]).splitlines()[:3])
    told = dict(zip(map(str.strip, head), map(str.strip, cells), strict=True))
    assert (told["published"], told["declared"]) == (published, "9.00")
    assert {*bench.AUTHORS} <= {s.case.partition("-")[0] for s in bench.shipped()}


@pytest.mark.parametrize("page", bench.PAGES, ids=lambda p: p.name)
def test_the_pages_tell_what_the_front_page_says_of_the_published_model(page):
    lines = [
        line.split("|")[1:-1]
        for line in page.read_text().splitlines()
        if line.startswith(("| recording |", "| hust |"))
    ]
    told = dict(zip(map(str.strip, lines[0]), map(str.strip, lines[1]), strict=False))
    front = next(line for line in bench.PAGES[1].read_text().splitlines() if line.startswith("| published |"))
    assert told["published"] == front.split("|")[5].strip()


def test_the_shipped_recordings_keep_back_the_profiles_of_the_paper():
    raw = next(s for s in bench.shipped() if s.files)
    assert {f.name.partition(".")[0] for f in raw.files} >= set(raw.kept)
    assert len(raw.files) == 12


def test_no_test_that_is_kept_back_teaches_the_first_network(tmp_path, monkeypatch):
    """The files are the two heaters' recordings; what is learnt from is what is imported first."""
    imports = []

    def new_case(source, files, folder, more=()):
        imports.append(([f.name for f in files], list(more)))
        (folder / "tests").mkdir(parents=True)
        (folder / "tests" / "a.toml").write_text('[columns.T1]\nplace = "part-1"\n[columns.u]\ninput = "u"\n')
        (folder / "case.toml").write_text('[tests.a]\nrole = "x"\n\n[tests.b]\nrole = "x"\n\n[tests.c]\nrole = "x"\n')

    monkeypatch.setattr(bench, "new_case", new_case)
    files = tuple(tmp_path / f"{name}.csv" for name in "abc")
    folder = bench.imported(bench.Source("three", files, kept=("b",)), tmp_path)
    network = str(tmp_path / "taught-three" / "network.toml")
    assert imports == [
        (["a.csv", "c.csv"], []),
        (["a.csv", "b.csv", "c.csv"], ["--network", network, "--place=T1=part-1"]),
    ]
    roles = [line for line in (folder / "case.toml").read_text().splitlines() if line.startswith("role")]
    assert roles == ['role = "calibrate"', 'role = "hold-out"', 'role = "validate"']
    bench.imported(bench.Source("last", files, kept=("c",)), tmp_path)
    assert imports[2:] == [(["a.csv", "b.csv", "c.csv"], [])]  # it holds out the last by itself
