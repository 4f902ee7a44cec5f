"""Markers on the machine, each with a label beside the machine at the end of a leader line."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from viz.colours import LIGHT, Theme
from viz.labels import spread_labels
from viz.rendering.scene import SIZE, View, set_font

if TYPE_CHECKING:
    import pyvista

SMALL = 15  # letters of a label
LINE = 1.9  # of its letters' size from one label to the next: its ground is 1.8 of it high
GAP = 0.03  # share of the picture's width from the machine to a label, and from a label to the edge
HOLLOW = 0.42  # of the diameter of a dot that something covers is left white


@dataclass(frozen=True)
class Label:
    """A text at the end of a leader line that starts at `xyz` (m), at a hollow dot if that is covered."""

    xyz: tuple[float, float, float]
    text: str
    colour: str
    covered: bool = False


def callouts(
    p: "pyvista.Plotter",
    labels: Sequence[Label],
    points: Array,
    view: View,
    theme: Theme = LIGHT,
    size: int = SMALL,
    dots: bool = True,
) -> None:
    """Markers on the machine with labels beside it, in the order of their heights so that lines seldom cross.

    The camera must stand.  points : (n, 3) m that the labels stand beside;  dots : draw the markers too
    """
    import pyvista

    towards, right, up = view.axes()
    across, above = points @ right, points @ up
    front = (points @ towards).max()
    middle = (across.max() + across.min()) / 2
    for side in (-1, 1):
        mine = sorted(
            (q for q in labels if (np.dot(q.xyz, right) > middle) == (side > 0)), key=lambda q: np.dot(q.xyz, up)
        )
        step = max(0.075 * np.ptp(above), LINE * size * pixel(p))
        more = max(0.0, step * (len(mine) - 1) - np.ptp(above)) / 2  # labels of a flat machine reach above and below it
        places = [float(np.dot(q.xyz, up)) for q in mine]
        heights = spread_labels(places, above.min() - more, above.max() + more, step)
        edge = middle + side * (0.5 + 0.03) * np.ptp(across)
        for q, height in zip(mine, heights, strict=True):
            end = edge * right + height * up + front * towards
            line = p.add_mesh(pyvista.Line(q.xyz, end), color=theme.ink, line_width=2.0, opacity=0.8, lighting=False)
            draw_on_top(line, 1)
            p.add_actor(text(q.text, end, q.colour, side, size), reset_camera=False, pickable=False)
            if dots:
                dot(p, q)


def pixel(p: "pyvista.Plotter") -> float:
    """What a pixel is high where the camera looks (m)."""
    far = np.linalg.norm(np.subtract(p.camera.position, p.camera.focal_point))
    return float(2 * far * np.tan(np.deg2rad(p.camera.view_angle) / 2) / p.window_size[1])


def dot(p: "pyvista.Plotter", label: Label, size: float = 1.0) -> None:
    """A marker without a label, `size` times as large as one with a label."""
    import pyvista

    flat: dict[str, Any] = {"lighting": False, "render_points_as_spheres": True}
    here = pyvista.PolyData(np.array([label.xyz]))
    draw_on_top(p.add_mesh(here, color="white", point_size=26 * size, **flat), 2)
    draw_on_top(p.add_mesh(here.copy(), color=label.colour, point_size=19 * size, **flat), 3)
    if label.covered:
        draw_on_top(p.add_mesh(here.copy(), color="white", point_size=HOLLOW * 19 * size, **flat), 4)


def width(text: str, size: int) -> float:
    """Share of the picture's width that a label of that size takes, about."""
    return 0.55 * size * (len(text) + 1) / SIZE[0]


def label_room(texts: Sequence[str], size: int = SMALL, least: float = 0.0) -> float:
    """Share of the picture's width that labels on one side take, with the gap to the machine; `least` in any case."""
    return max([least, *(GAP + width(text, size) for text in texts)])


def text(text: str, at: Array, colour: str, side: int, size: int) -> Any:
    """White text on a coloured ground, pinned to a point in space."""
    import pyvista
    from vtkmodules.vtkRenderingCore import vtkTextActor

    actor, ground = vtkTextActor(), pyvista.Color(colour).float_rgb
    actor.SetInput(f" {text} ")
    actor.GetPositionCoordinate().SetCoordinateSystemToWorld()
    actor.GetPositionCoordinate().SetValue(*at)
    style = actor.GetTextProperty()
    set_font(style)
    style.SetFontSize(size)
    style.SetColor(1.0, 1.0, 1.0)
    style.SetBackgroundColor(*ground)
    style.SetBackgroundOpacity(1.0)
    style.SetFrame(True)
    style.SetFrameColor(*ground)
    style.SetFrameWidth(4)
    style.SetVerticalJustificationToCentered()
    (style.SetJustificationToRight, style.SetJustificationToCentered, style.SetJustificationToLeft)[side + 1]()
    return actor


def draw_on_top(actor: Any, order: int) -> None:
    """Draw the actor over everything else: a thermocouple inside the machine must be seen."""
    mapper = actor.GetMapper()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, -22000 * order)
    mapper.SetRelativeCoincidentTopologyPointOffsetParameter(-22000 * order)
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0, -22000 * order)
