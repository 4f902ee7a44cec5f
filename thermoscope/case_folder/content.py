"""What a result of a case depends on, as keys of files that are kept: its tests, its model, and the code."""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geom.plugins import plugins
from lumped.condensation.recovery import Shapes

if TYPE_CHECKING:
    from measured.case import Test
    from thermoscope.case_folder.folder import Folder

Array = NDArray[np.float64]
ROOMS = ("geom", "fem", "lumped", "measured", "validation", "thermoscope")  # packages that decide what a model tells
ADDED = ("effects", "families", "formats", "quantities", "still_air", "moving_air")  # groups that others add to


def case_key(folder: Folder) -> str:
    """Of everything that decides: the case's files, its recordings, the machine, and what was calibrated."""
    settings, model = folder.settings, folder.case.model
    content = hashlib.sha256(
        repr((model.effects, sorted(model.values.items()), model.revision, model.reference)).encode()
    )
    files = [settings.path / "case.toml", settings.network, *(f for e in settings.tests for f in (e.file, e.sheet))]
    for file in files:
        if file is not None and Path(file).is_file():
            content.update(Path(file).read_bytes())
    for array in recorded_arrays(folder.case.tests):
        content.update(np.ascontiguousarray(array).tobytes())
    if folder.built is not None:
        content.update(repr(folder.built.machine.sections).encode())
        content.update(np.ascontiguousarray(folder.built.mesh.points).tobytes())
    return content.hexdigest()[:20]


def recorded_arrays(tests: Iterable[Test]) -> Iterator[Array]:
    """Times, inputs, boundaries and readings of tests."""
    for test in tests:
        yield from (test.time, *test.inputs.values(), *test.boundaries.values(), *(c.y for c in test.channels))


def result_key(folder: Folder, *rooms: str) -> str:
    """The same with the shapes of the network, what was answered, and the text of the code.

    rooms : packages that decide it besides ROOMS
    """
    content = hashlib.sha256(repr((case_key(folder), sorted(folder.case.answers.items()))).encode())
    shapes = folder.case.model.network.recovery
    if isinstance(shapes, Shapes):
        for part in shapes.parts.values():
            content.update(np.ascontiguousarray(part.V).tobytes())
    content.update(code_digest(*ROOMS, *rooms))
    return content.hexdigest()[:20]


@cache
def code_digest(*rooms: str) -> bytes:
    """A digest of all modules of these packages, and of those that hold what other packages add."""
    content = hashlib.sha256()
    for file in [*_modules(rooms), *_added()]:
        content.update(file.read_bytes())
    return content.digest()


def _modules(rooms: tuple[str, ...]) -> Iterator[Path]:
    for room in rooms:
        spec = find_spec(room)
        for home in (spec and spec.submodule_search_locations) or ():
            yield from sorted(Path(home).rglob("*.py"))


def _added() -> Iterator[Path]:
    for group in ADDED:
        for _, thing in sorted(plugins(group).items()):
            module = inspect.getmodule(thing)
            if module is not None and module.__file__ is not None:
                yield Path(module.__file__)
