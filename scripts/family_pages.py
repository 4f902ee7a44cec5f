"""Writes a page for every family, docs/families/NAME.md: the drawing of its default machine, and its parameters.

python -m scripts.family_pages
"""

from pathlib import Path

from geom.description.geometry import Geometry
from geom.description.parameters import Parameter
from geom.description.reading import usual_geometry
from geom.families.family import Family
from geom.machine_file import families, library, load_machine, machine_from
from scripts.drawing import drawing_of
from scripts.published import table

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "families"

_JACKETS = (
    "Jackets in the mesh and in CAD files: channels around the axis are rings in the mesh, in the table of "
    "areas and in the drawing. In STEP, STL and GLB they are a helix of the same pitch, width, ribs and volume; its "
    "wetted area is within 2 % of the rings'. It widens against the end walls where it begins and ends, and "
    "takes up to 0.8 ribs from them. Ports are square in the mesh and round in CAD files, with bores of the "
    "same cross-section. `NAME-prisms.step` holds what is meshed; `build` reads it back.",
    "",
)
_MEASURED = (
    "These lengths are measured in others. A file gives the ratio, or the length itself with `_mm`, or neither: then "
    "it has the default machine's proportion, so that what is not given follows what is. Any ratios within their "
    "bounds, with any of the parameters above, make a machine that fits; a length that does not fit is refused with "
    "its key and what it must be. The message ends with one length out of proportion and a value for it: with that the "
    "machine fits, or, where it says *is a beginning*, after others. "
    "`geom.families.random_geometry.random_geometry` draws machines, `benchmarks/families.py` checks them.",
    "",
)

EVERY = "volumes, masses and areas of the parts, from their profiles; the heat balance of a solution on the mesh"
FILMS = "[its films at 200 operating points each](../benchmarks.md#random-operating-points)"
TRUST = {  # family -> what is exact, what is assumed, what it was held against
    "series-dc": (
        EVERY,
        "windings as mixtures of copper and resin; brushes take half of what slides; each space of air has one "
        "temperature",
        "[ratings and curves of a published 100 kW motor](../papers/series-dc-cooling.md), whose measured temperatures "
        f"are not published; {FILMS}; [a road test](../data-road-test.md) that another model simulates",
    ),
    "pmsm": (
        EVERY,
        "windings as mixtures of copper and resin, or layers of bars; end turns as a ring or arches; each space of air "
        "has one temperature",
        "[a published procedure of three machines](../papers/thermal-test-procedure.md); exact cells of wires; "
        f"Dowell's closed form for the loss of [bars](../how-to/hairpin.md); {FILMS}",
    ),
    "tefc": (
        EVERY,
        "bars and rings of the cage as one body; all dimensions, as no measured machine of this kind is in the library",
        f"Mellor's closed form of a machine's cylinders (1991); {FILMS}",
    ),
    "cross-section": (
        f"{EVERY}; arcs as they are drawn, in the mesh as chords",
        "frame, end turns, contacts and losses where a drawing or another program's file has none",
        "closed forms of slots, magnets and holes; a sleeve as a cylindrical shell (0.06 %); "
        "[machines that come with pyleecan](../how-to/import.md#pyleecan)",
    ),
}


def family_page(family: Family, picture: str) -> str:
    """Markdown; `picture` is the path of the drawing as seen from the page."""
    shipped = ", ".join(f"`{name}`" for name in library() if load_machine(name).family == family.name)
    machines = f" Machines in the library: {shipped}." if shipped else ""
    free, measured = (_rows(family, scaled) for scaled in (False, True))
    rows = zip(("exact", "assumed", "held against"), TRUST[family.name], strict=True)
    return "\n".join(
        [
            f"# Family `{family.name}`",
            "",
            f"{family.doc}.{machines}",
            "",
            f"![Sections across and along the axis of the default machine, mm]({picture})",
            "",
            *(_JACKETS if any(p.name == "port_mm" for p in family.parameters) else ()),
            "A key ending in `_mm` or `_deg` carries that unit; one without is a count, a share or a word.",
            "",
            table(["parameter", "default", "allowed", "meaning"], free),
            "",
            *_MEASURED,
            table(["ratio", "default", "allowed", "or", "default", "allowed", "meaning"], measured),
            *_outlines(family),
            "",
            "## How far to trust it",
            "",
            table(["", "what"], rows),
            "",
        ]
    )


def _outlines(family: Family) -> list[str]:
    """What [[outlines.NAME]] may draw."""
    if not family.outlines:
        return []
    rows = ((f"`[[outlines.{name}]]`", words) for name, words in family.outlines.items())
    words = (
        "Shapes in the plane, each group `copies` times around the axis: `loops_mm` is a list of shapes, each a list "
        "of points `[x, y]` or `[x, y, bulge]` in mm, drawn around +x; a bulge, as in DXF, is tan(sweep / 4) of the "
        "edge that leaves the point. Shapes may touch, not cut each other. `thermoscope model import` writes such "
        "files ([import](../how-to/import.md))."
    )
    return ["", "## Outlines", "", words, "", table(["shapes", "are"], rows)]


def _rows(family: Family, measured: bool) -> list[tuple[object, ...]]:
    usual = usual_geometry(family.parameters)
    parameters = [p for p in family.parameters if (p.of is not None) == measured]
    return [_measured(p, usual) if measured else (f"`{p.key}`", p.default, p.allowed, p.doc) for p in parameters]


def _measured(p: Parameter, usual: Geometry) -> tuple[object, ...]:
    assert p.of is not None
    ratio = (p.usual - p.of.start(usual)) / p.of.span(usual) if p.default else 0.0
    length = (f"`{p.name}`", p.default, p.allowed, p.doc)
    return (f"`{p.group}.{p.ratio_name}`", f"{ratio:.3g}", p.allowed_ratio, *length)


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


if __name__ == "__main__":
    write_pages(FOLDER)
