"""What the plain models say of the one at hand, in a sentence."""

import numpy as np

from validation.comparison.compare import ChannelError, Comparison, pooled
from validation.yardstick.yardstick import Yardstick

NAMES = {"persistence": "no model at all", "black_box": "a model without physics", "free_network": "a free network"}
WORTH = 1.1  # a model this much above the best yardstick leaves something to be learnt; less is luck of the tests


def scoped(yard: Yardstick, comparison: Comparison) -> list[ChannelError]:
    """The errors of the model at hand that the yardstick's are to be held against: same tests, same sensors."""
    role = [t for t in comparison.tests if (t.role == "hold-out") == bool(yard.hold_out)]
    return [c for t in role for c in t.channels if c.channel in yard.sensors]


def model_error(yard: Yardstick, comparison: Comparison) -> float:
    """What the model at hand leaves there (K rms)."""
    return pooled(scoped(yard, comparison))


def sentence(yard: Yardstick, comparison: Comparison) -> str:
    """Held out 2.0 K; a free network 1.3 K, and so on; and what is still to be learnt."""
    error = model_error(yard, comparison)
    others = {kind: K for kind, K in yard.errors.items() if np.isfinite(K)}
    sizes = {f"{K:.2f}" for K in others.values()}
    each = ", ".join(f"{NAMES[kind]} {K:.2f} K" for kind, K in others.items())
    each = f"every plain model {sizes.pop()} K" if len(sizes) == 1 < len(others) else each
    if not yard.hold_out:
        parts = "each" if len(yard.tests) > 1 else "its parts, each"
        return f"Fitted tests {error:.2f} K; {parts} predicted from the others by {each}."
    return f"Held out {error:.2f} K; {each}.{_rest(yard, comparison, error)}"


def warning(yard: Yardstick, comparison: Comparison) -> str:
    """What is to be said before all else of a model that no model, or one without physics, beats; "" of any other."""
    error = model_error(yard, comparison)
    for kind, what, worth in (("persistence", "a guess of no change", 1.0), ("black_box", "that", WORTH)):
        if error > worth * (plain := yard.errors.get(kind, np.inf)):
            return f"Worse than {NAMES[kind]}: {error:.2f} K, where {what} leaves {plain:.2f} K."
    return ""


def _rest(yard: Yardstick, comparison: Comparison, error: float) -> str:
    """How much a better model would gain, and where."""
    if not error > WORTH * yard.best_K:
        return ""
    kind = min(yard.errors, key=lambda k: np.nan_to_num(yard.errors[k], nan=np.inf))
    rows = scoped(yard, comparison)
    gain = {name: pooled([c for c in rows if c.channel == name]) - of[kind] for name, of in yard.sensors.items()}
    most = max(gain, key=lambda name: gain[name])
    return f" About {error - yard.best_K:.1f} K is still to be learnt, most of it at {most}."
