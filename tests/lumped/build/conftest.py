"""A coarse network of M1, built once."""

import pytest

from geom import load_machine
from lumped.build.pipeline import build
from lumped.condensation.reduction import Recipe


@pytest.fixture(scope="session")
def built():
    small = Recipe(tolerance=0.1, shifts=(), random_points=0, max_states=60)
    return build(load_machine("pmsm-m1-no-base"), 0.1, 36, small)
