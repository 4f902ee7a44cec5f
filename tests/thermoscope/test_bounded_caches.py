"""What is kept by content is bounded: what was not used for longest goes first, and what is in use stays."""

import os

import pytest

from thermoscope import caches
from thermoscope.caches import recalled_result, store_result


@pytest.fixture
def few(monkeypatch):
    monkeypatch.setattr(caches, "MOST_FILES", 3)
    monkeypatch.setattr(caches, "MOST_BYTES", 100)


def stored(folder, key, content="x", kind="viewer"):
    """A result whose last use was `key` seconds after the first."""
    file = folder / f"{kind}-{key}.json"
    store_result(file, content, kind)
    os.utime(file, (key, key))
    return file


def left(folder):
    return sorted(path.name for path in folder.iterdir())


def test_the_last_used_ones_stay(tmp_path, few):
    for key in range(1, 6):
        stored(tmp_path, key)
    assert left(tmp_path) == ["viewer-3.json", "viewer-4.json", "viewer-5.json"]


def test_reading_counts_as_use(tmp_path, few):
    files = [stored(tmp_path, key) for key in range(1, 4)]
    assert recalled_result(files[0], lambda path: path.read_text()) == "x"
    stored(tmp_path, 4)
    assert left(tmp_path) == ["viewer-1.json", "viewer-3.json", "viewer-4.json"]


def test_all_of_a_kind_together_take_no_more_than_their_share(tmp_path, few):
    for key in range(1, 4):
        stored(tmp_path, key, "x" * 40)
    assert left(tmp_path) == ["viewer-2.json", "viewer-3.json"]


def test_a_result_that_is_larger_than_all_that_is_allowed_is_kept_alone(tmp_path, few):
    for key in range(1, 3):
        stored(tmp_path, key)
    stored(tmp_path, 3, "x" * 1000)
    assert left(tmp_path) == ["viewer-3.json"]


def test_other_kinds_are_left_alone(tmp_path, few):
    for kind in ("mesh", "comparison", "range"):
        for key in range(1, 4):
            stored(tmp_path, key, kind=kind)
    (tmp_path / "stages.json").write_text("{}")
    for key in range(1, 6):
        stored(tmp_path, key)
    assert len(left(tmp_path)) == 3 * 3 + 1 + 3


def test_what_cannot_be_read_is_no_result(tmp_path):
    assert recalled_result(tmp_path / "viewer-1.json", lambda path: path.read_text()) is None
    assert recalled_result(stored(tmp_path, 1), lambda path: int(path.read_text())) is None


def test_what_another_process_drops_first_is_no_fault(tmp_path, few, monkeypatch):
    for key in range(1, 4):
        stored(tmp_path, key)
    listed = caches._last_used

    def late(file, kind):
        entries = listed(file, kind)
        (tmp_path / "viewer-1.json").unlink()
        return entries

    monkeypatch.setattr(caches, "_last_used", late)
    stored(tmp_path, 4)
    assert left(tmp_path) == ["viewer-2.json", "viewer-3.json", "viewer-4.json"]
