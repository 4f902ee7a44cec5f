"""thermoscope show film CASE"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from geom.arrays import Array
from geom.description.names import file_stem
from geom.errors import InputError
from thermoscope.case_folder import runs
from thermoscope.case_folder.folder import Folder
from thermoscope.commands.open_case import needs_geometry, open_case
from thermoscope.console.options import Case as CaseName, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, progress
from thermoscope.parts import required

if TYPE_CHECKING:
    from measured.case import Case, Test
    from viz.data import Sensor

FRAMES = 44  # of one run of the test: with two runs eight seconds
SUFFIXES = (".gif", ".mp4")


def film(
    case: CaseName,
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="A GIF or MP4 file.")] = None,
    target: Json = None,
) -> int:
    """The machine warming up in its most telling test, before and after the model's last step."""
    if out is not None and (out.suffix not in SUFFIXES or out.is_dir()):
        raise InputError("is not a name of a film", f"--out {out}", "a file NAME.gif or NAME.mp4")
    needs_geometry(case)
    required(("pyvista", "PIL", *(("imageio_ffmpeg",) if out is not None and out.suffix == ".mp4" else ())))
    with progress() as tell:
        from viz import animate, require_gl

        require_gl()  # before anything is run
        folder = open_case(case, tell)
        test, earlier = runs.by_interest(folder)[0], runs.before_last(folder)
        nodes = runs.nodes_of(folder, test)
        file = out or Path("out") / f"{file_stem(folder.case.name)}.gif"
        before, now = model_words(folder)
        models = {now: folder.case} if earlier is None else {before: earlier, now: folder.case}
        tell(f"running {test.name}")
        played = {words: runs.fields(model, test, nodes, FRAMES) for words, model in models.items()}
        limit_K = folder.limits(test)
        sensors = [row for w, model in models.items() for row in misses(folder, model, test, played[w][0], limit_K)]
        when = [(t, w) for w, (times, _) in played.items() for t in times]
        titles = [title(test, t, w, row) for (t, w), row in zip(when, sensors, strict=True)]
        T, limits = np.concatenate([values for _, values in played.values()]), runs.temperature_range(folder, nodes)

        def tell_number(number: int) -> None:
            tell(f"drawing picture {number}/{len(T)}")

        animate(nodes, [t for t, _ in when], T, file, titles=titles, sensors=sensors, limits=limits, tell=tell_number)
    give({"case": folder.case.name, "film": str(file)}, target, lambda: Summary(f"{file}"))
    return 0


def model_words(folder: Folder) -> tuple[str, str]:
    """The model before its last step and as it is, in words: by what the step added, where it added something."""
    last = folder.history.last
    if last.action != "add":
        return "the model before its last step", "the model now"
    added = runs.step_words(folder.case, last)
    return f"without {added}", f"with {added}"


def title(test: Test, time: float, words: str, sensors: Sequence[Sensor]) -> str:
    """Which test, which instant (s), which model, and what that misses most."""
    return f"{runs.instant_words(test, time)}, {words}{largest(sensors)}"


def largest(sensors: Sequence[Sensor]) -> str:
    """The sensor that the model misses by most, and by how much; nothing where it misses none."""
    from viz.data import short
    from viz.labels import signed

    wrong = [s for s in sensors if s.verdict in ("hot", "cold")]
    worst = max(wrong, key=lambda s: s.weight, default=None)
    if worst is None or worst.residual_K is None:
        return ""
    return f": {short(worst.name)} {signed(worst.residual_K)} K"


def misses(
    folder: Folder, model: Case, test: Test, times: Array, limit_K: Mapping[str, float]
) -> list[tuple[Sensor, ...]]:
    """At each of the times (s): the sensors with a place, and what is missed there of those over in the whole test."""
    from viz.data import Sensor

    read, at = runs.readings(model, test), np.searchsorted(test.time, times).clip(0, len(test.time) - 1)
    left = {c.name: c.y - read[c.name] for c in test.channels if c.name in folder.positions}
    rms = {name: float(np.sqrt(np.nanmean(r**2))) for name, r in left.items()}
    within = {name: error for name, error in rms.items() if error <= limit_K[name]}

    def one(name: str, i: int) -> Sensor:
        x, y, z = folder.positions[name]
        return Sensor(name, (x, y, z), float(left[name][i]), limit_K[name], within.get(name))

    return [tuple(one(name, i) for name in left) for i in at]
