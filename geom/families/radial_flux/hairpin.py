"""Hairpin windings: rectangular bars in layers, each layer a part of its own, and end turns by pitch and height.

Layer 1 lies at the bottom of the slot, the last at its opening. A slot has one bar in each layer, its faces along the
circles between the layers; enamel and resin around it are no solids but contacts (lumped.machine.hairpin).
"""

import math

from geom.description import shapes
from geom.description.geometry import Bars, Geometry
from geom.description.part import Part, extrude
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.fit import Fit, mm
from geom.families.radial_flux.layout import Layout, SlotLayout


def layer_height(g: Geometry) -> float:
    """From layer to layer (m), what lies in the slot shared evenly."""
    at = SlotLayout(g)
    return (at.wire1 - at.wire0) / g.winding.layers


def bar_room(g: Geometry) -> float:
    """Width (m) between the liners, at the slot opening, where a tapered slot is narrowest."""
    at = SlotLayout(g)
    return at.width(at.wire0, at.lining)


def enamel_room(g: Geometry) -> float:
    """What bars leave beside them, or half of what they leave between them, the smaller (m)."""
    return min(bar_room(g) - g.winding.bar_width, layer_height(g) - g.winding.bar_height) / 2


def least_end(g: Geometry) -> float:
    """Height (m) at which slanted end turns of one layer, as far apart as their slots, lie side by side.

    With slot pitch t and insulated width b they rise at asin(b / t), over half the angle that an end turn spans.
    """
    if g.winding.kind != "hairpin":
        return 0.0
    at = SlotLayout(g)
    rise = min((g.winding.bar_width + 2 * g.winding.enamel) * g.stator.slots / (2 * math.pi * at.wire0), 0.99)
    return g.winding.pitch / 2 * at.wire0 * rise / math.sqrt(1 - rise**2)


def bars(g: Geometry) -> Bars:
    """The bars and the slot around them, layer by layer."""
    at, w, high = SlotLayout(g), g.winding, layer_height(g)
    middle = [at.wire1 - (k + 0.5) * high for k in range(w.layers)]
    return Bars(
        tuple(f"winding.layer-{k + 1}" for k in range(w.layers)),
        ("winding.left", "winding.right"),
        "slot.liner",
        w.bar_width,
        w.bar_height,
        w.enamel,
        high,
        tuple(at.width(r, at.lining) for r in middle),
        tuple(at.width(r) for r in middle),
    )


def check_bars(fit: Fit, g: Geometry) -> None:
    """Bars, enamel and end turns find room."""
    layers = g.winding.layers
    fit.below(layer_height(g), "winding.bar_height", f": {layers} layers lie between liner and liner")
    fit.below(bar_room(g), "winding.bar_width", ", the slot's width between the liners")
    fit.need(g.winding.enamel <= enamel_room(g), "winding.enamel", f"at most {enamel_room(g) * mm:.4g} mm")
    least = least_end(g)
    fit.need(g.winding.end >= least, "winding.end", f"at least {least * mm:.4g} mm: end turns cut each other below")


def hairpin(g: Geometry, at: Layout, angles: list[float], wires: list[Profile], cells: list[Profile]) -> list[Part]:
    """Bars in the stack, and end turns.  wires : what each slot holds;  cells : the layers of the slot along +x"""
    w, section = g.winding, g.winding.bar_width * g.winding.bar_height
    out = []
    for name, cell in zip(bars(g).layers, cells, strict=True):
        prisms = extrude(shapes.turned(cell, angles), at.core0, at.core1)
        out.append(Part(name, "hairpin", prisms, (section / cell.area, w.impregnation), role=Role.WINDING))
    ring = shapes.ring(at.wire0, at.wire1)
    # Wire of a layer from the stack to the top of its end turn, and how much of it runs along the axis
    slant = [math.hypot(w.end, (at.wire1 - (k + 0.5) * layer_height(g)) * w.pitch / 2) for k in range(w.layers)]
    wire = w.layers * w.straight + sum(slant)
    along = (w.layers * w.straight + sum(w.end**2 / s for s in slant)) / wire
    fill = section * len(angles) * wire / (sum(slot.area for slot in wires) * w.straight + ring.area * w.end)
    for side, straight, turns in (
        ("left", (at.coil0, at.core0), (at.ring0, at.coil0)),
        ("right", (at.core1, at.coil1), (at.coil1, at.ring1)),
    ):
        prisms = (*extrude(wires, *straight), (ring, *turns))
        loose = (fill, w.end_impregnation, along)
        out.append(Part(f"winding.{side}", "end-winding", prisms, loose, role=Role.WINDING))
    return out
