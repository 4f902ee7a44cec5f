"""The library at a glance: what every shipped machine is, weighs and measures, how it is cooled, where it is from."""

import re
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path

from geom.description.machine import Machine
from geom.description.roles import Role
from geom.drawings.views import Views, middle_level
from geom.machine_file import library, load_machine


@dataclass(frozen=True)
class Entry:
    """One machine: number of parts, mass (kg), envelope (length, width, height, m), cooling and source in words."""

    name: str
    family: str
    description: str
    parts: int
    mass: float
    envelope: tuple[float, float, float]
    cooling: str
    source: str
    assumed: str


def catalogue() -> list[Entry]:
    """All machines of the library, by name."""
    out = []
    for m in map(load_machine, library()):
        mass = sum(part.volume * m.material_of(part.name).rho for part in m.parts)
        size, words = (len(m.parts), mass, m.extent), (cooling_of(m), m.source, m.assumed)
        out.append(Entry(m.name, m.family, m.description, *size, *words))
    return out


def cooling_of(machine: Machine) -> str:
    """How the machine loses its heat, in words."""
    table, ways = machine.sections.get("cooling", {}), []
    jackets = [fluid for fluid in machine.fluids if fluid.material != "air"]
    if jackets:
        flow = f", {table['flow_L_per_min']:g} L/min" if "flow_L_per_min" in table else ""
        ways.append(f"{' and '.join(jacket.name for jacket in jackets)} with {jackets[0].material}{flow}")
    flow = machine.sections.get("fans", {}).get("flow_m3_h")
    ways += [f"fan, {flow:g} m3/h through the machine"] if flow else []
    housing = getattr(machine.geometry, "housing", None)
    fins = getattr(housing, "fins", 0)
    kind = getattr(housing, "kind", "axial-fins" if fins else "none")
    ways += [f"{fins} {kind.replace('-', ' ')}"] if kind.endswith("fins") else []
    base = getattr(getattr(machine.geometry, "base", None), "kind", "")
    ways += ["base plate"] if base == "plate" else []
    return "; ".join(ways) or "still air"


def write_library(folder: Path | str) -> Path:
    """`library.md` and a thumbnail per machine; returns the page."""
    folder = Path(folder)
    (folder / "thumbnails").mkdir(parents=True, exist_ok=True)
    rows = []
    for entry in catalogue():
        (folder / "thumbnails" / f"{entry.name}.svg").write_text(thumbnail_of(load_machine(entry.name)))
        size = " x ".join(f"{1e3 * length:.0f}" for length in entry.envelope)
        numbers = f"{entry.source}; assumed: {entry.assumed}"
        name = f"`{entry.name}` ([{entry.family}]({entry.family}.md)): {entry.description}"
        picture = f"![Sections across and along the axis of {entry.name}](thumbnails/{entry.name}.svg)"
        rows.append(f"| {picture} | {name} | {entry.parts} | {entry.mass:.1f} | {size} | {entry.cooling} | {numbers} |")
    page = folder / "library.md"
    page.write_text("\n".join([*_HEAD, *rows, ""]))
    return page


_HEAD = [
    "# Machines of the library",
    "",
    "Written by `geom.write_library`. `thermoscope model build NAME` builds one.",
    "",
    "| | machine | parts | mass (kg) | length x width x height (mm) | cooling | numbers |",
    "|---|---|---|---|---|---|---|",
]


def thumbnail_of(machine: Machine) -> str:
    """A small SVG of the section across the axis and the section along it, without dimensions.

    Framed on the machine; a base plate that reaches further is cut off.
    """
    views = Views(machine, middle_level(machine))
    framed = Views(replace(machine, parts=tuple(part for part in machine.parts if part.role is not Role.BASE)), views.z)
    margin = 0.04 * framed.width
    low, high, z0, z1 = (end + side * margin for end, side in zip((*views.heights, *framed.span), (-1, 1, -1, 1)))
    wide = framed.width + 2 * margin
    text = "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide + margin + z1 - z0:.1f} {high - low:.1f}" '
            'width="320" height="160">',
            f"<title>{escape(machine.name)}</title>",
            *_window(0.0, -wide / 2, -high, wide, high - low, views.across()),
            *_window(wide + margin, z0, -high, z1 - z0, high - low, views.along()),
            "</svg>\n",
        ]
    )
    return re.sub(r"(\.\d)\d+", r"\1", text)


def _window(at: float, x: float, y: float, width: float, height: float, shapes: list[str]) -> list[str]:
    """What of the shapes lies in a rectangle, drawn from `at` on."""
    sides = f'x="{at:.1f}" width="{width:.1f}" height="{height:.1f}" viewBox="{x:.1f} {y:.1f} {width:.1f} {height:.1f}"'
    return [f"<svg {sides}>", *shapes, "</svg>"]
