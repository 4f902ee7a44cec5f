"""What each column of a recording is: quantity, unit and place, from its name, its unit and its values."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermoscope.importing.cells import unit_of
from thermoscope.importing.source import Source
from thermoscope.importing.target import Target
from thermoscope.importing.words import READ, SETPOINT, quantities_of, roles_of, tokens
from thermoscope.recordings.units import QUANTITIES, converted

KELVIN = (200.0, 500.0)  # medians of temperatures in K of a machine; in degC a machine of 200 is past its insulation
FIRST = ("temperature", "current", "speed", "torque", "power", "vehicle_speed", "voltage", "share", "water_flow",
         "air_flow", "frequency")  # fmt: skip
UNTOLD = "neither name nor unit tells what it is"
FOREIGN = re.compile(r"\[([^\]]*[A-Za-z°µ%][^\]]*)\]\s*$")  # what stands in brackets as units do
ELSEWHERE = frozenset({"resistance", "back_emf", "time", "fraction"})  # units that no plain column is guessed from


@dataclass(frozen=True)
class Guess:
    """quantity : "" for a column that is left out;  place : of a temperature;  feeds : the input it drives

    why : what it was told by;  doubt : what is not sure, "" for nothing
    """

    column: str
    quantity: str
    unit: str = ""
    place: str = ""
    feeds: str = ""
    why: str = ""
    doubt: str = ""

    @property
    def used(self) -> bool:
        return bool(self.place or self.feeds)

    def without(self, doubt: str) -> Guess:
        """Left out, and why."""
        return replace(self, place="", feeds="", doubt=doubt)


def guesses(source: Source, clock: Sequence[str], target: Target) -> list[Guess]:
    """One per column that is no clock."""
    every = [guess(source, c, target) for c in source.cells if c not in clock]
    return single(every, target)


def guess(source: Source, column: str, target: Target) -> Guess:
    """A column by itself."""
    if not source.is_numeric(column):
        return Guess(column, "", doubt="words, not numbers")
    label, unit = source.labels[column], unit_of(source.units[column])
    unit_text = source.units[column]
    if unit_text and not unit:
        return Guess(column, "", doubt=f"its unit '{unit_text}' is of nothing a model reads")
    quantity, why = _quantity(label, unit, target)
    if not quantity:
        quantity, why = _by_values(source, column)
    if not quantity:
        return Guess(column, "", doubt="a clock? say so: time [s]" if _counts_on(source, column) else UNTOLD)
    unit, doubt = _unit(source, column, quantity, unit)
    if not unit_text and (match := FOREIGN.search(label)):
        doubt = f"unit '{match[1]}' unknown: {unit} assumed"
    base = Guess(column, quantity, unit, why=why, doubt=doubt)
    return _placed(base, label, target) if quantity == "temperature" else _fed(base, label, target)


def _counts_on(source: Source, column: str) -> bool:
    """Does it rise in every row?"""
    values = source.numbers(column)
    return bool((np.diff(values[np.isfinite(values)]) > 0).all())


def _quantity(label: str, unit: str, target: Target) -> tuple[str, str]:
    """By the unit where one quantity has it, then by name, then by what the model reads or where it has places."""
    of_unit = [q for q in FIRST if unit in QUANTITIES[q].units] if unit else []
    by_name = quantities_of(label)
    both = [q for q in of_unit if q in by_name]
    if of_unit:
        return (both or of_unit)[0], "unit" if not both else "unit and name"
    if (feeds := target.input_of(label, "")) and (quantity := target.inputs[feeds]):
        return quantity, f"name like the input {feeds}"
    if roles_of(label) and by_name in ([], ["temperature"], ["vehicle_speed"]):
        return "temperature", "name of a part"
    if by_name:
        return by_name[0], "name"
    place, _ = target.place_of(label)
    return ("temperature", f"name like the place {place}") if place else ("", "")


def _by_values(source: Source, column: str) -> tuple[str, str]:
    """Readings of a file without names that can hardly be anything but absolute temperatures."""
    values = source.numbers(column)
    middle = float(np.nanmedian(values))
    smooth = np.nanmax(np.abs(np.diff(values))) < 0.2 * max(np.nanmax(values) - np.nanmin(values), 1e-9) + 1.0
    return ("temperature", "values") if source.unnamed and KELVIN[0] < middle < KELVIN[1] and smooth else ("", "")


def _unit(source: Source, column: str, quantity: str, unit: str) -> tuple[str, str]:
    """The unit, and a doubt where it had to be guessed from values."""
    if unit in QUANTITIES[quantity].units:
        return unit, ""
    values = source.numbers(column)
    if quantity == "temperature":
        kelvin = KELVIN[0] < float(np.nanmedian(values)) < KELVIN[1] and float(np.nanmin(values)) > KELVIN[0]
        return ("K", "no unit: by its values") if kelvin else ("degC", "")
    if quantity == "share":
        small = float(np.nanmax(np.abs(values))) <= 1.0
        return ("1" if small else "%"), "no unit: by its values"
    first = next(iter(QUANTITIES[quantity].units))
    return first, f"no unit: {first} is assumed"


def _placed(base: Guess, label: str, target: Target) -> Guess:
    if SETPOINT & set(tokens(label)):
        return base.without("a set point, not a reading")
    place, other = target.place_of(label)
    if not place:
        return base.without("no place of the model fits its name")
    common = set(tokens(label)) & set(tokens(place))
    weak = bool(common) and all(w.isdigit() for w in common) and not roles_of(label)
    doubt = f"or {other}" if other else "place by its number only" if weak else base.doubt
    return replace(base, place=place, doubt=doubt)


def _fed(base: Guess, label: str, target: Target) -> Guess:
    if base.quantity in ELSEWHERE:
        return base.without(f"a {base.quantity} needs more than its unit: docs/how-to/thermal-test.md")
    name = target.input_of(label, base.quantity)
    return replace(base, feeds=name or QUANTITIES[base.quantity].feeds)


def single(guesses: list[Guess], target: Target) -> list[Guess]:
    """One column per boundary and per input; of several readings go before set points, the first before the rest."""
    owner: dict[str, str] = {}
    out = {g.column: g for g in guesses}
    for g in sorted(guesses, key=lambda g: (bool(SETPOINT & set(tokens(g.column))), not READ & set(tokens(g.column)))):
        key = g.feeds or (g.place if g.place in target.boundaries else "")
        if not key:
            continue
        if key not in owner:
            owner[key] = g.column
        elif g.feeds and g.feeds not in target.inputs and not SETPOINT & set(tokens(g.column)):
            out[g.column] = replace(g, feeds=input_name(g))
        else:
            out[g.column] = g.without(f"{owner[key]} gives {key} already")
    return [out[g.column] for g in guesses]


def input_name(g: Guess) -> str:
    """An input called after the column, with the unit that memory holds."""
    unit = QUANTITIES[g.quantity].feeds.rpartition("_")[2]
    words = [w for w in tokens(g.column) if w.isascii()]
    return "_".join([*words, unit]) if words else f"{g.quantity}_{unit}"


def in_memory(source: Source, g: Guess) -> np.ndarray:
    """Readings in the unit of memory."""
    return converted(source.numbers(g.column), g.quantity, g.unit)
