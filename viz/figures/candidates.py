"""What might be missing: the odds, the evidence of the candidate effects, and which of them cannot be told apart."""

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from geom.table import percent as odds
from viz.colours import BLUE, LIGHT, ORANGE, PURPLE, VERMILION
from viz.figures import paper
from viz.labels import minus

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEAST_PROBABILITY = 0.005  # probabilities below half a per cent are not drawn
LABEL = 34  # letters of a label's line
DECISION = {"named": VERMILION, "group": ORANGE, "cannot-tell": PURPLE, "no": LIGHT.faint}


@paper.styled
def scores(candidates: Sequence[Mapping[str, Any]], *, most: int = 12, png: str | Path | None = None) -> "Figure":
    """The highest log evidence as bars with each candidate's threshold, coloured by decision."""
    best = sorted(candidates, key=lambda c: c["score"], reverse=True)[:most][::-1]
    names = [textwrap.fill(c.get("words") or c["effect"], LABEL) for c in best]
    figure, ax = _bars(names, [c["score"] for c in best], [DECISION[c["decision"]] for c in best], height=0.5)
    for y, c in enumerate(best):
        ax.plot([c["threshold"]] * 2, [y - 0.42, y + 0.42], color=LIGHT.ink, lw=1.4)
        note = amplitude(c) + 2 * "\u00a0" if c["decision"] != "no" else ""  # letters of a page may be wider
        ax.text(max(c["score"], c["threshold"], 0), y, f"\u00a0{note}", va="center", fontsize=8.5)
    for label, c in zip(ax.get_yticklabels(), best, strict=True):
        label.set_fontweight("bold" if c["decision"] == "named" else "normal")
    ax.margins(x=0.2, y=0.02)
    ax.set(xlabel="log odds against nothing missing (3 is twenty to one); black mark: as probable as nothing")
    return paper.save(figure, png)


@paper.styled
def posterior(
    explanations: Sequence[Mapping[str, Any]],
    *,
    title: str = "What the readings say",
    most: int = 8,
    png: str | Path | None = None,
) -> "Figure":
    """Each leading cause as a bar, most probable first; the pale part is with a partner, which is named.

    explanations : of a diagnosis;  most : bars
    """
    best = [x for x in explanations if x["probability"] >= LEAST_PROBABILITY][:most][::-1]
    shade = {"nothing": BLUE, "others": LIGHT.faint}
    colours = [shade.get(x["cause"], PURPLE if x["cause"].startswith("heat@") else VERMILION) for x in best]
    percent = [100.0 * x["probability"] for x in best]
    figure, ax = _bars([textwrap.fill(x["words"], LABEL) for x in best], percent, colours, height=0.5)
    alone = [100.0 * x["alone"] if x["partners"] else p for x, p in zip(best, percent, strict=True)]
    ax.barh(range(len(best)), np.subtract(percent, alone), left=alone, height=0.62, color="white", alpha=0.55)
    for y, (x, p) in enumerate(zip(best, percent, strict=True)):
        ax.text(p, y, f"\u00a0{odds(x['probability'])}", va="center", fontsize=8.5)
        if likely := [n for n in x["partners"] if n["probability"] >= LEAST_PROBABILITY]:
            more = f" and {len(likely) - 1} more" if len(likely) > 1 else ""
            note = f"\u00a0with: {likely[0]['words']} ({odds(likely[0]['probability'])}){more}"
            ax.text(0.0, y - 0.36, note, va="top", fontsize=8, color=LIGHT.ink, alpha=0.75)
    ax.set(xlabel="probability (%); pale: with something else", xlim=(0.0, 112.0), ylim=(-0.9, len(best) - 0.5))
    ax.set_title(title, loc="left", fontweight="bold")
    return paper.save(figure, png)


@paper.styled
def differences(contradiction: Mapping[str, Any], *, most: int = 10, png: str | Path | None = None) -> "Figure":
    """What would have to differ between tests, in standard deviations; what cannot differ is red.

    contradiction : the contradiction of a diagnosis or comparison
    """
    rows = contradiction["differences"][:most][::-1]
    names = [f"{d.get('words', d['parameter'])} in {d['test']}" for d in rows]
    figure, ax = _bars(names, [d["sd"] for d in rows], [BLUE if d["possible"] else VERMILION for d in rows])
    for y, d in enumerate(rows):
        side = "left" if d["sd"] > 0 else "right"
        ax.text(d["sd"], y, f"\u00a0{factor(d)}\u00a0", va="center", ha=side, fontsize=8.5)
    for limit in (-contradiction["limit"], contradiction["limit"]):
        ax.axvline(limit, color=LIGHT.ink, lw=1.0, ls=":")
    ax.axvline(0.0, color=LIGHT.ink, lw=1.0)
    ax.margins(x=0.25, y=0.04)
    ax.set(xlabel="standard deviations from the other tests\nblue can differ, red cannot; dotted: chance")
    return paper.save(figure, png)


def _bars(
    names: Sequence[str], values: Sequence[float], colours: Sequence[str], height: float = 0.3
) -> "tuple[Figure, Axes]":
    """Named bars, one below the other, the first at the bottom.  height : of each with its gap (inch)"""
    figure, (ax,) = paper.subplots(8.4, height * len(names) + 1.2)
    ax.barh(range(len(names)), values, height=0.62, color=colours)
    ax.set_yticks(range(len(names)), names)
    ax.grid(False, axis="y")
    return figure, ax


def factor(d: Mapping[str, Any]) -> str:
    """How much a parameter would have to differ: times the others, or beside them."""
    if d["relative"]:
        return f"x {d['here'] / d['others']:.2g}"
    return f"{minus(format(d['here'] - d['others'], '+.2g'))}{'' if d['unit'] == '1' else ' ' + d['unit']}"


@paper.styled
def confusion(names: Sequence[str], cosine: Array, *, png: str | Path | None = None) -> "Figure":
    """|cosine| between the signatures of candidate effects: 1 cannot be told apart with these sensors and tests.

    cosine : (n, n)
    """
    c = np.abs(np.asarray(cosine, float))
    side = 0.48 * len(names)
    figure, (ax,) = paper.subplots(side + 4.2, side + 1.0)  # beside it the labels
    ax.imshow(c, cmap="Blues", vmin=0, vmax=1)
    for i, j in np.ndindex(c.shape):
        if i != j and c[i, j] >= 0.5:
            words, colour = f"{c[i, j]:.2f}".lstrip("0"), "white" if c[i, j] > 0.6 else "black"
            ax.text(j, i, words, ha="center", va="center", fontsize=7.5, color=colour)
    ax.set_xticks(range(len(names)), [str(i + 1) for i in range(len(names))])
    ax.set_yticks(range(len(names)), [f"{textwrap.fill(name, LABEL)}  {i}" for i, name in enumerate(names, 1)])
    ax.grid(False)
    ax.set_title("Signatures in common (1: cannot be told apart)")
    return paper.save(figure, png)


def size(candidate: Mapping[str, Any]) -> str:
    """'12.3 W/m2/K'; empty where it has none."""
    a = candidate["amplitude"]
    if a["value"] is None or not np.isfinite(a["value"]):
        return ""
    return f"{a['value']:.3g} {a['unit']}".removesuffix(" 1")


def amplitude(candidate: Mapping[str, Any]) -> str:
    """'12.3 W/m2/K (95 %: 8.1 ... 16.5)'; empty where it has none."""
    # '8.1 ... 16.5', 95 %; empty where it is not known
    ci95 = candidate["amplitude"].get("ci95")
    text, between = size(candidate), f"{ci95[0]:.3g} … {ci95[1]:.3g}" if ci95 and np.isfinite(ci95).all() else ""
    return minus(f"{text} (95 %: {between})" if text and between else text)


def matrix(cosines: Mapping[str, Mapping[str, float]], names: Sequence[str]) -> Array:
    """(n, n) |cosine| of the named effects from a diagnosis' `confusion`; what it leaves out counts as 0."""
    return np.array([[1.0 if a == b else abs(cosines.get(a, {}).get(b, 0.0)) for b in names] for a in names])
