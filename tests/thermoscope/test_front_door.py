"""`import thermoscope as ts`: complete, quick to load, the same answers as the rooms give, nothing changed unasked."""

import ast
import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest
from small_case import small_case

import thermoscope as ts
from thermoscope.case_folder.folder import load_case
from thermoscope.rooms import ROOMS, hidden_by
from validation import compare
from validation.effects import kinds

HEAVY = ("numpy", "scipy", "numba", "pandas", "matplotlib", "pyvista", "skfem", "cadquery")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return small_case(tmp_path_factory.mktemp("case"))


@pytest.fixture(scope="module")
def case(folder):
    return ts.open(folder)


@pytest.fixture(scope="module")
def better(case):
    return case.add("convection@flange")


def test_all_is_complete(root):
    """Every name of __all__ is there, and editors are told of the same names."""
    tree = ast.parse((root / "thermoscope" / "__init__.py").read_text())
    typed = next(node for node in tree.body if isinstance(node, ast.If))
    told = {alias.name for node in typed.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert told == set(ts.__all__) == set(dir(ts))
    assert all(getattr(ts, name).__doc__ for name in ts.__all__)
    with pytest.raises(AttributeError, match="known: "):
        _ = ts.opened


def test_import_loads_nothing_heavy(root):
    code = f"import sys, thermoscope; print([m for m in {HEAVY + ROOMS} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stdout + done.stderr


def test_own_names_are_not_submodules():
    """A submodule of the same name would take a function's place once it is imported."""
    from pkgutil import iter_modules

    assert not {m.name for m in iter_modules(ts.__path__)} & set(ts.__all__)


@pytest.mark.parametrize("form", ["viz.py", "viz/__init__.py"])
def test_a_hidden_room_is_one_message(root, tmp_path, form):
    file = tmp_path / form
    file.parent.mkdir(exist_ok=True)
    file.write_text("")
    code = f"import sys; sys.path.insert(1, {str(root)!r}); import thermoscope"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: 'viz' is found at ")
    assert str(file) in last


def test_a_folder_of_data_hides_nothing(root, tmp_path):
    """A folder without __init__.py is not a package: Python goes on looking."""
    (tmp_path / "fem").mkdir()
    code = f"import sys; sys.path.insert(1, {str(root)!r}); import thermoscope as ts; print(ts.InputError.__module__)"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert done.stdout.strip() == "geom.errors", done.stderr


def test_a_room_has_one_module_under_both_names(root):
    """Whichever is imported first, also parts of it; a class caught by one name is raised by the other."""
    code = """
import importlib, sys
import thermoscope
pairs = ({first!r}, {second!r}), ("thermoscope.lumped", "lumped"), ("lumped.model", "thermoscope.lumped.model")
for one, other in pairs:
    a, b = importlib.import_module(one), importlib.import_module(other)
    assert a is b, one
    assert a.__spec__.name == a.__name__ == one.removeprefix("thermoscope."), a.__spec__
from thermoscope import geom
assert geom is sys.modules["geom"]
"""
    names = "thermoscope.geom.errors", "geom.errors"
    for first, second in (names, names[::-1]):
        run = [sys.executable, "-c", code.format(first=first, second=second)]
        done = subprocess.run(run, cwd=root, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


def test_no_module_of_a_room_is_one_message():
    with pytest.raises(ModuleNotFoundError, match=r"geom\.nothing"):
        import_module("thermoscope.geom.nothing")


def test_own_rooms_are_not_hidden():
    assert {room: hidden_by(room) for room in ROOMS} == dict.fromkeys(ROOMS)


def test_compare_is_what_the_rooms_say(case, folder):
    assert case.compare().document() == compare(load_case(folder).case).document()


def printed(thing):
    """What a notebook shows: a screen at most, and no array of numbers."""
    text = repr(thing)
    assert len(text.splitlines()) < 25
    assert len(text) < 2000
    assert "array(" not in text
    return text


def test_a_comparison_shows_what_the_command_says(case, folder, capsys):
    from thermoscope.commands.test.compare import compare as command

    command(str(folder), None)
    told = " ".join(capsys.readouterr().out.split())
    sentence, *rows = printed(case.compare()).splitlines()
    assert sentence in told
    assert {row.split()[0] for row in rows[1:]} == set(case.tests)


def test_a_step_gives_a_new_case(case, better):
    assert case.effects == ()
    assert better.effects == ("convection@flange",)
    assert better.compare().rmse_K < case.compare().rmse_K
    assert better.folder.history.last.number == 1
    assert not case.folder.settings.model_file.exists()


def test_saved_and_opened_again(better, tmp_path):
    """The model that is read back is the one that was saved, to the eight digits of the file."""
    copy = ts.open(small_case(tmp_path))
    fresh = type(better)(copy.folder, copy.on_disk)
    with pytest.raises(ts.InputError, match="sit"):
        fresh.add("convection@nowhere")
    file = better.save().folder.settings.model_file
    try:
        again = ts.open(file.parent)
        assert again.effects == better.effects
        for name, value in better.values.items():
            assert again.values[name] == pytest.approx(value, rel=1e-7)
        with pytest.raises(ts.InputError, match="another tab or command"):
            better.save()
    finally:
        file.unlink()


def test_what_was_refused_is_not_saved(better):
    from dataclasses import replace

    refused = replace(better, steps=(replace(better.steps[0], accepted=False),))
    with pytest.raises(ts.InputError, match="not accepted"):
        refused.save()
    assert not better.folder.settings.model_file.exists()


def test_plot_shows_a_test_that_was_not_fitted(better, tmp_path):
    """One of the lines is the model of the flange, instant by instant."""
    from thermoscope.case_folder.runs import readings

    figure = better.plot(png=tmp_path / "a.png")
    model = readings(better.folder.case, better.tests["town"])["T_flange"]
    drawn = [line.get_ydata() for ax in figure.axes for line in ax.lines]
    assert any(len(y) == len(model) and np.allclose(y, model) for y in drawn)
    assert (tmp_path / "a.png").stat().st_size > 1000
    with pytest.raises(ts.InputError, match="one of stand, road, town"):
        better.plot("nothing")


def test_effects_are_the_catalogue(case):
    assert ts.effects() == kinds()
    assert "convection@flange" in {effect.name for effect in case.candidates()}


def test_best_says_why_there_is_none(case):
    from validation.inference.result import Diagnosis

    nothing = Diagnosis("adequate", "the model explains all.", (), (), (), (), (), (), 0.1, 0.1, 3.0)
    with pytest.raises(ts.InputError, match="the model explains all"):
        _ = nothing.best


def test_the_readme_runs(root, tmp_path, monkeypatch):
    """The block as it stands, on a case that lacks convection at its flange: it is found, added and saved."""
    text = (root / "README.md").read_text()
    block = text.split("<!-- front-door:begin -->")[1].split("```python")[1].split("```")[0]
    small_case(tmp_path).rename(tmp_path / "my-case")
    monkeypatch.chdir(tmp_path)
    left: dict = {}
    exec(block, left)
    assert left["d"].best == "convection@flange"
    assert printed(left["d"]).startswith("Missing: forced convection by vehicle wind at flange")
    assert printed(left["d"]).splitlines()[2].startswith("forced convection by vehicle wind at flange ")
    assert ts.open("my-case").effects == ("convection@flange",)
    assert left["better"].compare().rmse_K < 0.5 * left["case"].compare().rmse_K
    assert (tmp_path / "better.png").stat().st_size > 1000


@pytest.mark.heavy
def test_a_machine_and_its_field():
    """Steady: the heat that goes in comes out, and the rise is positive everywhere."""
    machine = ts.build("pmsm-m1-no-base", size_m=0.1)
    half, more = (share * machine.rated["current_A"] for share in (0.5, 0.6))
    field = machine.field(ambient_C=25.0, current_A=half)
    assert field.energy_balance < 1e-6
    assert field.T.min() > 25.0
    assert all(part in printed(field) for part in field.parts)
    assert f"{len(machine.mesh.tets)} tetrahedra" in printed(machine)
    assert max(part.fem_max_C for part in field.parts.values()) == pytest.approx(field.T.max(), abs=1e-9)
    warmer = machine.field(ambient_C=25.0, current_A=more)
    assert warmer.heat_W > field.heat_W
    assert warmer.T.mean() > field.T.mean()
    with pytest.raises(ts.InputError, match="one of current_A"):
        machine.field(current=1.0)


@pytest.mark.heavy
def test_a_load_at_which_nothing_settles_is_one_message():
    machine = ts.build("pmsm-m1-no-base", size_m=0.1)
    with pytest.raises(ts.InputError, match=r"does not settle at current_A = .*; a smaller load"):
        machine.field(current_A=20.0 * machine.rated["current_A"])
