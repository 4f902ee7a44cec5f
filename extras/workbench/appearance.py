"""Everything the page lists and draws of one model but the machine: errors and curves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from thermoscope import plugin as th


@dataclass(frozen=True)
class Appearance:
    """errors : a `compare` document;  curves : test -> readings and model"""

    errors: Mapping[str, Any]
    curves: Mapping[str, th.Comparison]

    @property
    def limits(self) -> dict[str, dict[str, float]]:
        """Test -> channel -> the largest error that counts as agreement (K)."""
        return {name: dict(comparison.limits) for name, comparison in self.curves.items()}

    def test(self, name: str) -> Mapping[str, Any]:
        """The errors of one test."""
        return next(t for t in self.errors["tests"] if t["name"] == name)


def appearance_of(folder: th.Folder) -> Appearance:
    """Run the model on every test."""
    errors = folder.compared.document()  # first: what it finds serves the curves
    return Appearance(errors, {test.name: th.comparison_of(folder, test) for test in folder.case.tests})
