"""Labels of shipped cases whose sensors have places: from every side a ray through a dot ends at its own sensor."""

import tomllib

import numpy as np
import pytest
from test_viz_ghost import eye_of, first_hit

from extras.portraits.portrait import VIEW
from geom import build_mesh, load_machine
from viz import QUARTER, Sensor, split
from viz.machine.parts import ASIDE
from viz.machine.thermocouples import LABELS, marked
from viz.rendering.cut import cut_away
from viz.rendering.ghost import RADIUS, SLACK
from viz.rendering.scene import View

VIEWS = {
    "default": View(),
    "other side": View((1.0, 0.42, 0.62)),
    "aside": ASIDE,
    "below": View((-1.0, -0.5, -0.4)),
    "portrait": VIEW,
    "viewer": View((-0.79, 0.34, 0.51)),
}
WIDE = 0.25  # of a whole window: half of it even between two neighbours, and more than its sensor's dot covers


def placed(root):
    """Case -> machine and sensors: name -> (m), part."""
    out = {}
    for file in sorted(root.glob("cases/**/case.toml")):
        known = {}
        for sheet in sorted(file.parent.glob("tests/*.toml")):
            for name, column in tomllib.loads(sheet.read_text()).get("columns", {}).items():
                if "position_mm" in column:
                    known[name] = (np.array(column["position_mm"]) / 1e3, column["place"])
        if known:
            out[file.parent.name] = (tomllib.loads(file.read_text())["case"]["machine"], known)
    return out


@pytest.fixture(scope="module")
def cases(request):
    found = placed(request.config.rootpath)
    assert "road-test" in found
    return {
        name: (cut_away(split(build_mesh(load_machine(machine), 0.15)), QUARTER), known)
        for name, (machine, known) in found.items()
    }


@pytest.mark.parametrize(
    "view", [pytest.param(v, marks=[] if v == "default" else [pytest.mark.nightly]) for v in VIEWS]
)
def test_every_label_points_at_its_own_part(cases, view):
    """Six labels at a time, as pictures have them; so many rounds that every sensor has had one."""
    for surface, known in cases.values():
        eye, size = eye_of(surface.points, VIEWS[view]), np.linalg.norm(np.ptp(surface.nodes.points, axis=0))
        names = list(known)
        for first in range(0, len(names), LABELS):
            chosen = names[first : first + LABELS]
            weights = {name: 10.0 if name in chosen else 0.1 for name in names}
            sensors = [Sensor(name, tuple(known[name][0]), weights[name]) for name in names]
            seen = marked(surface, sorted(sensors, key=lambda s: -s.weight), LABELS, eye)
            assert {s.name for s in seen.labelled} >= set(chosen)
            for name in chosen:
                at, part = first_hit(seen.cut.solid, eye, known[name][0])
                assert np.linalg.norm(at - known[name][0]) < SLACK, name
                assert part == known[name][1], name
            for one in seen.cut.windows:
                assert outlined(one.rim) > WIDE * np.pi * (RADIUS * size) ** 2


def outlined(rim):
    """Area inside a flat closed line through (n, 3) points (m2)."""
    return np.linalg.norm(np.cross(rim, np.roll(rim, -1, axis=0)).sum(axis=0)) / 2
