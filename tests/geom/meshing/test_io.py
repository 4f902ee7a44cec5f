"""Meshes on disk come back as they were."""

import numpy as np
import pytest

from geom import InputError, read_vtu, write_vtu


def test_vtu_keeps_everything(motor_mesh, tmp_path):
    path = tmp_path / "motor.vtu"
    write_vtu(motor_mesh, path)
    back = read_vtu(path)
    assert back.parts == motor_mesh.parts
    assert np.array_equal(back.points, motor_mesh.points)
    assert np.array_equal(back.tets, motor_mesh.tets)
    assert np.array_equal(back.region, motor_mesh.region)
    for kind in ("patches", "contacts"):
        before, after = getattr(motor_mesh, kind), getattr(back, kind)
        assert list(before) == list(after)
        assert all(np.array_equal(before[name].facets, after[name].facets) for name in before)


def test_missing_names_are_told(motor_mesh, tmp_path):
    path = tmp_path / "motor.vtu"
    write_vtu(motor_mesh, path)
    (tmp_path / "motor.vtu.json").unlink()
    with pytest.raises(InputError, match=r"motor\.vtu\.json"):
        read_vtu(path)
