"""What is kept on disk is there whole or not at all."""

import pytest

from geom.storage import atomic_write


def test_nobody_sees_a_file_before_it_is_complete(tmp_path):
    file = tmp_path / "new" / "kept.npz"
    with atomic_write(file) as partial:
        partial.write_text("half")
        assert not list(file.parent.glob("kept*"))
        partial.write_text("whole")
    assert file.read_text() == "whole"


def interrupted(file):
    with atomic_write(file) as partial:
        partial.write_text("half")
        raise KeyboardInterrupt


def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path):
    file = tmp_path / "kept.npz"
    file.write_text("old")
    with pytest.raises(KeyboardInterrupt):
        interrupted(file)
    assert [f.name for f in tmp_path.iterdir()] == ["kept.npz"]
    assert file.read_text() == "old"
