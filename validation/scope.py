"""Where the user disagrees: hypotheses that are left out of the question, and odds that differ in this case."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from measured.doubt import SHARPNESS, Odds
from validation.effects.base import Effect
from validation.effects.during import During

SENSORS = "sensors"  # every fault of a thermometer of the machine


@dataclass(frozen=True)
class Scope:
    """Which effects are asked about.

    without : left out;  only : all others are, () for none; each a kind, "kind@place" or SENSORS
    """

    without: tuple[str, ...] = ()
    only: tuple[str, ...] = ()

    def holds(self, effect: Effect) -> bool:
        """Is an effect asked about, be it lasting or for a while?"""
        meant = [any(is_meant(effect, name) for name in names) for names in (self.without, self.only)]
        return not meant[0] and (meant[1] or not self.only)

    def words(self, odds: Mapping[str, Odds]) -> str:
        """What was left out as asked, and the odds that differ in this case; "" where nothing is special.

        odds : as of `Case.odds`
        """
        out = [f"as asked, {what} {', '.join(names)}" for what, names in vars(self).items() if names]
        out += [f"odds of {name} times {o.share:g} ({o.reason})" for name, o in odds.items()]
        return "; ".join(out)


def is_meant(effect: Effect, name: str) -> bool:
    """Does a name of a `Scope` speak of an effect? What held for a while counts as what it was."""
    base = effect.base if isinstance(effect, During) else effect
    return name in (base.kind, base.name) or (name == SENSORS and base.kind.startswith("sensor."))


def odds_factor(effect: Effect, odds: Mapping[str, Odds]) -> float:
    """Log of what the odds of an effect are multiplied by, before they are stated at their power: the stated odds
    change by the factor that the user gave.  odds : as of `Case.odds`"""
    return float(sum(np.log(o.share) for name, o in odds.items() if is_meant(effect, name))) / SHARPNESS
