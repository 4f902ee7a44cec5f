"""The rooms under one name: `thermoscope.geom` is `geom`.

In an installed package they lie inside of it. In a checkout they are folders beside it; there their names inside the
package are made here, and a file or folder of the user's that Python finds first in place of a room is told.
"""

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

ROOMS = ("geom", "fem", "lumped", "measured", "validation", "viz", "extras")
PACKAGE = Path(__file__).resolve().parent
HOME = PACKAGE.parent


class Beside(MetaPathFinder, Loader):
    """Imports `thermoscope.geom.errors` as the module `geom.errors`, which stays one module with one name."""

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        package, _, name = fullname.partition(".")
        return ModuleSpec(fullname, self) if package == __package__ and name.partition(".")[0] in ROOMS else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = import_module(spec.name.partition(".")[2])
        spec.loader_state = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """It ran when it was created; Python has given it a spec of its second name meanwhile."""
        assert module.__spec__ is not None
        module.__spec__ = module.__spec__.loader_state


def hidden_by(room: str) -> str | None:
    """The file that Python takes for a package of the house; None where it is the house's own."""
    loaded = sys.modules.get(room)
    spec = find_spec(room) if loaded is None else loaded.__spec__
    places: Sequence[str] = () if spec is None else [spec.origin or "", *(spec.submodule_search_locations or ())]
    if spec is None or any(HOME / room in (path := Path(p).resolve()).parents or path == HOME / room for p in places):
        return None
    return next(filter(None, places), room)


def register_rooms() -> None:
    """Lets the rooms be imported. Raises ImportError, one message, where one of a checkout is hidden."""
    if all(PACKAGE.joinpath(room).is_dir() for room in ROOMS):
        return
    for room in ROOMS:
        file = hidden_by(room)
        if file is not None:
            raise ImportError(
                f"'{room}' is found at {file}, which hides the package of that name that comes with thermoscope: "
                "give the file or folder another name, or run from another folder"
            )
    sys.meta_path.insert(0, Beside())  # before what would find a second copy of its file
