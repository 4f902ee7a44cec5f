"""The motor and its coarse mesh, built once."""

import pytest

from geom import COARSE, build_mesh, load_machine


@pytest.fixture(scope="session")
def motor():
    return load_machine("series-dc-100kw")


@pytest.fixture(scope="session")
def motor_mesh(motor):
    return build_mesh(motor, **COARSE)
