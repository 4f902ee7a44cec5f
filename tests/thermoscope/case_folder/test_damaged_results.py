"""Damaged files in out/ and in the cache: made again, or one message with file and cure; no traceback, no block."""

import os
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest
from command_line import answered
from small_case import small_case

from geom.disk_cache import recalled
from geom.storage import cache_folder
from lumped.condensation.basis_cache import BasisCache, Centre
from measured.importing.case_files import folder_whole

pytestmark = pytest.mark.nightly


def folder(file):
    file.unlink()
    file.mkdir()
    (file / "a.txt").write_text("something")


def loop(file):
    file.unlink()
    file.symlink_to(file)


def pipe(file):
    file.unlink()
    os.mkfifo(file)


def cut(file):
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


BYTES = {
    "empty": lambda file: file.write_bytes(b""),
    "truncated": cut,
    "random": lambda file: file.write_bytes(np.random.default_rng(0).bytes(4096)),
    "another document": lambda file: file.write_text('{"fingerprint": 3, "values": [1]}'),
    "nested": lambda file: file.write_text("[" * 100000),
}
PLACES = {"folder": folder, "loop": loop, "pipe": pipe}
READERS = [("diagnosis.json", "answer {case} yes"), ("calibration.json", "calibrate {case} --anyway")]
SLOW = ("diagnosis.json", "report {case}")


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    """A case that was calibrated and diagnosed, and whose next calibration was interrupted."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(tmp_path_factory.mktemp("cache")))
        patch.setattr("viz.write_pdf", lambda page: None)  # a browser reads the page, nothing of out/
        case = small_case(tmp_path_factory.mktemp("original"))
        answered("calibrate", case, "--anyway")
        answered("diagnose", case)
        shutil.copy(case / "out/diagnosis.json", case / "out/calibration.json")
        yield case


@pytest.mark.parametrize(
    ("name", "words", "damage"), [*((*reader, damage) for reader in READERS for damage in BYTES.values()), (*SLOW, cut)]
)
def test_damaged_bytes_are_said_and_not_used(original, tmp_path, name, words, damage):
    case = shutil.copytree(original, tmp_path / "case")
    damage(case / "out" / name)
    done = answered(*words.format(case=case).split())
    assert f"{name} is damaged and is not used" in done.err
    asks = words.startswith("answer")  # it needs a diagnosis: told to make one
    assert (done.code, len(done.errors)) == ((2, 1) if asks else (0, 0))
    assert not asks or "diagnose first" in done.errors[0]


@pytest.mark.parametrize("damage", PLACES.values(), ids=PLACES)
@pytest.mark.parametrize(("name", "words"), READERS)
def test_what_is_no_file_is_named_with_its_cure(original, tmp_path, name, words, damage):
    case = shutil.copytree(original, tmp_path / "case")
    damage(case / "out" / name)
    before = (case / "model.toml").read_bytes()
    done = answered(*words.format(case=case).split())
    assert (done.code, len(done.errors)) == (2, 1)
    assert str(case / "out" / name) in done.errors[0]
    assert "delete it" in done.errors[0]
    assert (case / "model.toml").read_bytes() == before


WRITTEN = {
    "simulate {case}": "simulate-stand.csv",
    "export {case}": "case.xlsx",
    "report {case}": "report.html",
    "export {case} --as c": "c/thermal_network.c",
}


@pytest.mark.parametrize("words", WRITTEN)
def test_results_go_over_damaged_ones_and_not_over_folders(original, tmp_path, words):
    case = shutil.copytree(original, tmp_path / "case")
    file = case / "out" / WRITTEN[words]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(b"\xff\x00damaged")
    command = words.format(case=case).split()
    assert answered(*command).code == 0
    assert b"damaged" not in file.read_bytes()[:10]
    folder(file)
    done = answered(*command)
    assert (done.code, len(done.errors)) == (2, 1)
    assert str(file) in done.errors[0]
    assert (file / "a.txt").exists()


@pytest.mark.parametrize("damage", BYTES.values(), ids=BYTES)
def test_a_damaged_cache_is_made_again(original, tmp_path, monkeypatch, damage):
    """What calibration left unsure, which `simulate` draws its bands from."""
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path / "cache"))
    case = shutil.copytree(original, tmp_path / "case")
    assert answered("simulate", case).code == 0
    (kept,) = cache_folder().glob("belief-*.npz")
    sound = kept.read_bytes()
    damage(kept)
    assert answered("simulate", case).code == 0
    assert np.load(kept)["covariance"].shape == np.load(_file(tmp_path, sound))["covariance"].shape


def _file(tmp_path, content):
    (tmp_path / "sound.npz").write_bytes(content)
    return tmp_path / "sound.npz"


@pytest.mark.parametrize("damage", BYTES.values(), ids=BYTES)
def test_damaged_shapes_are_not_found(tmp_path, damage):
    centre = Centre({"air": 10.0}, {"fit": 100.0}, {"core": 5.0})
    cache = BasisCache(tmp_path, [b"machine"])

    class Principal:
        strength, fields = np.ones(3), np.arange(1200.0).reshape(400, 3)

    cache.keep(centre, {"core": Principal})
    assert cache.find(centre, 2.0) is not None
    damage(next(tmp_path.glob("shapes-*.npz")))
    assert cache.find(centre, 2.0) is None
    cache.keep(centre, {"core": Principal})
    assert cache.find(centre, 2.0) is not None


def test_what_cannot_be_read_is_as_if_it_were_not_there(tmp_path):
    (tmp_path / "kept").write_text("x")
    assert recalled(tmp_path / "kept", lambda path: path.read_text()) == "x"
    assert recalled(tmp_path / "kept", lambda path: int(path.read_text())) is None
    assert recalled(tmp_path, lambda path: "read") is None
    assert recalled(tmp_path / "no", lambda path: "read") is None


@pytest.mark.skipif(sys.platform == "win32", reason="no locks on folders")
@pytest.mark.parametrize("cache", ["cache", "file"])
def test_what_a_killed_new_left_goes_with_the_next(tmp_path, monkeypatch, cache):
    """Begun in the cache, or hidden beside its place where there can be no cache."""
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path / cache))
    begun = tmp_path / "cache" / "new" if cache == "cache" else tmp_path / "work" / ".made"
    left, other = begun.with_name(f"{begun.name}.{'a' * 32}"), begun.with_name(f"{begun.name}.notes")
    (tmp_path / "work").mkdir()
    for path in (left, other):
        path.mkdir(parents=True)
        os.utime(path, (time.time() - 60,) * 2)
    with folder_whole(tmp_path / "work" / "made") as partial:
        assert not left.exists()
        assert partial.parent == begun.parent
        os.utime(partial, (time.time() - 60,) * 2)
        with folder_whole(tmp_path / "work" / "made"):  # the first is still at work: it stays
            assert partial.exists()
        shutil.rmtree(tmp_path / "work" / "made")
    assert [p.name for p in begun.parent.iterdir() if p != begun.with_name("made")] == [other.name]
    assert (tmp_path / "work" / "made").is_dir()


KILLED = """
import os, signal, sys
from pathlib import Path
from measured.importing.case_files import folder_whole
with folder_whole(Path("made")) as partial:
    (partial / "case.toml").write_text("half")
    os.kill(os.getpid(), getattr(signal, sys.argv[1]))
"""


@pytest.mark.nightly
@pytest.mark.parametrize("number", ["SIGTERM", "SIGKILL"])
def test_a_killed_new_leaves_nothing(tmp_path, number):
    work, cache = tmp_path / "work", tmp_path / "cache"
    work.mkdir()
    done = subprocess.run(
        [sys.executable, "-c", KILLED, number],
        cwd=work,
        check=False,
        env={**os.environ, "THERMOSCOPE_CACHE": str(cache)},
    )
    assert done.returncode != 0
    assert list(work.iterdir()) == []
    assert number == "SIGKILL" or list(cache.iterdir()) == []
