"""An event of the model that happened again in a held-out test: when is read off that test, and nothing else.

Its law and size are those that other tests gave it, and it lasts about as long as there. Since its ends are fitted, the
stretch itself is not counted any more; what the event leaves behind is, and has to be predicted much better with it.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from measured.case import Case, Test
from validation.comparison.compare import physical, test_error
from validation.effects.during import During
from validation.effects.time_window import Event, share
from validation.inference.events import further_spans, with_spans
from validation.noise import START, Noise
from validation.parameters.unknowns import effects_of, standing

LESS = 0.7  # of the error outside the stretch: what the event must bring it to, to be the explanation


@dataclass(frozen=True)
class RepeatedEvent:
    """What happened again in a held-out test.

    words : what and when;  event : when
    rmse_K : error (K rms) of the test as it is predicted;  elsewhere_K : with the event, its stretch not counted
    """

    test: str
    words: str
    event: Event
    rmse_K: float
    elsewhere_K: float

    @property
    def sentence(self) -> str:
        return (
            f"{self.words}: {self.test} is predicted within {self.rmse_K:.2f} K without it, and within "
            f"{self.elsewhere_K:.2f} K with it where that stretch, fitted in time, is not counted"
        )

    def document(self) -> dict:
        errors = {"rmse_K": self.rmse_K, "elsewhere_rmse_K": self.elsewhere_K}
        return {"test": self.test, **self.event.document(), "words": self.sentence, **errors}


def repeated_events(case: Case) -> tuple[RepeatedEvent, ...]:
    """Every event of a case's model that is found in a held-out test, one effect after the other."""
    return tuple(x for test in case.tests if test.role == "hold-out" for x in _in_test(case, test))


def _in_test(case: Case, test: Test) -> Iterator[RepeatedEvent]:
    network, now = standing(case), physical(case)
    for effect in effects_of(case):
        if isinstance(effect, During) and effect.name in case.model.values and _can_repeat(effect, test):
            noise = Noise({c.name: START for c in test.channels})
            spans = further_spans(network, test, {**case.model.values, **now}, effect, noise)
            if spans:
                event, inside = Event.of({test.name: spans}), share(test.time, spans) > 0.0
                rest = tuple(replace(c, y=np.where(inside, np.nan, c.y)) for c in test.channels)
                larger, elsewhere = with_spans(network, effect, test, spans), replace(test, channels=rest)
                before, after = (test_error(x, elsewhere, now).rmse_K for x in (network, larger))
                if after < LESS * before:
                    words, whole = f"{effect.base.statement} {event.words}", test_error(network, test, now).rmse_K
                    yield RepeatedEvent(test.name, words, event, whole, after)
                    network = larger


def _can_repeat(effect: During, test: Test) -> bool:
    """Could an event that other tests had have held in this one?  A boundary is off in whole tests alone."""
    lengths = [end - begin for begin, end in effect.event.every] if effect.event else []
    elsewhere = effect.mapping != "offset" and test.name not in effect.tests
    return bool(lengths) and elsewhere and float(np.ptp(test.time)) > max(lengths)
