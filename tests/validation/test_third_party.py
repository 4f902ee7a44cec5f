"""Somebody else's effect: a package with an entry point, found, placed, scored and added like our own."""

import subprocess
import sys
from dataclasses import replace

import pytest
from everything import machine, scene, warm_test

from validation.predict import predict

MODULE = '''
from dataclasses import dataclass

from lumped.laws import Fixed
from validation.effects.base import Effect, with_parameter
from validation.effects.build import heat


@dataclass(frozen=True)
class Sun(Effect):
    """Sunshine on the housing, a watts."""

    kind = "acme.sun"
    title = "sunshine"
    unit = "W"
    source = "definition"
    isolating_test = "shade it"
    typical = (5.0, 50.0)
    prior_sd = 20.0
    high = 200.0
    confused_with = ("loss.constant",)

    @classmethod
    def where(cls, scene):
        return [p for p in scene.network.places if p == "housing"]

    def extend(self, network):
        source = heat(network, self.name, "constant", self.place, Fixed(1.0))
        return with_parameter(network.extended(sources=[source]), self.parameter(source.name))
'''


@pytest.fixture
def acme(tmp_path, monkeypatch):
    """The package as an installer leaves it: a module, and its metadata with one entry point."""
    (tmp_path / "acme_effects.py").write_text(MODULE)
    info = tmp_path / "acme_effects-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-effects\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[thermoscope.effects]\nsun = acme_effects:Sun\n")
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


def test_without_the_package_there_is_no_trace_of_it():
    code = "from validation.effects import kinds; print('acme.sun' in kinds())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "False", done.stderr
