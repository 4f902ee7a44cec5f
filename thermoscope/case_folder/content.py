"""What a result of a case depends on, as keys of files that are kept: its tests, its model, and the code."""

import hashlib
import inspect
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Protocol

import numpy as np

from geom.arrays import Array
from geom.plugins import plugins
from lumped.condensation.recovery import Shapes
from measured.case import Test
from thermoscope.case_folder.settings import Settings
from validation.comparison.error_budget import OpenCase

ROOMS = ("geom", "fem", "lumped", "measured", "validation", "thermoscope")  # packages that decide what a model tells
ADDED = ("effects", "families", "formats", "quantities", "still_air", "moving_air")  # groups that others add to


class CaseWithFiles(OpenCase, Protocol):
    """An open case and where it lies."""

    @property
    def settings(self) -> Settings: ...


def digest(*pieces: object) -> str:
    """A key of bytes and arrays by their content, of anything else by its repr."""
    content = hashlib.sha256()
    for piece in pieces:
        if isinstance(piece, np.ndarray):
            content.update(np.ascontiguousarray(piece).data)
        else:
            content.update(piece if isinstance(piece, bytes) else repr(piece).encode())
    return content.hexdigest()[:20]


def case_key(folder: CaseWithFiles) -> str:
    """Of everything that decides: the case's files, its recordings, the machine, and what was calibrated."""
    settings, model = folder.settings, folder.case.model
    # Those of columns_of as well
    sheets = {sheet for e in settings.tests if e.sheet for sheet in Path(e.sheet).parent.glob("*.toml")}
    files = [settings.path / "case.toml", settings.network, *(e.file for e in settings.tests), *sorted(sheets)]
    texts = [Path(file).read_bytes() for file in files if file is not None and Path(file).is_file()]
    machine = () if folder.built is None else (folder.built.machine.sections, folder.built.mesh.points)
    fitted = (model.effects, sorted(model.values.items()), model.revision, model.reference)
    return digest(fitted, *texts, *recorded_arrays(folder.case.tests), *machine)


def recorded_arrays(tests: Iterable[Test]) -> Iterator[Array]:
    """Times, inputs, boundaries and readings of tests."""
    for test in tests:
        arrays = (test.time, *test.inputs.values(), *test.boundaries.values(), *(c.y for c in test.channels))
        yield from (np.asarray(array) for array in arrays)


def result_key(folder: CaseWithFiles, *rooms: str) -> str:
    """The same with the shapes of the network, what was answered, and the text of the code.

    rooms : packages that decide it besides ROOMS
    """
    shapes = folder.case.model.network.recovery
    parts = [part.V for part in shapes.parts.values()] if isinstance(shapes, Shapes) else []
    return digest(case_key(folder), sorted(folder.case.answers.items()), *parts, code_digest(*ROOMS, *rooms))


@cache
def code_digest(*rooms: str) -> bytes:
    """A digest of all modules and tables of these packages, and of those that hold what other packages add."""
    content = hashlib.sha256()
    for file in [*_modules(rooms), *_added()]:
        content.update(file.read_bytes())
    return content.digest()


def _modules(rooms: tuple[str, ...]) -> Iterator[Path]:
    for room in rooms:
        spec = find_spec(room)
        for home in (spec and spec.submodule_search_locations) or ():
            yield from sorted(file for file in Path(home).rglob("*.*") if file.suffix in (".py", ".csv"))


def _added() -> Iterator[Path]:
    for group in ADDED:
        for _, thing in sorted(plugins(group).items()):
            module = inspect.getmodule(thing)
            if module is not None and module.__file__ is not None:
                yield Path(module.__file__)
