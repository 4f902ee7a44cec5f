"""The error budget as a table: place by place the run in which most is left."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from geom.table import Table
from validation.tables import budget_table

if TYPE_CHECKING:
    from thermoscope.case_folder.folder import Folder

Places = Sequence[Mapping[str, Any]]
Steps = Mapping[str, Mapping[str, Any]]
LEAST_K = 0.001  # below it a number only says that arithmetic is exact; no thermometer shows as much


def sampling(folder: "Folder") -> dict[str, dict[str, Any]]:
    """The step at which every test is looked at, and what that leaves, for a document."""
    return {"sampling": {name: step.document() for name, step in folder.steps.items()}}


def budget(budgets: Mapping[str, Places], steps: Steps) -> list[Table | str]:
    """budgets : run -> places;  steps : test -> sample step, both as in the documents"""
    from measured.sensors.sampling import SampleStep, sampled

    rows = sorted(worst(budgets), key=_total, reverse=True)
    sampling = [sampled({name: SampleStep(**step) for name, step in steps.items()})] if steps else []
    return [budget_table(rows), words(rows), *sampling] if rows else [*sampling]


def in_short(budgets: Mapping[str, Places], steps: Steps) -> str:
    """The largest sum and the sample steps in a sentence."""
    rows, every = worst(budgets), sorted({step["step_s"] for step in steps.values()})
    ends = dict.fromkeys(f"{float(f'{h:.3g}'):g}" for h in (*every[:1], *every[-1:]))
    sampling = f"compared every {' to '.join(ends)} s" if every else ""
    if not rows:
        return f"Readings and model are {sampling}." if sampling else ""
    most = max(rows, key=_total)
    if _total(most) < LEAST_K:
        good = f"The model's own numbers are good to less than {LEAST_K:g} K"
    else:
        good = f"The model's own numbers are good to {_total(most):.2g} K (worst at {most['place']})"
    return f"{good}, {sampling}." if sampling else f"{good}."


def worst(budgets: Mapping[str, Places]) -> list[Mapping[str, Any]]:
    """Of every place the run with the largest sum."""
    largest: dict[str, Mapping[str, Any]] = {}
    for row in (row for places in budgets.values() for row in places):
        if row["place"] not in largest or _total(row) > _total(largest[row["place"]]):
            largest[row["place"]] = row
    return list(largest.values())


def _total(row: Mapping[str, Any]) -> float:
    return float(row["total_K"] or 0.0)


def words(rows: Places) -> str:
    """What a missing number means."""
    meshless = all(row["mesh_K"] is None for row in rows)
    field = "a declared network has no mesh and nothing is condensed; " if meshless else ""
    has_time = any(row["time_K"] is not None for row in rows)
    time = "time steps as the integrator estimates them" if has_time else "nothing estimates the time steps here"
    return f"error budget: {field}{time}; an effect that changes no sensor by more cannot be told from it"
