"""Heat beside a node's mean: conserved, of the size asked for, and only where plain conductances meet."""

import numpy as np
import pytest
from validation.bridges import bridges, stars

from lumped.declared import read_network


def chain():
    return read_network(
        {
            "network": {"name": "chain", "boundaries": ["ambient"]},
            "nodes": {"a": {"C_J_K": 100.0}, "b": {"C_J_K": 200.0}, "c": {"C_J_K": 300.0}},
            "links": {
                "ab": {"between": ["a", "b"], "G_W_K": 2.0},
                "bc": {"between": ["b", "c"], "G_W_K": 6.0},
                "out": {"between": ["c", "ambient"], "G_W_K": 1.0},
            },
        }
    )


def test_only_a_node_between_two_others_has_a_bridge():
    assert stars(chain()) == {"a": {"b": 2.0}, "b": {"a": 2.0, "c": 6.0}, "c": {"b": 6.0}}
    (bridge,) = bridges(chain(), np.random.default_rng(0), 0.1)
    assert set(bridge.places) == {"a", "c"}


def test_a_bridge_takes_from_one_end_what_it_gives_to_the_other():
    (bridge,) = bridges(chain(), np.random.default_rng(0), 0.1)
    column = np.zeros(4)
    np.add.at(column, bridge.rows, bridge.vals * np.array([10.0, 20.0, 40.0, 0.0])[bridge.cols])
    assert (abs(column[0]), column[1], column.sum()) == (30.0, 0.0, 0.0)


def test_a_bridge_is_a_share_of_the_conductance_through_the_node():
    sizes = [b.law.factor({}) for s in range(400) for b in bridges(chain(), np.random.default_rng(s), 0.1)]
    assert np.std(sizes) == pytest.approx(0.1 * 2.0 * 6.0 / 8.0, rel=0.15)
    assert abs(np.mean(sizes)) < 0.03
