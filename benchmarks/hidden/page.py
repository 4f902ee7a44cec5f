"""The score as docs/hidden-effects.md shows it: promises, then the first guess of every method."""

from collections.abc import Sequence

from scripts.published import table

MEANING = {
    "largest residual": "node of the largest residual",
    "correlation": "plain correlation",
    "forward BIC": "forward selection by BIC",
    "forward LRT": "forward selection by likelihood ratio",
    "AIC refit": "AIC after refits",
}


def markdown(found: Sequence[dict]) -> str:
    """Rows of `score.rows` as two tables."""
    rates = [
        (f"{r['case']}: {r['measure']}", r["n"], percent(r["ours"]), span(r["ci95"]), aim(r["target"]))
        for r in found
        if "target" in r
    ]
    against, own = [r for r in found if "peer" in r], [r for r in found if r.get("fold")]
    parts = [table(["", "of", "came out", "95 %", "wanted"], rates)]
    return "\n\n".join([*parts, *([guesses(against)] if against else []), *([folds(own)] if own else [])])


def folds(own: Sequence[dict]) -> str:
    """One line per measure, one column per kind and one for all."""
    kinds, found = list(dict.fromkeys(r["case"] for r in own)), {(r["measure"], r["case"]): r for r in own}
    rows = []
    for measure in dict.fromkeys(r["measure"] for r in own):
        told = [entry(found.get((measure, kind))) for kind in kinds]
        aims = {aim(r.get("fold_target", "")) for (m, _), r in found.items() if m == measure} - {""}
        rows.append([" ".join([measure, *(f"({a})" for a in aims)]), *told])
    return table(["", *kinds], rows)


def entry(row: dict | None) -> str:
    """A rate with its number of cases, or a plain number."""
    if row is None:
        return ""
    return f"{percent(row['ours'])} of {row['n']}" if "ci95" in row else f"{row['ours']:.2f}"


def diagram(bins: Sequence[tuple[float, float, int, float, float]]) -> str:
    """A reliability diagram as a table: what was said, and how much of it was right."""
    rows = ((f"{percent(a)} to {percent(b)}", n, percent(p), percent(right)) for a, b, n, p, right in bins)
    return table(["said with", "statements", "mean", "right"], rows)


def guesses(against: Sequence[dict]) -> str:
    """One line per method, one column per measure, which names its number of cases."""
    asked = {(r["case"], r["measure"]): r for r in against}
    heads = [f"{measure.split(', ')[-1]} ({r['n']})" for (_, measure), r in asked.items()]
    rows = [["this diagnosis", *(percent(r["ours"]) for r in asked.values())]]
    for name in dict.fromkeys(r["peer_name"] for r in against):
        theirs = {(r["case"], r["measure"]): r["peer"] for r in against if r["peer_name"] == name}
        rows.append([MEANING[name], *(percent(theirs[key]) for key in asked)])
    return table(["method", *heads], rows)


def aim(target: str) -> str:
    """'>= 0.90' as '>= 90 %'."""
    words = [hundredths(float(w)) if w.replace(".", "").isdigit() else w for w in target.split()]
    return f"{' '.join(words)} %" if words else ""


def span(interval: Sequence[float]) -> str:
    low, high = interval
    return f"{hundredths(low)} to {percent(high)}"


def percent(rate: float) -> str:
    return f"{hundredths(rate)} %"


def hundredths(rate: float) -> str:
    return f"{100.0 * rate:.0f}"
