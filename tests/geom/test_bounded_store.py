"""The store of results is bounded: what was not used for longest goes first; what is not its own is left alone."""

import json
import os

import pytest

from geom import disk_cache
from geom.disk_cache import empty, recalled, store

KEY = "0123456789abcdef"


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_MOST_CACHE_BYTES", "100")


def kept(folder, number, size=30, kind="viewer"):
    """An entry whose last use was `number` seconds after the first."""
    file = folder / f"{kind}-{KEY}{number:04d}.json"
    store(file, "x" * size)
    os.utime(file, (number, number))
    return file


def left(folder):
    return sorted(path.name for path in folder.iterdir())


def numbers(folder):
    return [int(name[-9:-5]) for name in left(folder) if KEY in name]


def test_the_last_used_of_all_kinds_stay(tmp_path, small):
    kinds = ["mesh", "comparison", "belief-2"]
    for number in range(1, 6):
        kept(tmp_path, number, kind=kinds[number % len(kinds)])
    assert sorted(numbers(tmp_path)) == [3, 4, 5]


def test_reading_counts_as_use(tmp_path, small):
    files = [kept(tmp_path, number) for number in range(1, 4)]
    assert recalled(files[0], lambda path: path.read_text()) == "x" * 30
    kept(tmp_path, 4)
    assert numbers(tmp_path) == [1, 3, 4]


def test_other_files_and_folders_are_left_alone(tmp_path, small):
    others = ["notes.json", "thesis-final.npz", "new.0123", f"viewer-{KEY}.txt", f".{KEY}.json"]
    for name in others:
        (tmp_path / name).write_text("z" * 500)
    (tmp_path / f"mesh-{KEY}.npz").mkdir()
    for number in range(1, 6):
        kept(tmp_path, number)
    assert len(empty(tmp_path)) == 2
    assert left(tmp_path) == sorted([*others, f"mesh-{KEY}.npz"])


def test_what_cannot_be_read_is_no_result_and_is_made_anew(tmp_path):
    assert recalled(tmp_path / "viewer-1.json", lambda path: path.read_text()) is None
    file = kept(tmp_path, 1)
    assert recalled(file, lambda path: int(path.read_text())) is None
    store(file, "7")
    assert recalled(file, lambda path: int(path.read_text())) == 7


def test_what_another_process_drops_first_is_no_fault(tmp_path, small, monkeypatch):
    listed = disk_cache.entries

    def late(folder):
        out = listed(folder)
        (tmp_path / f"viewer-{KEY}0001.json").unlink(missing_ok=True)
        return out

    kept(tmp_path, 1)
    monkeypatch.setattr(disk_cache, "entries", late)
    for number in range(2, 5):
        kept(tmp_path, number)
    assert numbers(tmp_path) == [2, 3, 4]


def test_what_a_killed_process_began_goes_after_a_day(tmp_path):
    begun = [tmp_path / f".viewer-{KEY}.{letter * 32}.part.json" for letter in "ab"]
    for file in begun:
        file.write_text("half")
    os.utime(begun[0], (1, 1))
    assert empty(tmp_path) == (1, 4)
    assert not begun[0].exists()
    assert begun[1].exists()


def test_check_clean_empties_it_and_says_what_was_freed(thermoscope, tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))
    for number in range(1, 4):
        kept(tmp_path, number, 500_000)
    (tmp_path / "mine.txt").write_text("stays")
    done = thermoscope("check", "--clean", "--json", tmp_path / "freed.json")
    assert (done.code, " ".join(done.out.split())) == (0, f"Freed 1.5 MB: 3 files in {tmp_path}.")
    freed = json.loads((tmp_path / "freed.json").read_text())
    assert freed == {"cleaned": {"folder": str(tmp_path), "files": 3, "bytes": 1_500_000}}
    assert left(tmp_path) == ["freed.json", "mine.txt"]
    assert "Freed 0.0 MB: 0 files" in thermoscope("check", "--clean").out
