"""A family's page for the docs: the drawing of its default machine and the table of its parameters."""

from __future__ import annotations

from pathlib import Path

from geom.drawing import drawing_of
from geom.families import families
from geom.families.family import Family
from geom.machine import library, load_machine, machine_from

_JACKETS = (
    "Jackets in the mesh and in CAD files: channels around the axis are rings in the mesh, in the table of "
    "areas and in the drawing, and a helix of the same pitch, width, ribs and volume in STEP, STL and GLB; its "
    "wetted area is within 2 % of the rings'. It widens against the end walls where it begins and ends, and "
    "takes up to 0.8 ribs from them. Ports are square in the mesh and round in CAD files, with bores of the "
    "same cross-section. `NAME-prisms.step` holds what is meshed; `build` reads it back.",
    "",
)


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
        *(_JACKETS if any(p.name == "port_mm" for p in family.parameters) else ()),
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
