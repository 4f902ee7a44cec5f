"""docs/reference/limits.md: what a file may ask for, and how to raise it.

python -m scripts.limits_page    writes the page
"""

from __future__ import annotations

from pathlib import Path

from geom.limits import LIMITS

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "limits.md"
HEAD = """# Limits

What a file asks for is counted before anything of that size is kept in memory. Beyond a limit the command stops with
exit code 2, names the limit, and leaves nothing behind. To raise one, set its environment variable to a whole number:

```sh
THERMOSCOPE_MOST_ROWS=20000000 thermoscope test compare CASE
```

| limit | usual | variable | what it bounds, and why this number |
|---|---|---|---|
"""


def limits_table() -> str:
    """The limits as rows of a Markdown table."""
    rows = (f"| `{x.name}` | {x.usual:,} | `{x.variable}` | {x.unit} {x.why} |" for x in LIMITS)
    return "\n".join(rows)


def page() -> str:
    """The page as Markdown."""
    return f"{HEAD}{limits_table()}\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
