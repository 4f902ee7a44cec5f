"""Labels in pixels: inside the picture, beside the colour bar, over no other label and no node, for long names too."""

from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from small_motor import motor

from geom import build_mesh, load_machine
from viz import Sensor, cutaway, misses, regions, split, uncertainty
from viz.figures.flows import Flow, Heat
from viz.machine.network import network_in_machine, places
from viz.rendering.scene import BAR, SIZE

NODES = split(motor(24))
LONG = "TC{:02d} beside the third coil, drive end"  # longer than what a label holds
RADIUS_PX = 20  # of a node's coloured dot


def thermocouples(n=14):
    """All over the machine: on every part a few, of all sizes of error."""
    rng = np.random.default_rng(5)
    at = NODES.points[rng.choice(NODES.size, n, replace=False)]
    return [Sensor(LONG.format(k), tuple(xyz), float(k - 6), 1.0) for k, xyz in enumerate(at)]


def renamed():
    return replace(NODES, parts=tuple(f"the {name} of motor 3" for name in NODES.parts), identities={})


PICTURES = {
    "field": lambda: cutaway(NODES, np.linspace(20.0, 80.0, NODES.size), sensors=thermocouples(), title="hour"),
    "misses": lambda: misses(NODES, NODES.points[:, 2], np.ones(NODES.size), sensors=thermocouples(), title="hour"),
    "uncertainty": lambda: uncertainty(NODES, NODES.points[:, 2], sensors=thermocouples(), title="hour"),
    "parts": lambda: regions(renamed(), title="motor"),
}


def boxes(p, grounded=True):
    """text -> left, right, bottom, top in pixels of every label that has a ground of its own, or of all other words."""
    p.render()
    out = {}
    for actor in p.renderer.actors.values():
        if hasattr(actor, "GetTextProperty") and (actor.GetTextProperty().GetBackgroundOpacity() == 1.0) == grounded:
            box = [0.0] * 4
            actor.GetBoundingBox(p.renderer, box)
            x, y = actor.GetPositionCoordinate().GetComputedDoubleViewportValue(p.renderer)
            out[actor.GetInput().strip()] = [x + box[0], x + box[1], y + box[2], y + box[3]]
    return out


def apart(a, b):
    return a[1] <= b[0] or b[1] <= a[0] or a[3] <= b[2] or b[3] <= a[2]


@pytest.mark.parametrize("kind", PICTURES)
def test_labels_stand_clear(kind):
    p = PICTURES[kind]()
    found = boxes(p)
    p.close()
    assert len(found) == (len(NODES.parts) if kind == "parts" else 6)
    end = SIZE[0] * (1.0 if kind == "parts" else 1.0 - BAR)
    for words, box in found.items():
        assert 0 <= box[0] <= box[1] <= end, words
        assert 0 <= box[2] <= box[3] <= SIZE[1], words
    for a, b in combinations(found, 2):
        assert apart(found[a], found[b]), (a, b)


def test_names_of_a_network_cover_no_node():
    """The fan-cooled machine: its shields' nodes are pushed out of the machine, where names begin."""
    mesh = build_mesh(load_machine("tefc-industrial"), 0.15)
    at = places(mesh, split(mesh))
    names = [name for name, xyz in at.items() if xyz[1] > 0]
    flows = tuple(Flow(a, b, "contact", 40.0 + k, 2.0) for k, (a, b) in enumerate(pairwise(names)))
    p = network_in_machine(mesh, dict.fromkeys(names, 60.0), Heat({"iron": 40.0}, flows, {}), title="hour")
    found = boxes(p)
    dots = []
    for xyz in p.actors["nodes"].mapper.dataset.points:
        p.renderer.SetWorldPoint(*xyz, 1.0)
        p.renderer.WorldToDisplay()
        x, y, _ = p.renderer.GetDisplayPoint()
        dots.append([x - RADIUS_PX, x + RADIUS_PX, y - RADIUS_PX, y + RADIUS_PX])
    p.close()
    assert len(found) > len(names)
    assert all(box[1] <= SIZE[0] * (1.0 - BAR) and box[0] >= 0 for box in found.values())
    assert [words for words, box in found.items() if not all(apart(box, dot) for dot in dots)] == []
    assert [pair for pair in combinations(found, 2) if not apart(found[pair[0]], found[pair[1]])] == []


def test_marks_of_a_bar_of_watts_stand_apart():
    """Eight hundred watts in steps of a hundred; the unit stands once, at the end."""
    flows = (Flow("yoke", "housing", "contact", 800.0, 8.0),)
    p = network_in_machine(motor(24), {"yoke": 90.0, "housing": 40.0}, Heat({}, flows, {}), title="hour")
    found = boxes(p, grounded=False)
    p.close()
    below = {words: box for words, box in found.items() if box[3] < 0.15 * SIZE[1]}
    assert len(below) > 4
    assert [words for words in below if words.endswith("W")] == ["800 W"]
    assert [pair for pair in combinations(below, 2) if not apart(below[pair[0]], below[pair[1]])] == []
