"""The stage for pictures in space: plotter, camera, surfaces, outlines, colour bar, labels on leader lines."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from viz.colours import LIGHT, Theme, decimals, marks
from viz.labels import minus
from viz.rendering.cut import Surface
from viz.rendering.gl import require_gl

if TYPE_CHECKING:
    import pyvista

SIZE = (1280, 800)  # pixels
MARK, GAP = 9, 8  # letters of a colour bar's numbers; pixels between them and the bar
HEADLINE, SMALL, LETTER = 14, 9, 1.06  # size of a headline; pixels that one of its letters is wide, of that size
FEATURE_ANGLE = 35.0  # degrees between facets from which an edge is drawn


@dataclass(frozen=True)
class View:
    """Where the camera stands: a direction from the machine's middle; z runs to the right, y up."""

    direction: tuple[float, float, float] = (-1.0, 0.42, 0.62)
    up: tuple[float, float, float] = (0.0, 1.0, 0.0)
    angle: float = 14.0
    margin: float = 1.06

    def axes(self) -> tuple[Array, Array, Array]:
        """Unit vectors towards the viewer, to the right and up on the screen."""
        towards = np.asarray(self.direction, float) / np.linalg.norm(self.direction)
        right = np.cross(self.up, towards)
        right /= np.linalg.norm(right)
        return towards, right, np.cross(towards, right)


@dataclass(frozen=True)
class Room:
    """Shares of the picture kept free of the machine."""

    left: float = 0.0
    right: float = 0.0
    top: float = 0.0
    bottom: float = 0.0


NO_ROOM = Room()
FLAT: dict[str, Any] = {"ambient": 0.8, "diffuse": 0.28, "culling": "back", "show_scalar_bar": False}  # shading of maps
TITLE, NOTE = 0.07, 0.05  # shares of the height that a headline and a footnote take
BAR = 0.1  # share of the width that a colour bar takes


def plotter(
    theme: Theme = LIGHT, size: tuple[int, int] = SIZE, shape: tuple[int, int] = (1, 1), smooth: bool = True
) -> pyvista.Plotter:
    """An off-screen plotter; smooth edges cost four times the pixels."""
    require_gl()
    import pyvista

    p = pyvista.Plotter(off_screen=True, window_size=list(size), shape=shape, border=False, lighting="none")
    for renderer in p.renderers:
        renderer.add_light(pyvista.Light(light_type="headlight"))
    p.set_background(theme.paper, all_renderers=True)  # type: ignore[arg-type]
    if smooth:
        p.enable_anti_aliasing("ssaa", all_renderers=True)
    return p


def polydata(surface: Surface, shift: Array | None = None) -> pyvista.PolyData:
    """The surface for VTK; `shift` (n_parts, 3) m moves its parts."""
    import pyvista

    points = surface.points
    if shift is not None:
        points = points + shift[surface.owner]
    data = pyvista.PolyData.from_regular_faces(points, surface.triangles)  # type: ignore[arg-type]
    data.cell_data["part"] = surface.part
    return data


def outline(p: pyvista.Plotter, data: pyvista.PolyData, theme: Theme = LIGHT, opacity: float = 0.8) -> None:
    """Thin lines along sharp edges and along the edges of every part."""
    edges = feature_edges(data)
    if edges.n_points:
        p.add_mesh(edges, color=theme.ink, line_width=1.0, opacity=opacity, show_scalar_bar=False, lighting=False)


def feature_edges(data: pyvista.PolyData) -> pyvista.PolyData:
    """Edges with one triangle, or whose two triangles meet at a sharp angle."""
    return data.extract_feature_edges(
        FEATURE_ANGLE, boundary_edges=True, non_manifold_edges=False, manifold_edges=False, clear_data=True
    )


def look(p: pyvista.Plotter, points: Array, view: View, room: Room = NO_ROOM) -> None:
    """Put the whole machine into the picture, with room kept free around it."""
    towards, right, up = view.axes()
    across, above = points @ right, points @ up
    depth = points @ towards
    aspect = p.renderer.GetSize()[0] / max(p.renderer.GetSize()[1], 1)
    tan = np.tan(np.deg2rad(view.angle) / 2)
    half_w = np.ptp(across) / 2 * view.margin / (1 - room.left - room.right)
    half_h = np.ptp(above) / 2 * view.margin / (1 - room.top - room.bottom)
    distance = max(half_h, half_w / aspect) / tan + np.ptp(depth) / 2
    middle = (across.max() + across.min()) / 2 + half_w * (room.right - room.left)
    height = (above.max() + above.min()) / 2 + half_h * (room.top - room.bottom)
    focus = middle * right + height * up + (depth.max() + depth.min()) / 2 * towards
    p.camera.position = focus + distance * towards
    p.camera.focal_point, p.camera.up, p.camera.view_angle = focus, view.up, view.angle
    p.renderer.ResetCameraClippingRange()


def colour_bar(p: pyvista.Plotter, title: str, theme: Theme = LIGHT, **options: Any) -> None:
    """A vertical bar at the right edge, its title above it, marked where a rounded range has its round numbers."""
    style: dict[str, Any] = {"vertical": True, "position_x": 0.905, "position_y": 0.14, "width": 0.018, "height": 0.6}
    mapper: Any = options.get("mapper") or p.mapper
    low, high = mapper.scalar_range
    unit = f" {unit}" if (unit := options.pop("unit", "")) else ""
    style |= options
    if style["vertical"]:
        _strip(p, style["position_x"] - GAP / p.renderer.GetSize()[0], theme)
    bar = p.add_scalar_bar(title=title, n_labels=0, **style)
    bar.SetTitle("")  # VTK's words would leave the bar what room they do not need, and have a hyphen for a minus sign
    bar.SetBarRatio(1.0)
    bar.SetTextPad(0)
    x, y, wide, tall = (style[k] for k in ("position_x", "position_y", "width", "height"))
    gap = [GAP / side for side in p.renderer.GetSize()]
    every = marks(low, high)
    for mark in every:
        share = (mark - low) / (high - low)
        words = f"{minus(f'{mark:.{decimals(low, high)}f}')}{unit if mark == every[-1] else ''}"
        if style["vertical"]:
            at, anchor = (x + wide + gap[0], y + share * tall), ("left", "center")
        else:
            at, anchor = (x + share * wide, y + tall + gap[1]), ("center", "bottom")
        _line(p, words, at, MARK, theme, f"{title} {words}", anchor)
    if title:
        _line(p, title, (x, y + tall + 2 * gap[1]), MARK, theme, f"title {title}")


def _strip(p: pyvista.Plotter, left: float, theme: Theme) -> None:
    """Paper from there to the right edge, below the headline: a long base would run behind the numbers of a bar."""
    import pyvista
    from vtkmodules.vtkRenderingCore import vtkActor2D, vtkCoordinate, vtkPolyDataMapper2D

    corners = np.array([[left, 0.0, 0.0], [1.01, 0.0, 0.0], [1.01, 1.0 - TITLE, 0.0], [left, 1.0 - TITLE, 0.0]])
    place, mapper, actor = vtkCoordinate(), vtkPolyDataMapper2D(), vtkActor2D()
    place.SetCoordinateSystemToNormalizedViewport()
    mapper.SetTransformCoordinate(place)
    mapper.SetInputData(pyvista.PolyData.from_regular_faces(corners, np.array([[0, 1, 2], [0, 2, 3]])))
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*pyvista.Color(theme.paper).float_rgb)
    p.renderer.AddViewProp(actor)


def headline(p: pyvista.Plotter, text: str, theme: Theme = LIGHT, letters: int = 0) -> None:
    """One line above the picture, as large as fits.  letters : of the longest of a film, so that all are as large"""
    if text:
        fits = int(0.97 * p.renderer.GetSize()[0] / (LETTER * max(len(text), letters)))
        _line(p, text, (0.02, 0.94), min(HEADLINE, fits), theme, "headline")


def footnote(p: pyvista.Plotter, text: str, theme: Theme = LIGHT) -> None:
    """Small lines below the picture."""
    fits = int(0.97 * p.renderer.GetSize()[0] / (LETTER * SMALL))
    _line(p, fill(text, fits), (0.02, 0.015), SMALL, theme, "footnote")


def _line(
    p: pyvista.Plotter,
    text: str,
    at: tuple[float, float],
    size: int,
    theme: Theme,
    name: str,
    anchor: tuple[str, str] = ("left", "bottom"),
) -> None:
    """In place of the line of that name. Its font comes with it: a plotter that has drawn draws again at once."""
    line = p.add_text(
        text, position=at, viewport=True, font_size=size, color=theme.ink, name=name, font_file=font_file()
    )
    line.prop.justification_horizontal, line.prop.justification_vertical = anchor


def save(p: pyvista.Plotter, png: str | Path | None) -> pyvista.Plotter:
    """The plotter, which stays open for the caller; its picture is written if a path is given."""
    if png is not None:
        Path(png).parent.mkdir(parents=True, exist_ok=True)
        p.screenshot(str(png))
    return p


def set_font(style: Any) -> None:
    """The font of all pictures, upright and without a shadow."""
    style.SetFontFamily(4)  # VTK_FONT_FILE, a macro that the Python wheels do not export
    style.SetFontFile(font_file())
    style.SetItalic(False)
    style.SetBold(False)
    style.SetShadow(False)


def font_file() -> str:
    """DejaVu Sans, which matplotlib always brings along."""
    from matplotlib import get_data_path

    return str(Path(get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf")
