"""The wheel, built, installed into a clean environment; its command and the examples run away from the checkout."""

import json
import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.nightly


def uv() -> str:
    beside = Path(sys.executable).with_name("uv")
    return str(beside) if beside.exists() else str(shutil.which("uv"))


@pytest.fixture(scope="module")
def elsewhere(root, tmp_path_factory):
    """An empty folder whose `env` holds the wheel and the locked dependencies, and nothing of the checkout."""
    home = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(home / "dist"), str(root)]
    subprocess.run(build, check=True, capture_output=True)
    (wheel,) = (home / "dist").glob("*.whl")
    subprocess.run([uv(), "venv", "--quiet", "--python", sys.executable, str(home / "env")], check=True)
    install = [uv(), "pip", "install", "--quiet", "--python", str(home / "env" / "bin" / "python"), str(wheel)]
    subprocess.run([*install, "--constraint", str(root / "requirements.lock")], check=True, cwd=home)
    return home


def started(home, program, *arguments):
    """A program of the environment, beside it."""
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    environment["NUMBA_OPT"] = "0"  # compiled here for this one run: in half the time, and no faster is needed
    command = [str(home / "env" / "bin" / program), *arguments]
    return subprocess.run(command, cwd=home, env=environment, capture_output=True, text=True)


# Every example that needs no extra, held against what it is to give; more than all a user may import is in them.
EXAMPLES = """
import json, runpy, sys
import numpy as np
import thermoscope.rooms
for file, allowed in json.loads(sys.argv[1]):
    left = runpy.run_path(file)
    off = float(np.abs(left["computed"] - left["expected"]).max())
    print("example", "right" if off < allowed else f"off by {off}", file)
print("outside:", [name for name in sys.modules if name.partition(".")[0] in thermoscope.rooms.ROOMS])
"""


@pytest.mark.parametrize(
    ("source", "inside"),
    [
        ("from geom.errors import X", "from thermoscope.geom.errors import X"),
        ("def f():\n    from viz import a  # é", "def f():\n    from thermoscope.viz import a  # é"),
        ("import geom.lazy as lazy", "import thermoscope.geom.lazy as lazy"),
        ("x = 'é', 'viz.pages', 'geom.'", "x = 'é', 'thermoscope.viz.pages', 'thermoscope.geom.'"),
        ("import geometry\nfrom .geom import x\ny = 'geom', 'geom is', geom.x", None),
    ],
)
def test_imports_and_names_of_modules_follow(root, source, inside):
    """No other text changes: a part may be called geom."""
    rewritten = runpy.run_path(str(root / "scripts" / "rooms_inside.py"))["inside"]
    assert rewritten(source, ["geom", "viz"]) == (inside or source)


def test_an_import_that_would_bind_another_name_is_refused(root):
    with pytest.raises(ValueError, match="line 2: `import geom`"):
        runpy.run_path(str(root / "scripts" / "rooms_inside.py"))["inside"]("\nimport geom", ["geom"])


def test_it_holds_one_package_alone(elsewhere):
    (record,) = (elsewhere / "env").glob("lib/*/site-packages/thermoscope-*.dist-info/RECORD")
    files = [line.partition(",")[0] for line in record.read_text().splitlines()]
    assert {f.partition("/")[0] for f in files if not f.startswith("..")} == {"thermoscope", record.parent.name}


def test_examples_run_from_it(root, elsewhere):
    """A user's own package called `geom` beside his script hides nothing."""
    (elsewhere / "geom").mkdir()
    (elsewhere / "geom" / "__init__.py").write_text("")
    known = runpy.run_path(str(root / "tests" / "docs" / "example_references.py"))
    core = [(name, allowed) for name, allowed in known["REFERENCE"].items() if name not in known["NEED_EXTRAS"]]
    files = [(str(root / "examples" / f"{name}.py"), allowed) for name, allowed in core]
    done = started(elsewhere, "python", "-c", EXAMPLES, json.dumps(files))
    assert done.returncode == 0, done.stderr
    *lines, outside = done.stdout.splitlines()
    assert [x for x in lines if x.startswith("example ")] == [f"example right {file}" for file, _ in files]
    assert outside == "outside: []"


def test_command_answers(elsewhere):
    done = started(elsewhere, "thermoscope", "--help")
    assert done.returncode == 0, done.stderr
    assert "explain" in done.stdout


def test_shipped_case_runs_without_the_checkout(elsewhere):
    done = started(elsewhere, "thermoscope", "test", "compare", "tclab", "--no-bands", "--json", "-")
    assert done.returncode in (0, 1), done.stderr
    assert json.loads(done.stdout)["case"] == "tclab"
