"""What is built again when something changes: counted, not timed."""

from dataclasses import replace

import pytest

from geom import check_cad, export_cad
from geom.machine_file import machine_from
from geom.solids.cad import solids


@pytest.fixture
def built(monkeypatch):
    """Names of the parts whose solids are built, as it happens."""
    from geom.solids import cad

    names, build = [], cad._built
    monkeypatch.setattr("geom.solids.cad._built", lambda part: names.append(part.name) or build(part))
    return names


def tefc(materials=None, **geometry):
    table = {"machine": {"family": "tefc"}, "geometry": geometry, "materials": materials or {}}
    return machine_from({**table, "geometry": {"base": {"kind": "none"}, **geometry}})


@pytest.fixture(scope="module")
def filled_cache(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cad")
    for part in tefc().parts:
        solids(part, folder)
    return folder


def test_nothing_is_built_twice(filled_cache, built):
    for part in tefc().parts:
        solids(part, filled_cache)
    assert built == []


def test_changed_parameter_rebuilds_only_what_depends_on_it(filled_cache, built):
    for part in tefc(housing={"fins": 38}).parts:
        solids(part, filled_cache)
    assert built == ["housing"]


def test_kept_solids_are_the_same(filled_cache):
    for part in tefc().parts:
        volume = sum(solid.Volume() for solid in solids(part, filled_cache)) * 1e-9
        assert volume == pytest.approx(part.volume, rel=1e-9), part.name


def test_checks_and_exports_share_the_kept_solids(built, tmp_path):
    machine = tefc()
    small = replace(machine, parts=tuple(machine.part(name) for name in ("shaft", "endcap.left", "bearing.left")))
    first = check_cad(small, cache=tmp_path / "kept")
    export_cad(small, tmp_path / "out", ("step",), cache=tmp_path / "kept")
    assert check_cad(small, cache=tmp_path / "kept") == first
    assert built == ["shaft", "endcap.left", "bearing.left"]
