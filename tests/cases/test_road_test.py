"""The shipped road test, made by a 3-D generator of its own: the wind on the right flange is named."""

import shutil
from functools import partial

import pytest

from lumped.condensation.reduction import Recipe
from thermoscope import pipeline
from thermoscope.case_folder.folder import load_case
from validation import calibrate, diagnose
from validation.calibration.unknowns import with_model


@pytest.mark.heavy
def test_the_wind_on_the_right_flange_is_named(root, tmp_path, monkeypatch):
    """Also by a model on a coarse mesh with a third of the states that `thermoscope demo` has."""
    small = Recipe(tolerance=0.3, random_points=1, local_points=1, local_states=1, max_states=40)
    monkeypatch.setattr(pipeline, "build", partial(pipeline.build, size_m=0.15, segments=24, recipe=small))
    folder = tmp_path / "road-test"
    shutil.copytree(root / "cases" / "road-test", folder, ignore=shutil.ignore_patterns("out", "model.toml"))
    case = load_case(folder).case
    stand = with_model(case, calibrate(case).model)
    found = diagnose(stand, plan=False)
    assert found.verdict == "named"
    assert found.named == ("convection@flange.right",)
    before, after = found.candidates[0].holdout_rmse_K
    assert after < before
