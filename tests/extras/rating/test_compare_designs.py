"""Designs side by side: what differs in their files, what they weigh, and which is better at the same surroundings."""

import tomllib
from importlib import import_module
from pathlib import Path

import pytest

from extras.rating.commands.compare_designs import Designs, compare_designs, designs_summary, dimensions, masses
from geom import load_machine, part_table
from geom.errors import InputError

PLATE, FREE = "pmsm-m1-plate", "pmsm-m1-no-base"


def test_what_differs_is_the_base_and_what_the_files_say_of_it():
    rows = dimensions([load_machine(PLATE), load_machine(FREE)])
    assert rows
    assert {row["parameter"].rpartition(".")[0] for row in rows} == {"geometry.base"}
    assert dimensions([load_machine(PLATE)] * 2) == []


def test_masses_by_material_are_those_of_the_parts():
    machine = load_machine(FREE)
    rows = {row.name: row for row in part_table(machine)}
    assert sum(masses(machine).values()) == pytest.approx(sum(rows[p.name].mass for p in machine.parts), rel=1e-9)


def two_designs():
    def described(name, value, hottest):
        rating = {"form": "S1", "input": "current_A", "value": value, "ci95": None, "at": "winding"}
        known = {"name": name, "hottest": [{"place": "winding", "degC": hottest}], "rating": rating, "settles": True}
        known |= {"masses_kg": {"steel": 10.0}, "pump_and_fan_W": 5.0, "asks_for_bands": False}
        return {**known, "inputs": {"current_A": 20.0}}

    designs = [described("a", 20.0, 130.0), described("b", 22.0, 120.0)]
    return {"dimensions": [], "boundaries": {"ambient": 40.0}, "designs": designs}


def test_the_better_one_is_named_first():
    document = two_designs()
    assert designs_summary(document).sentence.startswith("b carries most: current_A = 22, limited by winding.")
    document["designs"][1]["asks_for_bands"] = True
    assert "The rating of b has no band yet: --bands reads" in designs_summary(document).parts[1]
    for one in document["designs"]:
        one["rating"] = None
    assert designs_summary(document).sentence.startswith("b stays coolest: 120.0 degC")
    document["designs"][0]["settles"] = False
    assert designs_summary(document).sentence.startswith("a does not settle")


def test_a_script_gets_the_same_tables():
    """Also as `ts.compare_designs`, which the extra offers by an entry point."""
    designs = Designs(two_designs())
    assert "Assumed of all: ambient 40 degC." in repr(designs)
    assert "<table>" in designs._repr_html_()
    assert list(designs.to_frame().columns) == ["", "a", "b"]
    offered = tomllib.loads(Path("pyproject.toml").read_text())["project"]["entry-points"]["thermoscope.names"]
    module, _, name = offered["compare_designs"].removeprefix("thermoscope.").partition(":")
    assert getattr(import_module(module), name) is compare_designs


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([FREE], "two to 6"),
        ([FREE] * 7, "two to 6"),
        ([FREE, "pmsm-m2-no-base", "--picture", "designs.jpg"], "NAME.png"),
    ],
)
def test_what_makes_no_sense_is_refused(thermoscope, words, said):
    refused = thermoscope("use", "compare-designs", *words)
    assert (refused.code, said in refused.err) == (2, True), refused.err


@pytest.mark.nightly
def test_two_motors_side_by_side(thermoscope):
    """The longer stack loses less heat per volume; what surrounds them is the same."""
    found = thermoscope(*("use", "compare-designs", FREE, "pmsm-m2-no-base", "--limit", "winding=130", "--json", "-"))
    assert found.code == 0, found.err
    long, short = found.document["designs"]
    assert sum(long["masses_kg"].values()) > sum(short["masses_kg"].values())
    assert found.document["boundaries"]["ambient"] == 40.0
    assert all(d["rating"]["value"] > 0.0 for d in (long, short))
    low, high = long["rating"]["ci95"]
    assert low < long["rating"]["value"] < high, "of its priors, however many states it has"


def test_every_design_is_there_before_the_first_is_built(monkeypatch):
    monkeypatch.setattr("extras.rating.commands.compare_designs.case_or_machine", lambda *_: pytest.fail("built"))
    with pytest.raises(InputError, match=r"pmsm-m9.*pmsm-m"):
        compare_designs("pmsm-m1", "pmsm-m9")
