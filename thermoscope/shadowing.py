"""Is a package of the house hidden by a file or folder of the same name that Python finds first?"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

ROOMS = ("geom", "fem", "lumped", "validation", "viz")
HOME = Path(__file__).resolve().parent.parent


def hidden_by(room: str) -> str | None:
    """The file that Python takes for a package of the house; None where it is the house's own."""
    loaded = sys.modules.get(room)
    spec = find_spec(room) if loaded is None else loaded.__spec__
    places: Sequence[str] = () if spec is None else [spec.origin or "", *(spec.submodule_search_locations or ())]
    if spec is None or any(HOME / room in (path := Path(p).resolve()).parents or path == HOME / room for p in places):
        return None
    return next(filter(None, places), room)


def checked_rooms() -> None:
    """Raises ImportError, one message, where a package of the house is hidden."""
    for room in ROOMS:
        file = hidden_by(room)
        if file is not None:
            raise ImportError(
                f"'{room}' is found at {file}, which hides the package of that name that comes with thermoscope: "
                "give the file or folder another name, or run from another folder"
            )
