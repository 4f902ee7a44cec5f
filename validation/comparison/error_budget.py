"""The error budget of a case's runs: mesh by a coarser second mesh, condensation by the field, time by the integrator.

Mesh and condensation are looked at once, at the machine's rated point, and kept; in a run they grow with its rise.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from lumped.condensation.error_budget import ErrorBudget, MonitoredPlaces, PlaceError
from lumped.condensation.recovery import Shapes
from lumped.integration.simulate import Record, simulate
from lumped.model.multipliers import multipliers
from lumped.model.network import Network, Row
from measured.case import Channel, Test
from validation.comparison.predict import heat_model, record
from validation.parameters.unknowns import standing
from validation.threads import run_by_run

if TYPE_CHECKING:
    from lumped.build.pipeline import Built
    from lumped.build.rated_errors import Rated
    from measured.case import Case


Progress = Callable[[str], None]


class OpenCase(Protocol):
    """A case with its model.  positions : sensor -> (x, y, z) m where known;  built : where it comes from a machine"""

    @property
    def case(self) -> "Case": ...
    @property
    def positions(self) -> Mapping[str, Sequence[float]]: ...
    @property
    def built(self) -> "Built | None": ...


def monitored_places(folder: OpenCase) -> MonitoredPlaces:
    """The sensors of a case."""
    channels: dict[str, Channel] = {c.name: c for test in folder.case.tests for c in test.channels}
    at = {name: np.array(xyz) for name, xyz in folder.positions.items() if name in channels}
    return MonitoredPlaces({n: c.row for n, c in channels.items()}, {n: c.place for n, c in channels.items()}, at)


def error_budgets(folder: OpenCase, records: Mapping[str, Record], progress: Progress) -> dict[str, ErrorBudget]:
    """Run -> what its temperatures may be wrong by, for the model as it stands."""
    looks, rated = monitored_places(folder), None
    network, values = model_of(folder)
    rows = dict(looks.rows)
    if folder.built is not None and isinstance(network.recovery, Shapes):  # only then the field's packages are loaded
        from lumped.build.rated_errors import cached_errors, hot_rows

        progress("checking mesh and condensation")
        rated = cached_errors(folder.built, looks, multipliers(network, values))
        rows |= hot_rows(network, rated)
    progress("estimating the error of the time steps")
    each = run_by_run(lambda run: _of_run(network, values, run, rows, rated), list(records.values()), network.size)
    return dict(zip(records, each, strict=True))


def budgets_of(folder: OpenCase, tests: Sequence[Test]) -> dict[str, ErrorBudget]:
    """Test -> its budget."""
    return error_budgets(folder, {test.name: record(test, {}) for test in tests}, lambda message: None)


def model_of(folder: OpenCase) -> tuple[Network, dict[str, float]]:
    """The network with the effects added, and the values of the parameters that act on heat."""
    return heat_model(standing(folder.case), folder.case.model.values)


def _of_run(
    network: Network, values: Mapping[str, float], run: Record, rows: Mapping[str, Row], rated: "Rated | None"
) -> ErrorBudget:
    course = simulate(network, run, values, list(rows.values()))
    time_K = getattr(course, "time_error_K", None)
    late = dict.fromkeys(rows) if time_K is None else dict(zip(rows, np.asarray(time_K, float).tolist(), strict=True))
    if rated is None:
        return ErrorBudget(tuple(PlaceError(name, None, None, late[name]) for name in rows))
    around = np.min([np.broadcast_to(u, run.time.shape) for u in run.boundaries.values()], axis=0)
    warm = float(np.abs(course.y - around[:, None]).max()) / rated.rise_K
    fixed = {name: (warm * rated.mesh_K[name], warm * rated.condensation_K[name]) for name in rows}
    return ErrorBudget(tuple(PlaceError(name, *fixed[name], late[name]) for name in rows))


def documents(budgets: Mapping[str, ErrorBudget]) -> dict[str, Any]:
    """As the commands write it: place by place, run by run."""
    return {name: budget.document() for name, budget in budgets.items()}
