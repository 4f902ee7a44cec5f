"""thermoscope test quantities"""

from __future__ import annotations

from geom.table import Table
from measured.recordings.units import MEMORY_UNIT, QUANTITIES
from thermoscope.console.options import Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give


def quantities(target: Json = None) -> int:
    """What a column may measure, in which units, and what memory holds."""
    rows = [
        {"quantity": name, "units": list(q.units), "held_as": MEMORY_UNIT[name], "input": q.feeds}
        for name, q in QUANTITIES.items()
    ]
    table = Table.of("", rows, "quantity | units | held as=held_as | input it drives=input")
    sentence = f"A column measures one of {len(rows)} quantities; other units of the same dimension are read as well."
    give({"quantities": rows}, target, lambda: Summary(sentence, [table], "docs/reference/quantities.md"))
    return 0
