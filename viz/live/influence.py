"""Which parameter moves which sensor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from validation.calibration.unknowns import working
from validation.case import Case, Test
from validation.comparison.compare import physical
from validation.comparison.predict import predict
from validation.measurement.operators import of_measurement
from viz.colours import LIGHT, Theme
from viz.data import short
from viz.live.style import figure, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from lumped.model.network import Parameter


def influence(case: Case, test: Test) -> tuple[Sequence[Parameter], NDArray[np.float64]]:
    """Free physical parameters, and the rms (K) by which one prior deviation of each moves each sensor of a test.

    Returns (n_parameters,), (n_parameters, n_channels)
    """
    network, unknowns = working(case)
    known = {p.name for p in network.parameters}
    chosen = [p for p in unknowns.parameters if p.name in known and not of_measurement(p)]
    J = predict(network, test, physical(case), chosen).J
    return chosen, np.sqrt(np.mean(J**2, axis=0)).T * np.array([[p.prior_sd] for p in chosen])


def sensitivity(case: Case, test: Test, *, most: int = 20, theme: Theme = LIGHT) -> go.Figure:
    """The parameters that matter most to a test, as a matrix of parameters by sensors (K per prior deviation)."""
    chosen, size = influence(case, test)
    order = np.argsort(-size.max(axis=1))[:most]
    out = figure(theme, title={"text": f"{test.name}: what one prior deviation moves (K, rms)", "x": 0.02})
    out.add_heatmap(
        z=[plain(size[i]) for i in order], x=[short(c.name) for c in test.channels],
        y=[chosen[i].name for i in order], colorscale="Viridis", colorbar={"title": "K"},
        hovertemplate="%{y}<br>%{x}<br>%{z:.2f} K<extra></extra>",
    )  # fmt: skip
    out.update_yaxes(autorange="reversed")
    return out
