"""A Pareto set to move about in: every design as a line over parallel coordinates, and in space."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from thermoscope import plugin as th

if TYPE_CHECKING:
    import plotly.graph_objects as go

SCALE = "Viridis"
WORDS = {
    "peak_degC": "peak (degC)",
    "settling_s": "settling (min)",
    "copper_W": "copper (W)",
    "auxiliary_W": "pump and fan (W)",
}
DISPLAY_UNIT = {"settling_s": 1.0 / 60.0}  # objective -> its unit in the table over that of the rows
EYE = {"x": 2.1, "y": -1.2, "z": 0.7}  # across the diagonal: cooler designs settle sooner, and would hide each other
DECADES = 100.0  # largest over smallest value of an axis from which on it is logarithmic
Row = Mapping[str, Any]


def column(rows: Sequence[Row], name: str) -> list[float]:
    """Values of an objective or variable in the unit of its label."""
    return [float(r[name]) * DISPLAY_UNIT.get(name, 1.0) for r in rows]


def parallel_coordinates(
    rows: Sequence[Row], objectives: Sequence[str], variables: Mapping[str, str], *, theme: th.Theme = th.LIGHT
) -> "go.Figure":
    """Designs as lines over objectives and variables, coloured by the first objective; ranges can be brushed."""
    import plotly.graph_objects as go

    out = th.figure(theme, title={"text": "Every design, objectives first", "x": 0.02})
    words = {**{o: WORDS.get(o, o) for o in objectives}, **variables}
    axes = [{"label": th.as_text(word), "values": column(rows, n)} for n, word in words.items()]
    line = {"color": [float(r[objectives[0]]) for r in rows], "colorscale": SCALE, "showscale": False}
    out = go.Figure(go.Parcoords(dimensions=axes, line=line, labelangle=-20, labelside="top"), layout=out.layout)
    out.update_layout(margin={"l": 70, "r": 70, "t": 150, "b": 40}, height=480)
    return out


def objective_space(rows: Sequence[Row], objectives: Sequence[str], *, theme: th.Theme = th.LIGHT) -> "go.Figure":
    """Designs in the space of three objectives, the first, second and last; the fourth is the colour."""
    import plotly.graph_objects as go

    axes = [*objectives, *objectives][:3] if len(objectives) < 3 else [objectives[0], objectives[1], objectives[-1]]
    colour = next((o for o in objectives if o not in axes), objectives[0])
    x, y, z, c = (column(rows, o) for o in (*axes, colour))
    marker = {"size": 5, "color": c, "colorscale": SCALE, "colorbar": {"title": WORDS.get(colour, colour)}}
    style = {"mode": "markers", "hovertemplate": "%{text}<br>%{x:.4g}, %{y:.4g}, %{z:.4g}<extra></extra>"}
    out = go.Figure(go.Scatter3d(x=x, y=y, z=z, text=[str(r["design"]) for r in rows], marker=marker, **style))
    titles = [{"title": WORDS.get(o, o), "type": _type(u)} for o, u in zip(axes, (x, y, z), strict=True)]
    camera = {"eye": EYE, "center": {"z": -0.15}}
    scene = {**dict(zip(("xaxis", "yaxis", "zaxis"), titles, strict=True)), "camera": camera}
    font = {"color": theme.ink, "family": "DejaVu Sans, Arial, sans-serif"}
    title = {"text": "The Pareto set", "x": 0.02}
    out.update_layout(title=title, scene=scene, height=620, paper_bgcolor=theme.paper, font=font)
    return out


def _type(values: Sequence[float]) -> str:
    """Logarithmic where the values span decades."""
    return "log" if 0.0 < DECADES * min(values) < max(values) else "linear"


def page(rows: Sequence[Row], objectives: Sequence[str], variables: Mapping[str, str], title: str) -> str:
    """Both figures as one HTML page that needs no network.  variables : column of the rows -> its label"""
    first = parallel_coordinates(rows, objectives, variables).to_html(full_html=False, include_plotlyjs=True)
    second = objective_space(rows, objectives).to_html(full_html=False, include_plotlyjs=False)
    head = f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{th.as_text(title)}</title></head>'
    return f"{head}<body>{first}{second}</body></html>\n"
