"""thermoscope show film CASE"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geom.errors import InputError
from thermoscope.case_folder.runs import before_last, fields
from thermoscope.commands.open_case import open_case
from thermoscope.commands.show.pages import by_interest
from thermoscope.console.answer import Answer
from thermoscope.console.terminal import give, progress

FRAMES = 40  # of one run of the test: three seconds
SUFFIXES = (".gif", ".mp4")


def film(case: str, out: Path | None, target: str | None) -> int:
    """The most telling test on the machine; with the model before its last step first, if there is one."""
    if out is not None and (out.suffix not in SUFFIXES or out.is_dir()):
        raise InputError("is no name of a film", f"--out {out}", "a file NAME.gif or NAME.mp4")
    with progress() as tell:
        from viz import animate, split

        folder = open_case(case, tell)
        if folder.built is None:
            right = f"a case with a machine; or: thermoscope show picture {folder.settings.path} curves"
            raise InputError("has a network declared by hand, and so no geometry", folder.case.name, right)
        nodes, test, earlier = split(folder.built.mesh), by_interest(folder)[0], before_last(folder)
        file = out or Path("out") / f"{folder.case.name}.gif"
        runs = {} if earlier is None else {"before the last step": earlier}
        tell(f"running {test.name}")
        played = {words: fields(model, test, nodes, FRAMES) for words, model in (runs | {"now": folder.case}).items()}
        titles = [f"{test.name} at {t / 60:.0f} min: model {w}" for w, (times, _) in played.items() for t in times]
        T = np.concatenate([values for _, values in played.values()])
        animate(nodes, [t for times, _ in played.values() for t in times], T, file, titles=titles,
                tell=lambda k: tell(f"drawing picture {k}/{len(T)}"))  # fmt: skip
    give({"case": folder.case.name, "film": str(file)}, target, lambda: Answer(f"{file}"))
    return 0
