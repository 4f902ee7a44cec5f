"""A family's page for the docs: the drawing of its default machine and the table of its parameters."""

from __future__ import annotations

from pathlib import Path

from geom.drawing import drawing_of
from geom.families import families
from geom.families.family import Family
from geom.machine import library, load_machine, machine_from


def family_page(family: Family, picture: str) -> str:
    """Markdown; `picture` is the path of the drawing as seen from the page."""
    shipped = [name for name in library() if load_machine(name).family == family.name]
    rows = [f"| `{p.key}` | {p.default} | {p.allowed} | {p.doc} |" for p in family.parameters]
    return "\n".join([
        f"# Family `{family.name}`",
        "",
        f"{family.doc}. Machines in the library: {', '.join(f'`{name}`' for name in shipped)}.",
        "",
        f"![Sections across and along the axis of the default machine, mm]({picture})",
        "",
        "A key ending in `_mm` or `_deg` carries that unit; one without is a count, a ratio or a word.",
        "",
        "| parameter | default | allowed | meaning |",
        "|---|---|---|---|",
        *rows,
        "",
    ])  # fmt: skip


def write_pages(folder: Path | str) -> list[Path]:
    """One page and one drawing per family; returns the pages."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    pages = []
    for name, family in families().items():
        (folder / f"{name}.svg").write_text(drawing_of(machine_from({"machine": {"family": name}}, name)))
        page = folder / f"{name}.md"
        page.write_text(family_page(family, f"{name}.svg"))
        pages.append(page)
    return pages
