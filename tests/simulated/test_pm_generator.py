"""The generator of the PM machines' tests: meters err as their data sheets allow, files tell nothing that is hidden."""

import numpy as np
import pytest

from simulated.physics.draws import Draws
from simulated.physics.materials import nominal_contact
from simulated.physics.surfaces import Conditions
from simulated.pm import files as pm_files
from simulated.pm.plant import contacts, draw

AT_REST = Conditions(8.0, 64.0, 0.0, 0.0, 0.0, 20.0)


@pytest.mark.parametrize(
    ("kind", "true", "gain", "offset", "step"), [("ohm", 2.8, 0.25e-2, 2e-3, 2e-3), ("volt", 290, 1e-3, 1.0, 0.1)]
)
def test_meters_stay_within_their_data_sheet(kind, true, gain, offset, step):
    draws = Draws(7)
    errors = [float(pm_files.read(kind, true, f"s{i}", draws)) - true for i in range(200)]
    limit = gain * true + offset
    assert max(np.abs(errors)) <= limit + step / 2
    assert max(np.abs(errors)) > 0.7 * limit
    assert abs(np.mean(errors)) < 0.2 * limit


def test_one_session_has_one_error():
    """A meter's error does not change between readings of one session, only the steps remain."""
    draws, true = Draws(7), np.linspace(2.7, 3.5, 50)
    off = pm_files.read("ohm", true, "hot", draws) - true
    line = np.polyval(np.polyfit(true, off, 1), true)
    assert np.abs(off - line).max() < 2e-3
    again = pm_files.read("ohm", true, "hot", draws) - true
    assert np.array_equal(off, again)


def test_back_emf_falls_with_the_magnets():
    assert pm_files.emf(290.0, -1e-3, 120.0) == pytest.approx(261.0)


def test_films_of_still_air():
    """At 40 K natural convection of 2 to 7 W/m2/K and, painted, as much by radiation; air gap 2 k / gap at rest."""

    class Geometry:
        class stator:  # noqa: N801
            outer_diameter, bore_diameter, air_gap = 0.27, 0.174, 1e-3

    films = draw(Draws(3), Geometry, "bench")
    T = np.array([60.0])
    body = float(films.coefficient("stator.core", "ambient", T, 20.0, AT_REST)[0])
    base = float(films.coefficient("base", "ambient", T, 20.0, AT_REST)[0])
    assert 6.0 < body < 15.0
    assert base < body
    gap = float(films.coefficient("rotor.core", "airgap", T, 60.0, AT_REST)[0]) / films.factors["airgap"]
    assert gap == pytest.approx(2 * (0.0243 + 7.1e-5 * 60) / 1e-3)


def test_both_ends_are_alike_and_draws_belong_to_their_names():
    found = contacts(["bearing.left|shaft", "bearing.right|shaft", "base|foot"], Draws(31))
    assert found["bearing.left|shaft"] == found["bearing.right|shaft"]
    assert nominal_contact("pm", "base|foot") == 500.0
    assert found == contacts(["base|foot", "bearing.right|shaft", "bearing.left|shaft"], Draws(31))


def test_sheets_say_what_was_written_down_and_no_more():
    cold = {"cold_ohm": 2.754, "cold_V": 288.6, "cold_degC": 22.1}
    tables = pm_files.sheet("bench", "bench", 8.0, cold, 21.9)
    assert tables["inputs"] == {"on_plate": 0, "on_bench": 1}
    assert tables["columns"]["R_bench"]["cold"]["reading"] == 2.754
    assert tables["columns"]["emf_bench"]["place"] == "magnets"


@pytest.mark.parametrize("folder", ["pmsm-bases", "pmsm-machines/m2", "pmsm-machines/m3"])
def test_cases_do_not_tell_the_truth(root, folder):
    for path in (root / "cases" / folder).rglob("*.toml"):
        text = path.read_text(encoding="utf-8")
        for word in ("truth", "hidden", "drawn", "base_path"):
            assert word not in text, path
