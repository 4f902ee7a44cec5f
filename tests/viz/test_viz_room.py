"""The room's public face."""

import pytest

import viz


@pytest.mark.parametrize("name", viz.__all__)
def test_everything_promised_is_there(name):
    assert getattr(viz, name) is not None


def test_unknown_name_lists_the_known_ones():
    with pytest.raises(AttributeError, match="cutaway"):
        viz.nothing  # noqa: B018
