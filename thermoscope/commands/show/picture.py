"""thermoscope show picture CASE WHAT"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

import viz as viz  # so named in the wheel as well
from geom.arrays import Array
from geom.description.names import file_stem
from geom.errors import InputError
from geom.plugins import plugins
from lumped.integration.balance import balance
from lumped.schemas.reader import suggestion
from measured.case import Case, Test
from thermoscope.bands import field_half95, posterior_of, predicted_bands
from thermoscope.case_folder import runs
from thermoscope.case_folder.error_field import error_gain, last_fifth
from thermoscope.case_folder.folder import Folder, Progress
from thermoscope.case_folder.runs import readings
from thermoscope.commands.open_case import last_diagnosis, open_case
from thermoscope.console.options import Case as CaseName, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, progress
from validation.comparison.interpolation import Interpolated
from validation.comparison.predict import heat_model, record
from validation.parameters.unknowns import standing
from viz.data import LATE

if TYPE_CHECKING:
    from lumped.build.pipeline import Built
    from viz.data import Comparison, Sensor
    from viz.figures.flows import Heat
    from viz.rendering.nodes import SplitMesh


def picture(
    case: CaseName,
    what: Annotated[
        str,
        typer.Argument(
            metavar="WHAT",
            help="machine, temperature, field, difference, misses, uncertainty, exploded, parts, mesh, flux, network, "
            "losses, curves, bands, residuals, errors, odds or sizes.",
        ),
    ],
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="A PNG file.")] = None,
    target: Json = None,
) -> int:
    """One picture: of the temperatures, the parts, the heat, or the model against its most telling test."""
    pictures = {**PICTURES, **plugins("pictures")}
    if what not in pictures:
        raise InputError(f"unknown picture '{what}'", "show picture", suggestion(what, pictures))
    if out is not None and (out.suffix != ".png" or out.is_dir()):
        raise InputError("is not a name of a picture", f"--out {out}", "a file NAME.png")
    with progress() as tell:
        subject = Subject(open_case(case, tell), tell)
        if what in PICTURES and what not in FLAT:
            subject.require_drawing()
        file = out or Path("out") / f"{file_stem(subject.folder.case.name)}-{what}.png"
        tell(f"drawing {file}")
        pictures[what](subject, file)
    give({"case": subject.folder.case.name, "picture": what, "file": str(file)}, target, lambda: Summary(f"{file}"))
    return 0


@dataclass(frozen=True)
class Subject:
    """What pictures are drawn of: a case, and the test that tells most, a never-used one if there is one."""

    folder: Folder
    tell: Progress

    @cached_property
    def test(self) -> Test:
        return runs.by_interest(self.folder)[0]

    @property
    def when(self) -> str:
        return runs.instant_words(self.test, self.test.time[-1])

    @property
    def built(self) -> "Built":
        if self.folder.built is None:
            right = f"a case with a machine, or one of: {', '.join(FLAT)}"
            raise InputError("has a network declared by hand, and so no geometry", self.folder.case.name, right)
        return self.folder.built

    def require_drawing(self) -> None:
        """InputError without geometry, MissingDependency without OpenGL: said before anything is run."""
        _ = self.built
        viz.require_gl()

    @cached_property
    def nodes(self) -> "SplitMesh":
        return runs.nodes_of(self.folder, self.test)

    @property
    def comparison(self) -> "Comparison":
        """The test against the model."""
        return runs.comparison_of(self.folder, self.test)

    @property
    def sensors(self) -> "tuple[Sensor, ...]":
        """Those with a position."""
        return viz.sensors(self.comparison, self.folder.positions)

    @property
    def sensors_before(self) -> "tuple[Sensor, ...]":
        """The same against the model before its last step; none where there was none."""
        now = self.comparison
        return () if now.before is None else viz.sensors(replace(now, model=now.before), self.folder.positions)

    @cached_property
    def limits(self) -> tuple[float, float]:
        """Of the colours (degC)."""
        return runs.temperature_range(self.folder, self.nodes)

    def field(self, case: Case | None = None) -> Array:
        """(n_nodes,) degC at the end of the test."""
        return np.asarray(runs.fields(case or self.folder.case, self.test, self.nodes, 1)[1][-1])

    def heat(self) -> tuple["Heat", dict[str, float], str]:
        """Heat flows, and node -> degC, when the machine last runs in the test; and when that is."""
        from viz.figures.flows import heat_flows, last_running_step

        case, test = self.folder.case, record(self.test, {})
        network, values = heat_model(standing(case), case.model.values)
        heat = balance(network, test, values)
        step = last_running_step(network, heat)
        when = runs.instant_words(self.test, heat.time[step + 1])
        means = dict(zip([*network.states, *network.boundaries], heat.z[step + 1].tolist(), strict=True))
        return heat_flows(network, heat, step), means, when


def draw_field(s: Subject, png: Path) -> None:
    """The machine cut open, coloured by its temperature; sensors are labelled by what the model misses."""
    title = f"{s.when}: temperature of the model"
    viz.cutaway(s.nodes, s.field(), sensors=s.sensors, title=title, limits=s.limits, note=LATE, png=png).close()


def _difference(s: Subject, png: Path) -> None:
    earlier = runs.before_last(s.folder)
    if earlier is None:
        what = "has a model that was not changed yet, so there is no difference"
        raise InputError(what, s.folder.case.name, "a case with a revision: thermoscope model calibrate or add")
    title = f"{s.when}: after minus before the last step"
    viz.difference(s.nodes, s.field(earlier), s.field(), title=title, png=png).close()


def _misses(s: Subject, png: Path) -> None:
    test = s.test
    channels, gain = error_gain(s.folder, test, s.nodes)
    model, late = readings(s.folder.case, test), last_fifth(test)
    residual_K = [float(np.nanmean((np.asarray(c.y, float) - model[c.name])[late])) for c in channels]
    error = Interpolated(gain.mean @ np.array(residual_K), gain.explained)
    title = f"{s.test.name}, its last fifth: measured minus model"
    viz.misses(s.nodes, error.mean, error.explained, sensors=s.sensors, title=title, png=png).close()


def _uncertainty(s: Subject, png: Path) -> None:
    half95 = field_half95(s.folder, s.test, s.nodes.parts, s.tell)
    viz.uncertainty(s.nodes, half95, sensors=s.sensors, title=f"{s.when}: 95 % band of the model", note=LATE, png=png)


def _bands(s: Subject, png: Path) -> None:
    network, test = standing(s.folder.case), s.test
    bands = predicted_bands(
        posterior_of(s.folder, s.tell), test.name, record(test, {}), runs.named_rows(network, s.folder)
    )
    read, measured = {f"sensor {c.name}": c.y for c in test.channels}, {c.place for c in test.channels}
    each = [(n, bands.y[:, k], bands.half95[:, k], read.get(n)) for k, n in enumerate(bands.names) if n not in measured]
    viz.predicted(bands.time, [viz.Predicted(*one) for one in each], title=test.name, png=png)


def _flux(s: Subject, png: Path) -> None:
    from lumped.build.pipeline import conductivity_of

    machine = s.built.machine
    k: dict[str, Any] = {part.name: conductivity_of(machine.material_of(part.name)) for part in machine.parts}
    viz.flux_arrows(s.nodes, s.field(), k, title=f"{s.when}: heat flux;", limits=s.limits, png=png).close()


def _network(s: Subject, png: Path) -> None:
    flows, means, when = s.heat()
    viz.network_in_machine(s.built.mesh, means, flows, title=f"{when}: heat flows;", limits=s.limits, png=png).close()


def _losses(s: Subject, png: Path) -> None:
    flows, _, when = s.heat()
    viz.sankey_of_losses(flows, title=f"{when}: losses, and where they go", png=png)


def _odds(s: Subject, png: Path) -> None:
    diagnosis = last_diagnosis(s.folder)
    if diagnosis is None:
        right = f"first: thermoscope explain diagnose {s.folder.settings.path}"
        raise InputError("was not diagnosed yet", s.folder.case.name, right)
    viz.posterior(diagnosis["explanations"], title=f"{s.folder.case.name}: what the readings say", png=png)


def _parts(s: Subject, png: Path, mesh: bool = False) -> None:
    what = "mesh" if mesh else "parts"
    viz.regions(s.nodes, mesh=mesh, title=f"{s.built.machine.name}: its {what}", png=png).close()


FLAT: dict[str, Callable[[Subject, Path], Any]] = {
    "curves": lambda s, png: viz.measured_and_model(s.comparison, png=png),
    "bands": _bands,
    "residuals": lambda s, png: viz.residuals(s.comparison, png=png),
    "errors": lambda s, png: viz.staircase(runs.steps(s.folder), png=png),
    "losses": _losses,
    "odds": _odds,
    "sizes": lambda s, png: viz.intervals(runs.parameters(s.folder), png=png),
}
PICTURES: dict[str, Callable[[Subject, Path], Any]] = {
    "field": draw_field,
    "difference": _difference,
    "misses": _misses,
    "uncertainty": _uncertainty,
    "exploded": lambda s, png: viz.exploded(
        s.nodes, s.field(), title=f"{s.when}: pulled apart", limits=s.limits, png=png
    ).close(),
    "parts": _parts,
    "mesh": partial(_parts, mesh=True),
    "flux": _flux,
    "network": _network,
    **FLAT,
}
