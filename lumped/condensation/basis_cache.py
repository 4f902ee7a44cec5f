"""Shapes found once, kept by the content they belong to, and found again for nearby coefficients."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geom.disk_cache import recalled, stored

Floats = NDArray[np.floating]
Pairs = dict[str, tuple[Floats, Floats]]
WEAKEST = 1e-7  # energy of the weakest field kept: tolerance 3e-4


@dataclass(frozen=True)
class Centre:
    """The coefficients shapes were found at: films, contacts (W/m2/K), trace of each part's conduction (W/K)."""

    films: Mapping[str, float]
    contacts: Mapping[str, float]
    conduction: Mapping[str, float]

    @property
    def values(self) -> Floats:
        return np.log([v for m in (self.films, self.contacts, self.conduction) for v in m.values()])


@dataclass(frozen=True)
class BasisCache:
    """folder : None keeps nothing;  content : bytes of all that the shapes depend on besides the coefficients"""

    folder: Path | None
    content: Iterable[bytes]

    def find(self, centre: Centre, spread: float) -> Pairs | None:
        """part -> (strength, fields) of the nearest centre within a factor `spread` in every coefficient."""
        files = [] if self.folder is None else sorted(self.folder.glob(f"shapes-{self._key}-*.npz"))
        far = {file: d for file in files if (d := recalled(file, lambda path: _distance(path, centre))) is not None}
        near = sorted((file for file, d in far.items() if d <= np.log(spread) + 1e-9), key=lambda file: far[file])
        return recalled(near[0], _pairs) if near else None

    def keep(self, centre: Centre, bases: Mapping[str, Any], least: float = WEAKEST) -> Pairs:
        """What is worth keeping of principal fields, in single precision, written if there is a folder."""
        strong = {part: p.strength > min(least, WEAKEST) for part, p in bases.items()}
        pairs = {p: (bases[p].strength[s], bases[p].fields[:, s].astype(np.float32)) for p, s in strong.items()}
        if self.folder is None:
            return pairs
        out: dict[str, Any] = {"centre": centre.values}
        out |= {f"{part}/strength": strength for part, (strength, _) in pairs.items()}
        out |= {f"{part}/fields": fields for part, (_, fields) in pairs.items()}
        point = hashlib.sha256(centre.values.round(9).tobytes()).hexdigest()[:8]
        file = self.folder / f"shapes-{self._key}-{point}.npz"
        with stored(file) as partial:
            np.savez(partial, **out)
        return pairs

    @property
    def _key(self) -> str:
        h = hashlib.sha256()
        for piece in self.content:
            h.update(piece)
        return h.hexdigest()[:20]


def _distance(file: Path, centre: Centre) -> float:
    """Largest logarithm of a coefficient's ratio to that of a kept centre."""
    with np.load(file) as archive:
        return float(np.abs(archive["centre"] - centre.values).max())


def _pairs(file: Path) -> Pairs:
    with np.load(file) as archive:
        parts = [name.removesuffix("/strength") for name in archive.files if name.endswith("/strength")]
        return {part: (archive[f"{part}/strength"], archive[f"{part}/fields"]) for part in parts}
