"""docs/reference/quantities.md: quantities, their units and what memory holds; every effect; from the code.

python scripts/quantities.py    writes the page
"""

from pathlib import Path

from measured.recordings.units import MEMORY_UNIT, QUANTITIES
from validation.effects.registry import kinds

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "quantities.md"
HEAD = """# Quantities and effects

## What a column may measure
`thermoscope test quantities` prints this table. Files may use any unit of the table, or another one of the same
dimension (`ft/min`). Memory holds one unit for each quantity.

| quantity | units | memory holds | input that a column drives by itself |
|---|---|---|---|
"""
EFFECTS = """
## Effects
`thermoscope explain effects CASE` says where each of these could sit in a case, and which input or role the rest lack.

| effect | what it is | sits at | needs columns of |
|---|---|---|---|
"""


def page() -> str:
    """The page as Markdown."""
    rows = [
        f"| `{n}` | {', '.join(q.units)} | {MEMORY_UNIT[n]} | {q.feeds} |"
        for n, q in QUANTITIES.items()
        if n in MEMORY_UNIT
    ]
    builtin_kinds = {name: kind for name, kind in kinds().items() if kind.__module__.startswith("validation.")}
    effects = [f"| `{n}` | {k.title} | {k.sits} | {', '.join(k.needs)} |" for n, k in builtin_kinds.items()]
    return HEAD + "\n".join(rows) + "\n" + EFFECTS + "\n".join(effects) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
