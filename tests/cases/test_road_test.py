"""`thermoscope demo` on the shipped road test, which a 3-D generator of its own made: the wind is named.

Run once, with a count of what it reads, meshes, reduces and diagnoses.
"""

import json
import re
from collections import Counter
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

import pytest

import validation
from lumped.build import pipeline
from thermoscope.case_folder import folder as case_folder
from thermoscope.demo import demo

pytestmark = pytest.mark.heavy
SCREENFUL, WIDE = 80, 80  # lines of the whole story, and columns
CHAPTERS = {
    "1-machine.png": "1",
    "2-misses.png": "3",
    "3-odds.png": "5",
    "error.png": "7",
    "field-before-after.png": "7",
}
EFFECT = "convection@flange.right"


def counted(patch, module, name, seen, key):
    """Every call of module.name is counted under key(*arguments)."""
    original = getattr(module, name)

    def call(*args, **options):
        seen[(name, *key(*args))] += 1
        return original(*args, **options)

    patch.setattr(module, name, call)


@pytest.fixture(scope="module")
def story(tmp_path_factory):
    home, out, seen, text = tmp_path_factory.mktemp("demo"), Path("out/demo"), Counter(), StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(text):
        patch.chdir(home)
        patch.setenv("COLUMNS", str(WIDE))
        counted(patch, case_folder, "load_table", seen, lambda path, *rest: (path.stem,))
        counted(patch, pipeline, "build_mesh", seen, lambda machine, *how: (machine.name, *how[:4]))
        counted(patch, pipeline, "reduce", seen, lambda field, *rest: (field.n, repr(rest[4]), rest[7] is None))
        counted(patch, validation, "diagnose", seen, lambda *rest: ())
        code = demo(out, str(out / "demo.json"))
    return SimpleNamespace(out=home / out, seen=seen, lines=text.getvalue().splitlines(), code=code)


@pytest.mark.timeout(3600)
def test_the_wind_on_the_right_flange_is_named_and_the_error_falls(story):
    found = json.loads((story.out / "diagnose.json").read_text())
    assert found["verdict"] == "named"
    assert found["named"] == [EFFECT]
    assert story.code == 0
    first, *_, last = json.loads((story.out / "demo.json").read_text())["stages"]
    held = {t["name"]: t["rmse_K"] for t in last["tests"] if t["role"] == "hold-out"}
    before = {t["name"]: t["rmse_K"] for t in first["tests"]}
    assert held
    assert [name for name, error in held.items() if error >= before[name]] == []


def test_it_is_told_in_eighty_lines_of_eighty_columns(story):
    assert len(story.lines) <= SCREENFUL
    assert max(map(len, story.lines)) <= WIDE


def test_the_five_pictures_are_named_where_they_belong(story):
    chapter, found = "", {}
    for line in story.lines:
        chapter = match[1] if (match := re.match(r"=== (\d) ", line)) else chapter
        if line.startswith("Picture: "):
            found[line.split(": ")[1].rpartition("/")[2]] = chapter
    assert found == CHAPTERS
    assert all((story.out / name).stat().st_size > 10_000 for name in CHAPTERS)


def test_nothing_is_read_meshed_reduced_or_diagnosed_twice(story):
    assert {what[0] for what in story.seen} == {"load_table", "build_mesh", "reduce", "diagnose"}
    assert {what: n for what, n in story.seen.items() if n > 1} == {}
