"""Everything the page shows of one model: errors, curves, temperatures on the surface."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.runs import comparison_of, fields

if TYPE_CHECKING:
    from viz.data import Comparison
    from viz.rendering.cut import Surface

FRAMES = 25  # of a test that the slider stops at
Frames = tuple[NDArray[np.float64], NDArray[np.float32]]


@dataclass(frozen=True)
class Appearance:
    """errors : a `compare` document;  curves : test -> readings and model

    frames : test -> times (n,) s and temperatures (n, n_points) degC on the surface, empty without a machine
    """

    errors: Mapping[str, Any]
    curves: Mapping[str, Comparison]
    frames: Mapping[str, Frames]

    def test(self, name: str) -> Mapping[str, Any]:
        """The errors of one test."""
        return next(t for t in self.errors["tests"] if t["name"] == name)


def appearance_of(folder: Folder, surface: Surface | None) -> Appearance:
    """Run the model on every test."""
    errors = folder.compared.document()  # first: what it finds serves the curves
    curves = {test.name: comparison_of(folder, test) for test in folder.case.tests}
    frames: dict[str, Frames] = {}
    if surface is not None:
        for test in folder.case.tests:
            times, T = fields(folder.case, test, surface.nodes, FRAMES)
            frames[test.name] = times, surface.values(T.T).T.astype(np.float32)
    return Appearance(errors, curves, frames)
