"""Every shipped file, unchanged, through every command that takes it: none dies, and what comes out is finite.

One table says which command takes which case; a command, a case, a cycle, a machine or a network without a line fails.
"""

import json
import math
import shutil
import subprocess
import sys
from functools import lru_cache, partial
from pathlib import Path

import pytest
from command_line import GROUP, answered

from lumped.build import fixed_coefficients, network_size, pipeline
from lumped.condensation.reduction import Recipe
from lumped.declarations.network import load_network
from thermoscope.case_folder.folder import load_machine_file
from thermoscope.commands import open_case
from thermoscope.commands.model.crosscheck import checked

ROOT = Path(__file__).resolve().parents[2]
TINY = Recipe(tolerance=0.3, shifts=(), random_points=1, local_points=1, local_states=1, max_states=40)
# One of each kind through `build`: two bases to stand on, a jacket, a cowl with radial fins.
BUILT = [
    "cases/pmsm-bases/machine.toml",
    *(pytest.param(name, marks=pytest.mark.nightly) for name in ("ipmsm-48s8p-jacket", "tefc-industrial-radial")),
]
FORMS = ("xlsx", "csv", "c", "json", "matlab", "fmu")
LOOK = ("doctor", "compare", "compare --why", "simulate", "effects", "curves", "report", "render")
DRAWN = ("picture curves", "picture residuals")
STEPS = ("calibrate", "diagnose", "improve --yes --most 1")
WRITING = {"add", "calibrate", "diagnose", "improve"}  # each on a copy of its own
DECLARED = (*LOOK, *DRAWN, *(f"export --as {form}" for form in FORMS))
# Bands cost most of a run of long records, and as many states as a machine has do without: tclab has them.
PLAIN = ("compare --no-bands", "simulate --no-bands")
# Of machines, each on a coarse mesh; pictures, recording and report of the road test: test_road_test.
MESHED = ("doctor", *PLAIN, "effects", "curves", "export --as csv", "picture curves")
TAKEN = {
    "tclab": (*DECLARED, *STEPS, "add convection.constant@heater1 --anyway", "picture losses"),
    "hust-ipmsm": (
        *PLAIN,
        *(words for words in DECLARED if words.partition(" ")[0] not in ("compare", "simulate")),
        *("picture losses", "simulate --cycle s3-40 --no-bands", "rate --limit winding=150 --no-bands"),
    ),
    "pmsm-bases": (
        *MESHED,
        "bases",
        "two-paths",
        "report",
        "rate --limit magnets=120 --limit winding=155 --no-bands",
        "carry {pmsm-machines/m2} {pmsm-machines/m3}",  # last: these two machines stay in memory for what follows
    ),
    "pmsm-machines/m2": MESHED,
    "pmsm-machines/m3": MESHED,
    "tefc-drive": ("simulate --cycle hoist --no-bands", "rate --limit winding=155 --cycle hoist --no-bands"),
    "road-test": (
        *MESHED,
        *("simulate --cycle overpass --no-bands", "viewer", "film", "rate --limit winding=155 --no-bands"),
    ),
}
# Below, and in tests/geom, tests/extras/rating, tests/thermoscope/commands (build, optimise).
MACHINE_COMMANDS = {"build", "import", "crosscheck", "screen", "machines", "optimise", "compare-designs"}
# Of recordings that are not shipped, of what went before; tests/fleet, tests/thermoscope/commands (plan).
NO_FILE = {
    *("new", "quantities", "protocol", "law", "answer", "remove", "undo", "serve", "plan", "fleet", "watch"),
    "live",
}


# What a case has not: one message, which says so.
REFUSED = {
    ("tclab", "picture network"): "no geometry",
    ("tclab", "picture errors"): "no revisions",
    ("tclab", "bases"): "base",
    ("tclab", "two-paths"): "winding.copper",
    ("tclab", "rate --limit heater1=90"): "no input carries the load",
    ("tclab", "film"): "no geometry",
    ("hust-ipmsm", "viewer"): "no geometry",
    ("hust-ipmsm", "picture field"): "no geometry",
}


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """A copy of all cases, meshes coarse: `report` and the fits write into it. A case is opened once, as by the
    workbench and the demo: what a command adds to that is what differs from command to command."""
    home = tmp_path_factory.mktemp("shipped")
    shutil.copytree(ROOT / "cases", home / "cases", ignore=shutil.ignore_patterns("out"))
    quick = partial(pipeline.build, size_m=0.15, segments=24, recipe=TINY)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pipeline, "build", quick)
        patch.setattr(pipeline, "wound", lambda machine, part: False)  # linear windings: two fifths of the unknowns
        patch.setattr(fixed_coefficients, "STEPS", ((600.0, 2),))  # of a field, for the error of its network
        patch.setattr(open_case, "load_case", opened_once(open_case.load_case, home / "cases"))
        yield home


def opened_once(load_case, home):
    """The same, but a case of `home`, whose files stay as they are, is still open where it is among the last few."""
    seen = lru_cache(maxsize=3)(partial(load_case, untested=True))
    return lambda path, *how, **options: seen(path) if home in path.parents else load_case(path, *how, **options)


LINES = [
    pytest.param(case, words, marks=[pytest.mark.nightly] if case != "tclab" or words in STEPS else [])
    for case, all_ in TAKEN.items()
    for words in all_
]


@pytest.mark.parametrize(("case", "words"), LINES)
def test_a_shipped_case_goes_through_the_command(home, tmp_path, case, words):
    places = {name: str(home / "cases" / name) for name in TAKEN}
    command, *options = [places.get(word.strip("{}"), word) for word in words.split()]
    if command in WRITING:
        places[case] = str(shutil.copytree(places[case], tmp_path / "case"))
    done = answered(command, places[case], *options, "--json", "-", cwd=tmp_path)
    assert done.errors == []
    assert done.code in (0, 1)
    assert finite(done.document)


@pytest.mark.parametrize(
    ("case", "words"),
    [pytest.param(*k, marks=[pytest.mark.nightly] if k[0] != "tclab" else [], id=" ".join(k)) for k in REFUSED],
)
def test_what_a_shipped_case_has_not_is_said(home, tmp_path, case, words):
    command, *options = words.split()
    done = answered(command, home / "cases" / case, *options, "--json", "-", cwd=tmp_path)
    assert (done.code, done.out, len(done.errors)) == (2, "", 1)
    assert REFUSED[case, words] in done.errors[0]


def finite(document):
    """Whether a document says something, and no number of it had no end."""
    return bool(document) and "NaN" not in json.dumps(document) and "Infinity" not in json.dumps(document)


def test_every_command_and_every_file_has_a_line():
    words = {word.split()[0] for all_ in TAKEN.values() for word in all_}
    assert words | MACHINE_COMMANDS | NO_FILE == set(GROUP)
    assert {str(p.parent.relative_to(ROOT / "cases")) for p in ROOT.glob("cases/**/case.toml")} == set(TAKEN)
    cycles = {(p.parents[1].name, p.stem) for p in ROOT.glob("cases/**/cycles/*.toml")}
    runs = [(c, w.split()) for c, all_ in TAKEN.items() for w in all_ if "--cycle" in w]
    assert cycles == {(c, w[w.index("--cycle") + 1]) for c, w in runs}


@pytest.mark.parametrize("file", sorted(ROOT.glob("benchmarks/hidden/machines/*.toml")), ids=lambda file: file.stem)
def test_a_network_beside_no_case_is_read(file):
    assert load_network(file).states


@pytest.mark.parametrize("name", BUILT)
@pytest.mark.usefixtures("home")
def test_a_shipped_machine_is_built_and_held_against_its_field(name):
    """On a coarse mesh, of any accuracy, looked at in few points: that it runs and closes its balance is the point."""
    machine = load_machine_file(ROOT / name if name.endswith(".toml") else Path(name))
    found = network_size.smallest_network(
        machine, 1e3, size_m=0.15, segments=24, recipe=TINY, rounds=0, points_each=1, contact_factors=(5.0,)
    )
    result = checked(found.built, found, lambda message: None)
    assert result["energy_balance"] < 1e-9
    assert all(math.isfinite(part["network_mean_C"]) for part in result["crosscheck"])


def test_the_package_runs_as_a_module():
    done = subprocess.run([sys.executable, "-m", "thermoscope", "--help"], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0
    assert "explain" in done.stdout
