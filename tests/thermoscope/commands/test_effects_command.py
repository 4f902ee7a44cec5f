"""What the diagnosis knows, where it could sit, and what is missing for the rest; the page made from it."""

import json

from measured.recordings.units import MEMORY_UNIT, QUANTITIES, converted
from scripts.quantities import PAGE, page
from thermoscope.commands.explain.effects import effects
from thermoscope.commands.test.doctor import quantities
from validation.effects.registry import kinds


def asked(run, tmp_path, *arguments):
    target = tmp_path / "document.json"
    assert run(*arguments, str(target)) == 0
    return json.loads(target.read_text())


def test_every_effect_says_where_it_sits_and_what_is_missing(case, tmp_path, capsys):
    rows = {e["effect"]: e for e in asked(effects, tmp_path, str(case))["effects"]}
    assert set(rows) == set(kinds())
    assert all(e["places"] or e["missing"] for e in rows.values())
    assert "flange" in rows["convection"]["places"]
    assert rows["windage"]["missing"][0] == "a column of speed (input speed_rpm)"
    assert "a part with role commutator" not in rows["convection"]["missing"]


def test_a_recorded_speed_is_no_longer_missing(case, tmp_path, capsys):
    for sheet in (case / "tests").glob("*.toml"):
        sheet.write_text(sheet.read_text().replace('"vehicle_speed"\nunit = "km/h"', '"speed"\nunit = "rpm"'))
    rows = {e["effect"]: e for e in asked(effects, tmp_path, str(case))["effects"]}
    assert not any("speed_rpm" in word for word in rows["windage"]["missing"])


def test_quantities_and_what_memory_holds(tmp_path, capsys):
    rows = {q["quantity"]: q for q in asked(quantities, tmp_path)["quantities"]}
    assert set(rows) == set(QUANTITIES) == set(MEMORY_UNIT)
    for name, row in rows.items():
        if name != "share":
            assert float(converted(7.0, name, row["held_as"])) == 7.0


def test_the_page_is_up_to_date():
    """After a change of quantities or effects: python scripts/quantities.py"""
    assert PAGE.read_text(encoding="utf-8") == page()
