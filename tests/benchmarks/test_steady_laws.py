"""The law that tables were drawn from is found, and none where there is none."""

import pytest
from drawn.steady_laws import KINDS, judged


@pytest.mark.parametrize("kind", KINDS)
def test_drawn_laws(kind):
    """All of four; of tests that scatter one table in twenty may have a law by chance."""
    right = sum(judged(seed, kind)["right"] for seed in range(4))
    assert right >= (3 if kind == "scatter" else 4)
