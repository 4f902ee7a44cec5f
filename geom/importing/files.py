"""Which importer reads a file: by its name's ending. The draft is tried as a machine before anyone writes it."""

from __future__ import annotations

from pathlib import Path

from geom.errors import InputError
from geom.importing.assumptions import USUAL_TEMPLATE
from geom.importing.draft import Draft
from geom.importing.motor_cad import read_motor_cad
from geom.importing.pyleecan import read_pyleecan

IMPORTERS = {".json": read_pyleecan, ".mot": read_motor_cad}


def import_draft(path: Path, family_template: str = USUAL_TEMPLATE) -> Draft:
    """The machine file in the making. Raises InputError for files of other kinds, and for what is wrong in them."""
    reader = IMPORTERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(
            f"{path.suffix or 'no ending'} is no machine file of another program",
            str(path),
            f"one of: {', '.join(IMPORTERS)}",
        )
    return reader(path, family_template)
