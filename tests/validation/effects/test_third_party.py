"""Somebody else's effect: a package with an entry point, found, placed, scored and added like our own."""

import re
import sys
import tomllib
from dataclasses import replace

import pytest
from everything import machine, scene, warm_test

from validation.comparison.predict import predict


@pytest.fixture
def acme(root, tmp_path, monkeypatch):
    """What docs/how-to/own-effect.md shows, as an installer leaves it: a module, and metadata with its entry point."""
    page = (root / "docs" / "how-to" / "own-effect.md").read_text()
    module, project = re.findall(r"```(?:python|toml)\n(.*?)```", page, re.DOTALL)
    (tmp_path / "acme_effects.py").write_text(module)
    info = tmp_path / "acme_effects-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-effects\nVersion: 1.0\n")
    points = tomllib.loads(project)["project"]["entry-points"]["thermoscope.effects"]
    lines = ["[thermoscope.effects]", *(f"{name} = {target}" for name, target in points.items())]
    (info / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(tmp_path))
    yield tmp_path
    sys.modules.pop("acme_effects", None)


def test_it_is_in_the_catalogue_where_it_can_sit(acme):
    from validation.effects import catalogue, kinds

    assert "acme.sun" in kinds()
    assert [e.name for e in catalogue(scene(machine())) if e.kind == "acme.sun"] == ["acme.sun@housing"]


def test_it_warms_what_it_shines_on(acme):
    from validation.effects import effect

    net = machine()
    bigger = effect("acme.sun@housing", scene(net)).extend(net)
    p = bigger.parameters[-1]
    test = warm_test(net)
    test = replace(test, channels=tuple(c for c in test.channels if c.name == "housing"))
    assert predict(bigger, test, {}, [p]).J[-1, 0, 0] > 0.0
    assert predict(bigger, test, {p.name: 50.0}).y[-1, 0] > predict(net, test, {}).y[-1, 0]
