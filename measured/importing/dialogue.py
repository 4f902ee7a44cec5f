"""What a recording cannot tell: asked on the terminal, or taken from --set and from careful defaults."""

import sys
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from geom.errors import InputError
from geom.text import visible
from lumped.schemas.reader import suggestion
from measured.headers.cells import number, unit_of
from measured.headers.words import is_setpoint
from measured.importing.draft import ASSUMED_ROOM, Draft, coldest_start, missing_boundaries, missing_inputs, squares_of
from measured.importing.guess import Guess
from measured.importing.source import Source
from measured.importing.target import Target
from measured.recordings.units import QUANTITIES


@dataclass
class Dialogue:
    """target : what the model offers;  asks : False takes the guesses;  constants : NAME -> value from --set

    answers : what was asked already, so that nothing is asked twice
    """

    target: Target
    asks: bool
    constants: dict[str, float]
    answers: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        names = [*self.target.inputs, *self.target.boundaries]
        for name in self.constants:
            if name not in names:
                raise InputError(f"the model reads no '{name}'", "--set", suggestion(name, names))

    def answered(self, source: Source, guesses: list[Guess]) -> list[Guess]:
        """The guesses of one file after the questions about them; what --set gives is not read from a column."""
        completed = [self._completed(g, source.labels[g.column]) if self.asks else g for g in guesses]
        constants = self.constants
        out = [g.without("--set gives it") if (g.feeds or g.place) in constants else g for g in completed]
        if not any(g.used for g in out):
            right = f"columns for {', '.join([*self.target.places, *self.target.inputs][:8])}"
            raise InputError("no column of it fits the model", str(source.file), right)
        return out

    def _completed(self, g: Guess, label: str) -> Guess:
        if g.quantity == "temperature" and not g.place and not is_setpoint(label):
            places = [*self.target.places, *self.target.boundaries]
            return replace(g, place=self._choice(f"Where is '{g.column}'? (a place; Enter leaves it out)", "", places))
        if g.used and g.doubt.startswith("no unit"):
            units = list(QUANTITIES[g.quantity].units)
            return replace(g, unit=self._choice(f"Unit of '{g.column}'? ({g.quantity})", g.unit, units), doubt="")
        return g

    def _choice(self, question: str, default: str, words: Iterable[str]) -> str:
        """An answer out of a list, asked until it is one; the same question has the same answer."""
        if question not in self.answers:
            words = list(words)
            while (word := _answer(question, default)) and word not in words:
                if unit_of(word) in words:
                    word = unit_of(word)
                    break
                print(suggestion(word, words), file=sys.stderr)
            self.answers[question] = word
        return self.answers[question]

    def completed(self, draft: Draft) -> Draft:
        """With what nothing gives. InputError where an input of the model stays unknown."""
        inputs = {n: v for n, v in self.constants.items() if n in self.target.inputs}
        edges = {n: v for n, v in self.constants.items() if n in self.target.boundaries}
        draft = replace(draft, constants=inputs, boundaries=edges)
        if not any(g.place in self.target.places for g in draft.guesses):
            files, right = ", ".join(r.name for r in draft.records), f"one for {', '.join([*self.target.places][:8])}"
            raise InputError("no column is a temperature at a place of the model", files, right)
        draft = replace(draft, squares=squares_of(draft.guesses, self.target))
        return self._with_inputs(self._with_boundaries(draft))

    def _with_boundaries(self, draft: Draft) -> Draft:
        """Temperatures of the surroundings that nobody recorded: asked, else the coldest sensor at the start."""
        values, notes = dict(draft.boundaries), list(draft.notes)
        for name in missing_boundaries(draft, self.target):
            usual = coldest_start(draft)
            text = self._number(f"{draft.name}: temperature of {name} (degC)?", f"{usual:g}")
            values[name] = usual if text is None else text
            if text is None:
                notes.append(f"{name} was not recorded: {usual:g} degC {ASSUMED_ROOM} (--set {name}=VALUE)")
        return replace(draft, boundaries=values, notes=tuple(notes))

    def _with_inputs(self, draft: Draft) -> Draft:
        values, unknown = dict(draft.constants), []
        for name in missing_inputs(draft, self.target):
            if (value := self._number(f"{draft.name}: {name}, constant throughout?", "")) is None:
                unknown.append(name)
            else:
                values[name] = value
        if unknown:
            files, right = ", ".join(r.name for r in draft.records), " ".join(f"--set {n}=VALUE" for n in unknown)
            what = f"no column gives {', '.join(unknown)}, which the model reads"
            raise InputError(what, files, f"{right} where it was constant")
        return replace(draft, constants=values)

    def _number(self, question: str, default: str) -> float | None:
        """None where nobody is asked or nothing was answered."""
        if not self.asks:
            return None
        while (word := _answer(question, default)) and number(word) != number(word):
            print("a number, please", file=sys.stderr)
        return number(word) if word else None


def _answer(question: str, default: str) -> str:
    """A line from the terminal, without one an error."""
    print(visible(f"{question}{f' [{default}]' if default else ''} "), end="", file=sys.stderr, flush=True)
    line = sys.stdin.readline()
    if not line:
        raise InputError(f"nobody answers: {question}", "thermoscope test new", "--yes takes the guesses")
    return line.strip() or default
