"""Heat through every link of a network over one step of a run, and as ribbons whose width is power."""

from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from lumped.integration.balance import Balance
from lumped.model.network import Link, Network
from validation.parameters.unknowns import value_words
from viz.colours import BLUE, LIGHT, ORANGE, SKY, VERMILION
from viz.figures import paper
from viz.labels import spread_labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Flow:
    """Heat (W) from node `start` to node or boundary `end`, through parallel links of one kind.

    conductance : W/K between the two if each had one temperature
    """

    start: str
    end: str
    kind: str
    watts: float
    conductance: float


@dataclass(frozen=True)
class Heat:
    """losses : source -> W;  flows : between nodes;  out : part or stream the heat leaves by -> W;  stored : W.

    streams : those of `out` that are streams
    """

    losses: dict[str, float]
    flows: tuple[Flow, ...]
    out: dict[str, float]
    streams: frozenset[str] = frozenset()

    @property
    def stored(self) -> float:
        """What warms the machine (W)."""
        return sum(self.losses.values()) - sum(self.out.values())


RUNNING = 0.5  # of the largest losses of a record: less is a machine that coasts or stands


def last_running_step(network: Network, balance: Balance) -> int:
    """The last step of a balance in which the machine runs; the last one where it never does."""
    total = np.sum([balance.power(s.name) for s in network.sources], axis=0)
    running = np.flatnonzero(total >= RUNNING * total.max(initial=0.0))
    return int(running[-1]) if running.size and total.max() > 0 else total.size - 1


def heat_flows(network: Network, balance: Balance, step: int = -1) -> Heat:
    """Losses, flows and exits over one step of the balance, the last one if not told."""
    z = balance.z[1:][step]
    losses: dict[str, float] = {}
    for source in network.sources:
        name = source.name.removeprefix("loss:").partition("^")[0]  # what an exponent changes is the loss's own
        name = value_words(name.removesuffix(":rise").removesuffix(":base"))
        losses[name] = losses.get(name, 0.0) + float(balance.power(source.name)[step])
    pairs: dict[tuple[str, str, str], Array] = {}
    out: dict[str, float] = {}
    for link in network.links:
        watts = float(balance.power(link.name)[step])
        start, end = (network.places[p].part if p in network.places else p for p in link.places)
        if link.kind == "stream":
            name = link.name.removeprefix("stream:")
            out[name] = out.get(name, 0.0) + watts
            continue
        if start == end:
            continue
        both = np.array([watts, conductance(network, link, (start, end), watts, z)])
        pairs[start, end, link.kind] = pairs.get((start, end, link.kind), np.zeros(2)) + both
        for boundary, part, sign in ((end, start, 1.0), (start, end, -1.0)):
            if boundary in network.boundaries:
                out[part] = out.get(part, 0.0) + sign * watts
    streams = frozenset(link.name.removeprefix("stream:") for link in network.links if link.kind == "stream")
    return Heat(losses, tuple(Flow(*key, *both.tolist()) for key, both in pairs.items()), out, streams)


def conductance(network: Network, link: Link, ends: tuple[str, str], watts: float, z: Array) -> float:
    """W/K of a link between two nodes of one temperature each: its coefficient times the entry of its pattern.

    The coefficient is the heat that passes over what the pattern makes of the temperatures z.
    """
    mean = next(network.states.index(end) for end in ends if end in network.states)
    mine = link.rows == mean
    difference = float(link.vals[mine] @ z[link.cols[mine]])
    return abs(watts / difference) * float(link.vals[mine & (link.cols == mean)].sum()) if difference else 0.0


SMALL = 0.01  # of the total: smaller exits are drawn as one
LINE = 26  # letters of a line of a name
WARMS, COOLS, ELSEWHERE = "warms the machine", "the machine cools", "elsewhere"
LOW, HIGH = 0.3, 1.3  # of the total: the drawing reaches below and above the trunk
GAP = 0.065  # of the total between ribbons: nearly the height of a name; less where there are many


@paper.styled
def sankey_of_losses(heat: Heat, *, title: str = "", png: str | Path | None = None) -> "Figure":
    """Losses and what a machine that cools gives up on the left, exits and what is stored on the right (W)."""
    # Exits by size: parallel streams as one, small ones as 'elsewhere', then what warms the machine
    out: dict[str, float] = {}
    for name, watts in heat.out.items():
        name = name.partition(":")[0]
        out[name] = out.get(name, 0.0) + watts
    least = SMALL * sum(heat.losses.values())
    large = {k: v for k, v in sorted(out.items(), key=lambda kv: -kv[1]) if v >= least}
    rest = sum(v for k, v in out.items() if k not in large)
    tail = {ELSEWHERE: rest, WARMS: heat.stored}
    left, right = entries(heat), large | {k: v for k, v in tail.items() if v >= least}
    total = sum(left.values())
    if sum(heat.losses.values()) <= 0:
        raise InputError("no losses to draw", "sankey", "a machine that is running")
    figure, (ax,) = paper.subplots(8.4, 4.4)
    _side(ax, left, 0.0, 0.46, dict.fromkeys(left, VERMILION) | {COOLS: ORANGE}, total)
    streams = {stream.partition(":")[0] for stream in heat.streams}  # darker than what faces give up
    shades = {k: BLUE if k in streams else SKY for k in right} | {WARMS: ORANGE, ELSEWHERE: LIGHT.faint}
    _side(ax, right, 1.0, 0.54, shades, total)
    ax.fill_between([0.46, 0.54], 0, total, color=LIGHT.ink, lw=0)
    ax.text(0.5, total * 1.04, f"{total:.0f} W", ha="center", weight="bold", fontsize=10)
    ax.set(xlim=(-0.32, 1.32), ylim=(-LOW * total, HIGH * total))
    ax.axis("off")
    ax.set_title(title, loc="left")
    return paper.save(figure, png)


def entries(heat: Heat) -> dict[str, float]:
    """Losses by size, then what the machine gives up where more leaves it than is lost."""
    losses = {k: v for k, v in sorted(heat.losses.items(), key=lambda kv: -kv[1]) if v > 0}
    least = SMALL * sum(losses.values())
    return losses | ({COOLS: -heat.stored} if -heat.stored >= least else {})


def _side(
    ax: "Axes", parts: dict[str, float], outer: float, inner: float, colours: dict[str, str], total: float
) -> None:
    """Ribbons from a column at `outer`, spread out so that names fit, to the trunk at `inner`."""
    gap = min(GAP, (HIGH + LOW - 1) / max(len(parts) - 1, 1)) * total
    room = sum(parts.values()) + gap * (len(parts) - 1)
    y, at = total, (total + room) / 2 if room > total else total
    middles, sign = [], -1 if outer < inner else 1
    for name, watts in parts.items():
        _ribbon(ax, (outer, at), (inner, y), watts, colours[name])
        middles.append(at - watts / 2)
        y, at = y - watts, at - watts - gap
    heights = spread_labels(middles[::-1], -LOW * total, HIGH * total, 0.075 * total)[::-1]
    for (name, watts), height in zip(parts.items(), heights, strict=True):
        words, side = fill(f"{name}\u00a0\u00a0{watts:.0f}\u00a0W", LINE), "right" if sign < 0 else "left"
        ax.text(outer + 0.02 * sign, height, words, ha=side, va="center", fontsize=9)


def _ribbon(ax: "Axes", a: tuple[float, float], b: tuple[float, float], width: float, colour: str) -> None:
    """A band whose upper edge runs from a to b."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Line

    mid = (a[0] + b[0]) / 2
    upper = [a, (mid, a[1]), (mid, b[1]), b]
    lower = [(x, y - width) for x, y in reversed(upper)]
    codes = [Line.MOVETO, *[Line.CURVE4] * 3, Line.LINETO, *[Line.CURVE4] * 3, Line.CLOSEPOLY]
    ax.add_patch(PathPatch(Line([*upper, *lower, upper[0]], codes), facecolor=colour, alpha=0.75, lw=0))
