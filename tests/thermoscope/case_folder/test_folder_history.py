"""model.toml: what is written comes back, revisions are only added, and a broken file is refused."""

import errno
import os
import sys
from pathlib import Path

import pytest

from geom.errors import InputError
from geom.storage import write_whole
from lumped.model.network import Parameter
from thermoscope.case_folder.history import History, Revision, checked_values, load_history, save_history

FIRST = Revision(0, "calibrate", values={"link.a": 1.25}, intervals={"link.a": (1.0, 1.5)}, rmse_K={"t": (3.0, 2.0)})
SECOND = Revision(
    0,
    "add",
    ("convection@flange",),
    "convection@flange",
    {"link.a": 1.1, "convection@flange": 12.5},
    rmse_K={"t": (2.0, 0.5)},
    why="error on tests not fitted 2 -> 0.5 K",
    evidence={"score": 8.1},
)


def test_round_trip(tmp_path):
    history = History().and_then(FIRST).and_then(SECOND)
    again = save_history(tmp_path / "model.toml", history, History())
    assert again == history
    assert [r.number for r in again.revisions] == [1, 2]


def test_step_back_adds_a_revision():
    history = History().and_then(FIRST).and_then(SECOND).back_to(1)
    assert history.last.number == 3
    assert history.last.values == FIRST.values
    assert history.last.effects == ()
    assert history.last.rmse_K == {"t": (0.5, 2.0)}


def test_unknown_revision():
    with pytest.raises(InputError, match="no revision 7"):
        History().and_then(FIRST).back_to(7)


def test_a_file_cut_at_the_end_of_any_line_is_refused(tmp_path):
    path = tmp_path / "model.toml"
    save_history(path, History().and_then(FIRST).and_then(SECOND), History())
    lines = path.read_text().splitlines(keepends=True)
    for count in range(len(lines)):
        path.write_text("".join(lines[:count]))
        with pytest.raises(InputError):
            load_history(path)
    path.write_text("".join(lines))
    assert load_history(path).last.number == 2
    path.write_text("".join(lines[1:]).replace("\n", "\r\n"))  # of an older version, by another system
    assert load_history(path).last.number == 2


def test_a_value_of_nothing_is_out_of_the_bounds_of_a_factor():
    parameter = Parameter("link.a", (("link:a", 1.0),))
    for value in (0.0, 1e-300, 0.99 * parameter.low):
        with pytest.raises(InputError, match="out of its bounds"):
            checked_values(Revision(1, "calibrate", values={"link.a": value}), [parameter], "model.toml")
    checked_values(Revision(1, "calibrate", values={"link.a": parameter.low * (1 - 1e-9)}), [parameter], "model.toml")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "cut off"),
        ("[[revision]]\nnumber = 1\naction = 'guess'\n", "guess"),
        ("[[revision]]\nnumber = 1\naction = 'add'\nvalue = 3\n", "did you mean 'values'"),
    ],
)
def test_broken_file(tmp_path, text, words):
    path = tmp_path / "model.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        load_history(path)


def test_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    path = write_whole(tmp_path / "model.toml", "old")

    def broken(*_):
        raise OSError(errno.ENOSPC, "disk full")

    monkeypatch.setattr("os.replace", broken)
    with pytest.raises(InputError, match="disk full"):
        write_whole(path, "new")
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["model.toml"]


@pytest.mark.skipif(sys.platform != "linux", reason="asks /proc which file it is")
def test_a_file_is_on_the_disk_before_it_takes_its_place(tmp_path, monkeypatch):
    """A power cut leaves the old file or the new one: content synced, file renamed, folder synced."""
    done, fsync, replace = [], os.fsync, Path.replace

    def synced(handle):
        done.append(os.readlink(f"/proc/self/fd/{handle}"))
        fsync(handle)

    def renamed(path, target):
        done.append("renamed")
        return replace(path, target)

    monkeypatch.setattr("os.fsync", synced)
    monkeypatch.setattr(Path, "replace", renamed)
    write_whole(tmp_path / "model.toml", "new")
    content, rename, folder = done
    assert ".part" in content
    assert (rename, folder) == ("renamed", str(tmp_path))
