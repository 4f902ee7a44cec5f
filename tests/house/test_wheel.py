"""The wheel, built, installed into a clean environment, and its command run away from the checkout."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.heavy


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


def run(home, *arguments):
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    environment["NUMBA_OPT"] = "0"  # compiled here for this one run: in half the time, and no faster is needed
    command = [str(home / "env" / "bin" / "thermoscope"), *arguments]
    return subprocess.run(command, cwd=home, env=environment, capture_output=True, text=True)


def test_command_answers(elsewhere):
    done = run(elsewhere, "--help")
    assert done.returncode == 0, done.stderr
    assert "explain" in done.stdout


def test_shipped_case_runs_without_the_checkout(elsewhere):
    done = run(elsewhere, "compare", "tclab", "--no-bands", "--json", "-")
    assert done.returncode in (0, 1), done.stderr
    assert json.loads(done.stdout)["case"] == "tclab"
