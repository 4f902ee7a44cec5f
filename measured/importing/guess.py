"""What each column of a recording is: quantity, unit and place, from its name, its unit and its values."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array
from geom.description.roles import Role
from geom.errors import InputError
from lumped.model.quantities import AIR, INPUTS, LIQUID, USUAL
from lumped.schemas.bounds import COLDEST, HOTTEST
from measured.headers.cells import is_unit, unit_of
from measured.headers.words import (
    BATTERY,
    CABINET,
    CONVERTED,
    EXTREME,
    INLET,
    INSTRUMENT,
    LETTERED,
    LOGGER,
    LOSS,
    MACHINE,
    MEAN,
    MODELLED,
    NOTHING,
    OIL,
    OUTER,
    PATH,
    PUMP,
    QUANTITY,
    RATIO,
    READ,
    ROLES,
    ROOMS,
    SETPOINT,
    SPARE,
    SPOT,
    SPREAD,
    SUPPLY,
    WORD,
    axis_of,
    is_rise,
    is_setpoint,
    is_spoken,
    is_stage,
    is_stator,
    is_unknown,
    is_within,
    quantities_of,
    roles_of,
    tokens,
)
from measured.importing.clock import is_second_clock
from measured.importing.relations import (
    SAME,
    START_K,
    functional_relations,
    is_like_temperature,
    is_product,
    is_smooth,
    quickness,
)
from measured.importing.source import Source
from measured.importing.target import Target, measure_of
from measured.recordings.invalid_readings import FAR, LARGEST_THERMOCOUPLE, coded
from measured.recordings.units import LARGEST, QUANTITIES, ROOM_F, ROOM_K, SWITCHED, converted

KELVIN = (200.0, 500.0)  # medians of temperatures in K of a machine; in degC a machine of 200 is past its insulation
ALIKE_F = 4.0  # degF between sensors of a machine at rest
FIRST_ROWS = 5  # whose median a column starts at
ALIKE_K = 3.0  # between sensors of a machine at rest
FALLING = 0.05  # of its steps: no clock runs back as often
STATES = 16  # whole numbers below it, under the name of a part alone
UNNAMED = (-40.0, 300.0)  # degC of whatever changes slowly and has no name
LEAST = 3  # readings of a column
ROOM_C = (-50.0, 120.0)  # degC at which machines are started, in the cold and in an oven
ANGLE = re.compile(r"(?i)theta(?:[_ ]?[a-z]{0,2}|[_ ]?(?:mech|elec|el|rot))$")  # of a rotor, rather than a temperature
OMEGA = re.compile(r"(?<=\.)w$|^w(?=$|_(?:m|r|mot|rotor|shaft|el)$)")  # beside a torque
PARTNERS = {"v": ("i", "voltage"), "i": ("v", "current"), "current": ("voltage", "current")}  # dc.v beside dc.i
SUFFIX = re.compile(r"_[a-z]{1,2}$")  # of a header, with its unit
ERPM = re.compile(r"(?i)(?:^|[^a-z])e_?rpm\b")  # of drones' and skateboards' controllers
HEATER = re.compile(r"[QH](\d)")  # beside T of the same number
LOAD = re.compile(r"T_?(?:load|last|mech|em|brake|shaft)")  # of a torque, where its readings are no temperature's
AXES = ({"id", "iq"}, {"ialpha", "ibeta"})  # components whose squares add up to the current's
OTHER_UNITS = {  # of loggers, that no table of a sheet lists: for pint
    "temperature": ("mK",),
    "current": ("uA",),
    "voltage": ("uV",),
    "power": ("uW", "mW", "MW", "BTU/hour", "hp", "metric_horsepower"),
    "torque": ("mN*m", "cN*m", "lbf*ft"),
    "speed": ("krpm", "deg/s"),
    "water_flow": ("l/h", "l/s", "gallon/min", "ml/min", "ml/s"),
    "air_flow": ("ft**3/min",),
}
SUREST = "unit and name"  # by which a column was told: such a one goes before others
WEAK = frozenset({"", "%", "1", "V", "mV", "Hz"})  # units that say little of what a column is
FIRST = (
    *("temperature", "current", "speed", "torque", "power", "vehicle_speed"),
    *("voltage", "share", "water_flow", "air_flow", "frequency", "resistance"),
)  # of several quantities that have a unit, the likelier before the others
SIGNALS = ("V", "A", "mA")  # of amplifiers and transmitters
QUALITY = ("q", "qc", "qual", "st", "sts")
STAGES = "stages, as shares of a flow"
ELSE = "is it in other units?"
SCALED = 10.0  # degC: all of a record below it were scaled to a spread of one, or are of the winter
UNTOLD = "neither name nor unit tells what it is"
FOREIGN = re.compile(r"\[([^\]]*[A-Za-z°µ%][^\]]*)\]\s*$")  # what stands in brackets as units do
ROUND = re.compile(r"\(([^()]*[A-Za-z°µ%][^()]*)\)\s*$")  # or remarks
IN_HEADER = "in its header,"  # another unit than by its values
CANNOT_BE, CODES_ALONE = "cannot be right", "holds nothing but a logger's codes"
DEAD = "never changes: a limit, or a dead sensor"
OF_INSTRUMENT = "of the instrument itself or another device, by its name"
OF_DEVICE = "no part of a motor by its name; it warms most"
OF_TESTED = "no part of a motor by its name; taken as one of the device that is tested"
DEMAND = "a set point, no reading: taken as reached"
NUMBERED = "place by its number only"
WHOLE = "names no part: the winding?"
BY_LETTERS = "by its letters alone"
HARDLY = "hardly warms: taken as the room"
SEVERAL = "of the first of several machines, by their numbers?"
OF_ROWS = "a number that names a row"
MIXED = "its rows are of several"
NUMBERED_MACHINE = "of one of several machines, by its number: a file of each?"
UNKNOWN = "unknown"  # of a unit
RELATIVE = "relative to a nominal"
OF_WHAT = "a share, by its unit alone: of what?"
BY_READINGS = "a temperature, by its readings alone"
FACTORS = ("current", "voltage", "torque", "speed")
PASSES = "a product of other columns: it passes through"
BACK = "of both signs: it passes through"
OF_PHASE = "of one phase: all are in"
OF_SUM = 0.02  # of the largest: meters of several phases round, and read one after another
ONE_SIDE = "of one side of a converter, by its name: what is lost in it is the heat"
NO_UNIT = "no unit"
FUNCTION = "made of other columns"
OF_SENSOR = "of a sensor"
AS_WINDING = "taken as the winding"
FASTEST, OF_STATOR = (f"{why}: {AS_WINDING}" for why in ("follows the heat fastest", "of the stator"))
AS_TORQUE = "starts where no temperature does, beside a speed: taken as a torque in N*m"
AS_ROOM = "taken as the room, as no other column is: is the machine in there?"
FLUID_ALONE = "of a coolant by its name; taken as a part, as no other column is"
INDOORS = "a room of a house: taken as a part"
AS_FLOW = "the speed of a fan or a pump: taken as a flow, of which only the changes count"
ON_OFF = "on and off, by its values alone: heat, cooling, or neither?"
OF_READINGS = "made of readings that stand nowhere, by its name"
OF_HEATER = "of a heater, by its letter and the number of a temperature"
BOTH_WAYS = "below zero, as what heats and cools"
VARIANT = "its name is that of another temperature and a word more: is it made of that?"
ELECTRICAL = "electrical: as of one pole pair, in rpm"
AS_SPEED = "no speed was recorded: the frequency of the supply, as of one pole pair"
OF_SUPPLY = "the frequency of the supply: the speed beside it says as much"
LARGEST_HZ = 1000.0  # of a supply; inverters for motors switch faster
QUICK = 0.6  # of the fastest: windings of the same machine
FULL = (100.0, 255.0, 1023.0, 4095.0)  # of a fan, a pump or a heater that was off: percent, 8, 10 or 12 bits
PERCENT = 130.0  # of a load, at most
MANUAL = "left out by hand"
OF_USER = "the user"  # how a column was told that the user placed
CERTAIN = ("a set point, not a reading", OF_ROWS, MANUAL, FUNCTION, OF_SUPPLY, "--set gives it")  # nothing is lost
REMARK_WORDS = READ | SETPOINT | frozenset().union(*QUANTITY.values(), *ROLES.values())  # in brackets no unit
TURNING = ("speed", "torque")  # of a machine
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

    def also(self, doubt: str) -> Guess:
        """With one more doubt."""
        return replace(self, doubt="; ".join(filter(None, (self.doubt, doubt))))


def guesses(source: Source, clock: Sequence[str], target: Target) -> list[Guess]:
    """One per column that is not a clock."""
    every = _by_readings(source, [guess(source, c, target) for c in source.cells if c not in clock], target)
    every = _without_extremes(source, every)
    every = _cold_start_outliers(source, _read(source, _without_functions(source, every), target), target)
    kelvin = sum(g.unit == "K" for g in every if g.quantity == "temperature")
    axes = {axis for g in every if g.quantity == "current" and (axis := axis_of(source.labels[g.column]))}
    both = {axis for pair in AXES if pair <= axes for axis in pair} - {axis_of(name) for name in target.inputs}
    for i, g in enumerate(every):  # a component has an input of its own: the current is the root sum square of both
        if g.feeds and (axis := axis_of(source.labels[g.column])) in both:
            every[i] = replace(g, feeds=f"{axis}_A")
    every = _with_switches(source, _of_converter(source, _products(source, _with_speed(source, every, target), target)))
    every = _quickest(source, every, target)
    return _of_one(source, single(every if kelvin else _in_fahrenheit(source, every), target, source.labels))


def _by_readings(source: Source, every: list[Guess], target: Target) -> list[Guess]:
    """With columns as temperatures whose readings are like those of the others, where no unit says what they are."""
    hot = [g for g in every if g.quantity == "temperature" and not is_setpoint(source.labels[g.column])]
    starts = [float(np.median(v[:FIRST_ROWS])) for g in hot if (v := readings_in_memory(source, g)).size]
    every = [_read_as(source, g, starts, target) if g.doubt == UNTOLD or g.why == "name" else g for g in every]
    series = {_stem(source.labels[g.column]): source.finite(g.column) for g in every if g.why in ("readings", "values")}
    for i, g in enumerate(every):  # the others of a row of numbered ones, which jump, or hardly move
        if g.doubt == UNTOLD and (one := series.get(_stem(label := source.labels[g.column]))) is not None:
            values = source.finite(g.column)
            alike = abs(np.median(values[:FIRST_ROWS]) - np.median(one[:FIRST_ROWS])) < ALIKE_K
            if alike and UNNAMED[0] < values.min() <= values.max() < UNNAMED[1]:
                every[i] = _placed(replace(g, quantity="temperature", unit="degC", doubt=BY_READINGS), label, target)
    return every


def _stem(label: str) -> tuple[str, ...]:
    """What a name has in common with those that differ by their numbers; the name itself where it has none."""
    words = tokens(label)
    return tuple(w for w in words if not w.isdigit()) if any(map(str.isdigit, words)) else (label,)


def _read_as(source: Source, g: Guess, starts: Sequence[float], target: Target) -> Guess:
    """A column by its readings; a doubt, where a word of its name says otherwise."""
    label, untold = source.labels[g.column], g.doubt == UNTOLD
    alternating = axis_of(label) or {"irms", "urms"} & {*tokens(label)}
    if g.quantity == "temperature" or source.units[g.column] or alternating or not (untold or starts):
        return g
    if not is_like_temperature(source.numbers(g.column), starts, START_K if untold else ALIKE_K):
        return g
    if untold or all(len(w) == 1 for w in tokens(label) if w in QUANTITY[g.quantity]):
        return _placed(Guess(g.column, "temperature", "degC", why="readings", doubt=BY_READINGS), label, target)
    return replace(g, doubt=f"or {BY_READINGS}")


def _without_extremes(source: Source, every: list[Guess]) -> list[Guess]:
    """Without the largest and the least beside a reading, of which that would be a function, too; with a doubt at a
    temperature whose name is that of another and a word that nobody knows."""
    words = {g.column: {*tokens(source.labels[g.column])} for g in every if g.quantity}
    means = [words[c] - MEAN for c in words if not words[c] & EXTREME]
    parts = [words[g.column] for g in every if g.place and not of_edge(roles_of(source.labels[g.column]))]
    bases = [other - READ for other in parts if any(len(w) > 1 for w in other - READ - QUANTITY["temperature"])]
    for i, g in enumerate(every):
        mine = words.get(g.column, set())
        if mine & EXTREME and mine - EXTREME in means:
            every[i] = Guess(g.column, "", doubt=f"{FUNCTION}: of the reading beside it")
        elif mine & EXTREME:
            every[i] = replace(g, doubt=g.doubt or OF_READINGS)
        elif mine in parts and any(is_unknown(word) for other in bases if other < mine for word in mine - other):
            every[i] = replace(g, doubt=g.doubt or VARIANT)
    return every


def _without_functions(source: Source, every: list[Guess]) -> list[Guess]:
    """Without what is a function of temperatures; a copy under a name of its own is doubted."""
    hot = {g.column: g for g in every if g.quantity == "temperature" and not is_setpoint(source.labels[g.column])}
    roles = {c: roles_of(source.labels[c])[:1] for c in hot}
    order = sorted(hot, key=lambda c: (not roles[c], bool({*tokens(c)} & (EXTREME | MEAN))))
    rest = [g for g in every if g.column not in hot and source.is_numeric(g.column) and g.why != SUREST]
    others = {g.column: source.numbers(g.column) for g in rest if g.used or g.doubt in ("", UNTOLD)}
    free = {*others} | {c for c in order if not source.units[c]}
    functions = functional_relations({c: in_memory(source, hot[c]) for c in order}, others, free)
    out = []
    for g in every:
        why = functions.get(g.column, "")
        twin = next((c for c in hot if why == f"{SAME} '{c}'"), "")
        plain = not {*tokens(g.column)} & (EXTREME | MEAN) and not {*tokens(twin)} < {*tokens(g.column)}
        distinct = twin and roles.get(g.column) and plain
        out.append(replace(g, doubt=why) if distinct else g.without(f"{FUNCTION}: {why}") if why else g)
    return out


def may_wind(columns: Iterable[tuple[str, Guess]]) -> bool:
    """May what is tested have a winding: does it turn, or does no name tell of a room or a battery?

    columns : labels and what was guessed of each
    """
    every = [*columns]
    other = any(INDOORS in g.doubt or is_spoken(label, ROOMS | BATTERY) for label, g in every)
    return not other or any(g.quantity in TURNING or is_spoken(label, MACHINE) for label, g in every)


def _quickest(source: Source, every: list[Guess], target: Target) -> list[Guess]:
    """With a doubt at those of the stator, or that follow the heat fastest, where none is of a winding by its name."""
    hot = {
        g.column: roles_of(source.labels[g.column]) for g in every if g.quantity == "temperature" and g.why != "values"
    }
    heats = [source.numbers(g.column) for q in FACTORS for g in every if g.feeds and g.quantity == q]
    first = not target.places  # of a network that is to be made from the columns
    wound = may_wind((source.labels[g.column], g) for g in every)
    if not wound or any(Role.WINDING in roles for roles in hot.values()):
        return every
    headers = target.places_by_header.keys()
    if stators := {c for c in hot if is_stator(label := source.labels[c]) and (first or label in headers)}:
        doubts = {g.column: OF_STATOR if first or not g.doubt else g.doubt for g in every}
        return [replace(g, doubt=doubts[g.column]) if g.column in stators else g for g in every]
    if not heats or any(is_whole(source.labels[c]) for c in hot):
        return every
    parts = [g for g in every if g.column in hot and not of_edge(hot[g.column])]
    parts = [g for g in parts if not g.doubt.startswith((*CERTAIN, OF_INSTRUMENT))]
    scores = {g.column: quickness(in_memory(source, g), heats[0]) for g in parts}
    most = max(scores.values(), default=0.0)
    quick = [c for c, score in scores.items() if score > QUICK * most > 0.0]
    if len(quick) == len(scores) or any(hot[c] for c in quick):
        return every
    doubts = {g.column: FASTEST if first or not g.doubt else f"{g.doubt}; {FASTEST}" for g in every}
    return [replace(g, doubt=doubts[g.column]) if g.column in quick and (first or g.place) else g for g in every]


def _products(source: Source, every: list[Guess], target: Target) -> list[Guess]:
    """Without powers of single phases beside their sum; where something turns without those that are products of what
    was recorded, and without those of both signs: they pass through it."""
    powers = {g.column: in_memory(source, g) for g in every if g.quantity == "power" and g.feeds}
    feeds = {g.column: g.feeds for g in every}
    stems = {c: [w for w in tokens(source.labels[c]) if len(w) > 1 and not w.isdigit()] for c in powers}
    for total, whole in powers.items():
        phases = [c for c in powers if feeds[c] == feeds[total] and stems[c] != stems[total] and not {*stems[c]} & LOSS]
        phases = [c for c in phases if sum(stems[c] == stems[other] for other in phases) > 1]
        slack = OF_SUM * np.nanmax(np.abs(whole))
        if phases and np.allclose(sum(powers[c] for c in phases), whole, atol=slack, equal_nan=True):
            every = [g.without(f"{OF_PHASE} '{total}'") if g.column in phases else g for g in every]
    factors = {g.column: source.numbers(g.column) for g in every if g.feeds and g.quantity in FACTORS}
    if not any(g.feeds and g.quantity == "speed" for g in every):
        return every
    powers = {c: P for c, P in powers.items() if feeds[c] not in target.inputs}
    products = {c for c in powers if is_product(source.numbers(c), [*factors.values()])}
    both_ways = {c for c, P in powers.items() if min(-np.nanmin(P), np.nanmax(P)) > OF_SUM * np.nanmax(np.abs(P))}
    every = [g.without(BACK) if g.column in both_ways else g for g in every]
    return [g.without(PASSES) if g.column in products else g for g in every]


def _of_converter(source: Source, every: list[Guess]) -> list[Guess]:
    """With a doubt at powers of a converter where both sides and no loss were recorded."""
    words = {g.column: {*tokens(source.labels[g.column])} for g in every if g.quantity == "power"}
    both = all(any(of & side for of in words.values()) for side in CONVERTED)
    if not both or any(of & LOSS for of in words.values()):
        return every
    sides = {c for c, of in words.items() if of & frozenset().union(*CONVERTED)}
    return [g.also(ONE_SIDE) if g.column in sides and g.feeds else g for g in every]


def _with_speed(source: Source, every: list[Guess], target: Target) -> list[Guess]:
    """With the frequency of a supply as the speed where none was recorded, unless the model reads a frequency."""
    turns = any(g.quantity == "speed" and g.feeds for g in every)
    for i, g in enumerate(every if "frequency" not in target.inputs.values() else ()):
        if g.quantity == "frequency" and g.feeds and np.nanmax(in_memory(source, g)) <= LARGEST_HZ:
            speed = replace(g, quantity="speed", doubt=AS_SPEED)
            every[i] = g.without(OF_SUPPLY) if turns else _fed(speed, source.labels[g.column], target)
            turns = True
    return every


def _with_switches(source: Source, every: list[Guess]) -> list[Guess]:
    """With what is on and off under no known name as an input, unless another input parts the two as well."""
    for i, g in enumerate(every):
        if g.doubt == UNTOLD and {*(on := source.numbers(g.column))[np.isfinite(on)]} == {0.0, 1.0}:
            inputs = [source.numbers(other.column) for other in every if other.feeds]
            pairs = [(x[on == state], x[on == 1 - state]) for x in inputs for state in (0, 1)]
            if not any(np.fmax.reduce(a, initial=-np.inf) < np.fmin.reduce(b, initial=np.inf) for a, b in pairs):
                switch = replace(g, quantity="share", unit="1", why="values", doubt=ON_OFF)
                every[i] = replace(switch, feeds=input_name(switch))
    return every


def _of_one(source: Source, every: list[Guess]) -> list[Guess]:
    """Of the first machine, and a doubt, where speeds differ by a number alone; a doubt at all that are numbered, and
    where a number in every row names one of several."""
    ids = {g.column: source.numbers(g.column) for g in every if g.doubt == OF_ROWS}
    for n in (n for n, of in ids.items() if np.unique(of).size < STATES and np.mean(np.diff(of) != 0) > FALLING):
        every = [g.also(f"{MIXED} '{n}'") if g.place else g for g in every]
    words = {g.column: itertools.pairwise(tokens(source.labels[g.column])) for g in every if g.place}
    numbers = {c: n for c, pairs in words.items() for word, n in pairs if word in MACHINE and n.isdigit()}
    if len({*numbers.values()}) > 1:
        every = [g.also(NUMBERED_MACHINE) if g.column in numbers else g for g in every]
    stems = {g.column: (g.quantity, *filter(str.isalpha, tokens(source.labels[g.column]))) for g in every if g.feeds}
    lost = stems.keys() - {stem: column for column, stem in reversed(stems.items())}.values()
    if not any(stems[column][0] == "speed" for column in lost):
        return every
    every = [g.without(SEVERAL) if g.column in lost else g for g in every]
    return [replace(g, doubt=SEVERAL) if g.quantity == "speed" and g.feeds else g for g in every]


def _read(source: Source, every: list[Guess], target: Target) -> list[Guess]:
    """Without the temperatures that a model made, and that never change, where others were read; the air
    of a cabinet is the room where no other column is and all parts are warmer."""
    hot = {g.column: source.labels[g.column] for g in every if g.quantity == "temperature"}
    parts = [c for c in hot if not of_edge(roles_of(hot[c]))]
    still = {c for c in parts if np.nanmax(values := source.numbers(c)) == np.nanmin(values)}
    every = [g if g.column not in still else g.also(DEAD) if still == {*parts} else g.without(DEAD) for g in every]
    models = {c for c, label in hot.items() if MODELLED & {*tokens(PATH.split(label)[-1])}}
    if len(models) < len(hot):
        every = [Guess(g.column, "", doubt="modelled, not read") if g.column in models else g for g in every]
    instruments = {
        g.column
        for g in every
        if (label := hot.get(g.column)) and g.quantity and is_spoken(label, INSTRUMENT)
        if not (roles_of(label) or is_spoken(label, MACHINE))
    }
    loads = {w for g in every if g.feeds for w in tokens(source.labels[g.column])} & LOGGER  # "cpu" beside its load
    instruments = {c for c in instruments if not loads & {*tokens(hot[c])}}
    moving = {*parts} - (still if still != {*parts} else set())
    rest = [g for g in every if g.column in moving and g.quantity and g.column not in instruments]
    mean_of = {g.column: np.nanmean(in_memory(source, g)) for g in every if g.column in parts and g.quantity}
    coldest = min(mean_of, key=lambda c: mean_of[c], default="")
    edges = [b for b, role in target.boundaries.items() if role is Role.AMBIENT] if target.places else ["ambient"]
    has_room = any(Role.AMBIENT in roles_of(label)[:1] for label in hot.values())
    if rest and coldest in instruments and is_spoken(hot[coldest], CABINET) and edges and not has_room:
        every = [replace(g, place=edges[0], doubt=AS_ROOM) if g.column == coldest else g for g in every]
        instruments -= {coldest}
    warmest = max((np.nanmax(in_memory(source, g)) for g in rest), default=np.inf)
    has_name = any(is_spoken(hot[g.column], MACHINE) or roles_of(hot[g.column]) for g in rest)
    warmest = np.inf if has_name else warmest
    turns = any(g.quantity in TURNING for g in every)
    tested = any(is_spoken(hot[g.column], SPOT) for g in rest) or (bool(rest) and not (has_name or turns))
    for i, g in enumerate(every):
        if g.column not in instruments:
            continue
        itself = is_spoken(hot[g.column], LOGGER)
        if np.nanmax(in_memory(source, g)) > warmest:
            every[i] = replace(g, doubt=OF_DEVICE)
        elif tested and not itself:
            every[i] = replace(g, doubt=OF_TESTED)
        else:
            device = is_spoken(g.place, INSTRUMENT) and not is_spoken(g.place, MACHINE)
            # a device is what is tested
            alone = len(instruments) == len({*hot} - still | instruments) or not (rest or itself)
            stays = (alone and not g.place) or device
            every[i] = replace(g, doubt=OF_INSTRUMENT) if stays else Guess(g.column, "", doubt=OF_INSTRUMENT)
    return every


def is_of_flow(label: str) -> bool:
    """Does it name a flow of air or liquid, or what makes it flow?"""
    return bool({AIR, LIQUID} & {*quantities_of(label)}) or is_spoken(label, PUMP)


def of_edge(roles: Sequence[Role]) -> bool:
    """Is a column of such roles of the room or the coolant, not of a part?"""
    return tuple(roles[:1]) in ((Role.AMBIENT,), (Role.COOLANT,))


def guess(source: Source, column: str, target: Target) -> Guess:
    """A column by itself."""
    if odd := _left_out(source, column):
        return Guess(column, "", doubt=odd)
    label, unit_text = _by_partner(source, column), source.units[column]
    if OMEGA.search(label) and any("torque" in quantities_of(other) for other in source.labels.values()):
        label = OMEGA.sub("omega", label)
    heater = HEATER.fullmatch(label) if not unit_text else None
    if heater and f"T{heater[1]}" in source.labels.values():
        label = f"heater {heater[1]}"
    controls = any(map(is_setpoint, source.labels.values()))  # a controller's output is a share of what it can give
    if not (unit_text or quantities_of(label)) and {*tokens(label)} & ({"load", "output"} if controls else {"load"}):
        label = f"{label} share"
    unit = unit_of(unit_text) or _called_unit(label)
    by_values = source.unnamed and not unit
    quantity, why, doubt = _by_values(source, column, target) if by_values else _quantity(label, unit, target)
    if not quantity:
        return Guess(column, "", doubt="a clock? say so: time [s]" if _counts_on(source, column) else UNTOLD)
    values = source.numbers(column)
    worded = unit_text or "temperature" in quantities_of(label)
    if not unit_text and values[0] in (0, 1) and bool((np.diff(values) == 1).all()):  # "Frame" of a camera
        return Guess(column, "", doubt="counts the rows")
    whole = {*values[np.isfinite(values)].tolist()} <= {*range(STATES)}
    flows = is_of_flow(label) or Role.COOLANT in roles_of(label)  # what a fan, a pump or a cooler does
    if flows and not worded and whole and (is_stage(label) or AIR in quantities_of(label) or np.nanmax(values) <= 1):
        return _fed(Guess(column, "flow_share", "1", why="name", doubt=STAGES), label, target)
    on_off = {*values[np.isfinite(values)].tolist()} == {0.0, 1.0}
    flag = why == "unit" and quantity not in SWITCHED and {*values[np.isfinite(values)]} <= {0.0, 1.0}
    still = not unit_text and np.nanmax(values) == np.nanmin(values)  # temperature_source
    if flag or (quantity == "temperature" and whole and (still or not worded)):
        return Guess(column, "", doubt="a state, by its values" if flag or not on_off else UNTOLD)
    cooled = any(Role.COOLANT in roles_of(other) for other in source.labels.values())
    of_fan = quantity == "speed" and (AIR in quantities_of(label) or (cooled and is_spoken(label, PUMP)))
    of_fan &= not is_spoken(label, MACHINE)
    if of_fan and target.input_of(label, quantity) in ("", INPUTS["speed"]):
        quantity, unit, doubt = "flow_share", "%", AS_FLOW
    if quantity in (AIR, LIQUID, "power") and not unit and np.nanmin(values) == 0.0:
        shares = {AIR: FULL, LIQUID: FULL, "power": FULL[1:]}[quantity]  # 100 W is a power
        quantity = ("share" if quantity == "power" else "flow_share") if np.nanmax(values) in shares else quantity
    unit, assumed = _unit(source, column, quantity, unit)
    if not unit_text and (match := FOREIGN.search(label) or ROUND.search(label)) and quantity != "temperature":
        if quantity == "speed" and not set(tokens(match[1])) & REMARK_WORDS:  # of a vehicle, or a counter
            return Guess(column, "", doubt=f"unit '{match[1]}' {UNKNOWN}: is it a speed of the machine?")
        assumed = f"unit '{match[1]}' {UNKNOWN}: {unit} assumed"
    base = Guess(column, quantity, unit, why=why, doubt=doubt).also(assumed)
    if heater and quantity == "share":
        base = replace(base, doubt=OF_HEATER).also(assumed)
    if quantity == "share" and np.nanmin(values) < 0:
        return Guess(column, "", doubt=BOTH_WAYS)
    if quantity not in SWITCHED and source.is_switch(column):
        return Guess(column, "", doubt=f"on and off, no {quantity.replace('_', ' ')}")
    codes = values[coded(values, FAR) & (np.abs(values) > LARGEST_THERMOCOUPLE)]
    if quantity != "temperature" and codes.size:
        base = replace(base, doubt=f"is {codes[0]:g} a reading, or a logger's code?")
    if out := _impossible(source, base):
        return Guess(column, "", doubt=out)
    return _placed(base, label, target) if quantity == "temperature" else _fed(base, label, target)


def _by_partner(source: Source, column: str) -> str:
    """Its name, with voltage or current for what stands where another has the word or the letter of the other."""
    words = [word.lower() for word in WORD.findall(source.labels[column])]
    ends_united = any(source.units[c] and SUFFIX.search(c) for c in source.cells)  # temp_c beside core_v
    if not PARTNERS.keys() & {*words}:
        return source.labels[column]
    others = {tuple(map(str.lower, WORD.findall(label))) for label in source.labels.values()}
    for i, word in enumerate(words):
        partner, meaning = PARTNERS.get(word, ("", ""))
        rest = [*words[:i], *words[i + 1 :]]
        phases = any((*words[:i], phase, *words[i + 1 :]) in others for phase in "uw")
        volts = ends_united and source.labels[column][-2:] == "_v" and i == len(words) - 1 > 0
        paired = volts or (*words[:i], partner, *words[i + 1 :]) in others
        if paired and not (phases or quantities_of(" ".join(rest))):
            return " ".join([*rest, meaning])
    return source.labels[column]


def _cold_start_outliers(source: Source, every: list[Guess], target: Target) -> list[Guess]:
    """With a doubt at what is warm where all others start alike, as what is not of a machine at rest."""
    hot = [g for g in every if g.quantity == "temperature" and (g.place or not g.used) and not g.doubt.startswith(SAME)]
    starts = {g.column: float(v[0]) for g in hot if (v := readings_in_memory(source, g)).size}
    usual = float(np.median([*starts.values()])) if starts else 0.0
    odd = {c for c, start in starts.items() if abs(start - usual) > START_K}
    odd -= {c for c in odd if roles_of(source.labels[c])[:1] == [Role.AMBIENT] or is_spoken(source.labels[c], INLET)}
    rest = [abs(start - usual) for c, start in starts.items() if c not in odd]
    if len(rest) < max(len(odd) + 1, 3) or float(np.mean(rest)) > ALIKE_K / 2:
        return every
    if any(g.quantity == "speed" for g in every) and not any(g.quantity == "torque" for g in every):
        loads = {c for c in odd if LOAD.fullmatch(source.labels[c]) and not source.units[c]}
        torque = Guess("", "torque", "N*m", why="readings", doubt=AS_TORQUE)
        odd -= loads
        every = [_fed(replace(torque, column=c), c, target) if (c := g.column) in loads else g for g in every]
    doubts = {c: f"starts at {starts[c]:.3g} degC, all others near {usual:.3g}: is it of this machine?" for c in odd}
    return [replace(g, doubt=g.doubt or doubts.get(g.column, "")) for g in every]


def _left_out(source: Source, column: str) -> str:
    """Why a column is none that a model reads, "" where it may be one: a unit in its header is law."""
    if is_second_clock(source, column) and not _runs_back(source, column):
        return "a second clock, or a counter"
    if not source.is_numeric(column):
        return "words, not numbers" if np.size(source.cells[column]) and source.is_filled(column) else "empty"
    values = source.numbers(column)
    if (count := int(np.isfinite(values).sum())) < LEAST:
        return f"read {count} {'time' if count == 1 else 'times'} in all"
    unit_text, label = source.units[column], source.labels[column]
    unit, quantities = unit_of(unit_text), quantities_of(label)
    if (unit == "mV" and "voltage" not in quantities) or (unit in SIGNALS and quantities == ["temperature"]):
        return f"in {unit}: {OF_SENSOR}, no reading of its own"
    if unit_text and not unit:
        of_nothing = is_unit(unit_text) or not quantities
        return f"its unit '{unit_text}' is {'of nothing a model reads' if of_nothing else UNKNOWN}"
    if unit == "%" and quantities == ["temperature"]:
        return "a temperature in percent: of what?"
    words = set(tokens(label)) | set(re.findall(r"[a-z]+", label.lower()))
    if is_rise(label) and not words & QUANTITY["power"]:
        return "a difference of temperatures, or a rate: not a temperature"
    if (parts := PATH.split(label))[1:] and parts[-1].strip().lower() in QUALITY:  # TI101.PV beside TI101.Q
        return "the quality of a reading"
    if words & SPARE:
        return "a spare channel, by its name"
    if words == {"bearing"} and any("longitude" in tokens(other) for other in source.labels.values()):
        return "a compass heading, beside a place on the map"
    if words & SPREAD:
        return "a spread of readings, not a reading"
    switched = (
        source.is_switch(column)
        and {0.0, 1.0} <= {*values.tolist()}
        and (is_of_flow(label) or {"share", "power"} & {*quantities})
    )  # "Fan Status"
    if (odd := words & (NOTHING | RATIO if unit == "%" else NOTHING)) and unit in WEAK and not switched:
        return f"'{sorted(odd)[0]}' is nothing a model reads"
    identifies = "id" in words and not unit_text and bool((values[np.isfinite(values)] % 1 == 0).all())
    of_device = words > {"id"} and not any(axis_of(other) == "iq" for other in source.labels.values())  # sensor_id
    identifies &= of_device or _counts_on(source, column) or {*values} == {values[0]} - {0.0}
    return OF_ROWS if identifies else ""


def _impossible(source: Source, g: Guess) -> str:
    """Why its readings cannot be what the name says, "" where they can: one bad column costs one column."""
    finite = readings_in_memory(source, g)
    low, high = (COLDEST, HOTTEST) if g.quantity == "temperature" else (-LARGEST, LARGEST)
    if not finite.size:
        return CODES_ALONE
    worst = finite[np.argmax(np.maximum(low - finite, finite - high))]
    return "" if low <= worst <= high else f"{worst:.4g} as {g.quantity.replace('_', ' ')} {CANNOT_BE}"


def _in_fahrenheit(source: Source, every: list[Guess]) -> list[Guess]:
    """With temperatures whose room and all others start where rooms do in Fahrenheit read or doubted as such, and
    doubted where no unit says that they are as small as no room is."""
    hot = {g.column: g for g in every if g.quantity == "temperature" and g.unit == "degC" and (g.place or not g.used)}
    sizes = [float(np.nanmax(np.abs(in_memory(source, g)))) for g in hot.values()]
    if max(sizes, default=SCALED) < SCALED and not any(source.units[column] for column in hot):
        small = f"never beyond {SCALED:g} degC: {ELSE}"
        return [replace(g, doubt=small) if g.column in hot and g.used else g for g in every]
    starts = {c: v[0] for c, g in hot.items() if (v := readings_in_memory(source, g)).size}
    rooms = [c for c in starts if Role.AMBIENT in roles_of(source.labels[c])[:1]]
    alike = np.ptp([*starts.values()] or [ALIKE_F, 0.0]) < ALIKE_F
    alike &= len(starts) > 1 or not any(source.units[c] for c in hot)
    if not (rooms or alike) or not all(ROOM_F[0] < s < ROOM_F[1] for s in starts.values()):
        return every
    return [_fahrenheit(source, g, bool(rooms)) if g.column in hot else g for g in every]


def _fahrenheit(source: Source, g: Guess, beside_room: bool) -> Guess:
    """Without a unit in the header it is read so; a unit in the header is law, and doubted aloud."""
    if not beside_room:
        return g.also("or degF, by its values")
    if source.units[g.column]:
        return replace(g, doubt=f"{source.units[g.column]} {IN_HEADER} Fahrenheit by its values?")
    return replace(g, unit="degF", doubt="no unit: degF by its values")


def _runs_back(source: Source, column: str) -> bool:
    """Is it too uneven for a clock: does it fall as often as readings do, and has it no unit of time?"""
    if source.units[column] or not source.is_numeric(column):
        return False
    steps = np.diff(source.numbers(column))
    return bool((steps < 0).sum() > FALLING * (steps != 0).sum())


def _counts_on(source: Source, column: str) -> bool:
    """Does it rise in every row?"""
    return bool((np.diff(source.finite(column)) > 0).all())


def _quantity(label: str, unit: str, target: Target) -> tuple[str, str, str]:
    """By the unit where a quantity has it, then by name, then by what the model reads or where it has places.

    Quantity, what it was told by, and a doubt.
    """
    of_unit = [q for q in FIRST if unit and (unit in QUANTITIES[q].units or unit in OTHER_UNITS.get(q, ()))]
    by_name = quantities_of(label)
    both = [q for q in by_name if q in of_unit]
    if unit in ("%", "1") and is_of_flow(label):
        return "flow_share", SUREST, ""
    if unit == "1" and not both:
        return "", "", ""  # a state or a counter as well as a share
    if unit == "%" and by_name and not {"share", "temperature"} & {*by_name}:
        return "share", "unit", f"{RELATIVE} {by_name[0].replace('_', ' ')} that is not given: a share"
    if of_unit:
        unsure = len(of_unit) > 1 and not both
        doubt = f"or a {of_unit[1]}" if unsure else "" if both or unit != "%" else OF_WHAT
        if not both and of_unit[0] in ("power", "torque") and by_name[:1] in (["power"], ["torque"]) and len(label) > 2:
            doubt = f"by its name a {by_name[0]}"
        return (both or of_unit)[0], SUREST if both else "unit", doubt
    feeds = "" if target.places_by_header else target.input_of(label, "")
    if feeds and (quantity := target.inputs[feeds]) in (by_name or [quantity]):
        return quantity, f"name like the input {feeds}", ""
    if (roles_of(label) or is_spoken(label, SPOT)) and by_name in ([], ["temperature"], ["vehicle_speed"]):
        weak = not any(is_spoken(label, terms) for terms in (*ROLES.values(), SPOT))
        return "temperature", "name of a part", BY_LETTERS if weak else ""
    if by_name and not (by_name == ["temperature"] and ANGLE.search(label)):
        worded = any(w in terms for w in tokens(label) for terms in QUANTITY.values() if len(w) > 1)
        return by_name[0], "name", BY_LETTERS if LETTERED.search(label) and not worded else ""
    if label in target.places_by_header:  # told by its readings, or by hand
        return "", "", ""
    place, _ = target.place_of(label)
    words = {w for w in tokens(label) if len(w) > 1}
    alike = place and words and words <= {*tokens(place)}
    return ("temperature", f"name like the place {place}", "") if alike else ("", "", "")


def _called_unit(label: str) -> str:
    """The unit that is all of a name, as in a column "rpm" or "mA"; a letter, or one with a number, is a phase's."""
    unit = "" if re.fullmatch(r"[^\W\d_](\W?\d+)?", label) else unit_of(label)
    return unit if any(unit in QUANTITIES[q].units for q in FIRST) else ""


def _by_values(source: Source, column: str, target: Target) -> tuple[str, str, str]:
    """Smooth readings of a file without names that can hardly be anything but temperatures, or are in another run."""
    values = source.finite(column)
    low, high = float(np.min(values)), float(np.max(values))
    absolute = KELVIN[0] < float(np.median(values)) < KELVIN[1]
    different = np.unique(values).size  # states are few, and whole numbers
    many = different > 0.1 * values.size or (different > LEAST and bool((values % 1 != 0).any()))
    celsius = UNNAMED[0] < low and high < UNNAMED[1] and many
    if not (is_smooth(values) and (absolute or celsius)) and source.labels[column] not in target.places_by_header:
        return "", "", ""
    return "temperature", "values", f"no name: {BY_READINGS}"


def _unit(source: Source, column: str, quantity: str, unit: str) -> tuple[str, str]:
    """The unit, and a doubt where it had to be guessed from values or is not that of the values."""
    values = _without_codes(source.numbers(column)) if quantity == "temperature" else source.numbers(column)
    if quantity == "temperature" and np.isfinite(values).any():
        kelvin = KELVIN[0] < float(np.nanmedian(values)) < KELVIN[1] and float(np.nanmin(values)) > KELVIN[0]
        first = float(values[np.isfinite(values)][0])
        if kelvin and not unit and first > ROOM_K[0]:  # below it are tenths of a room's degrees, rather
            return "K", "no unit: guessed"
        if unit == "degC" and kelvin and ROOM_K[0] < first < ROOM_K[1]:
            return "K", f"{source.units[column]} {IN_HEADER} but K by its values"
        unit = unit or "degC"
        hot = unit == "degC" and first > ROOM_C[1]
        return unit, f"starts at {first:.4g} degC: {ELSE}" if hot else ""
    if unit:
        return unit, ""
    if quantity in ("share", "flow_share"):
        most = float(np.nanmax(np.abs(values)))
        small = most <= 1.0
        if most > PERCENT:
            return "%", f"goes to {most:g}, so in no percent: only its changes count"
        return ("1" if small else "%"), "no unit: guessed"
    words = {*tokens(source.labels[column])}
    robot = "velocity" in words and any("effort" in tokens(label) for label in source.labels.values())  # of ROS
    radians = quantity == "speed" and ("omega" in words or OMEGA.search(source.labels[column]) or robot)
    first_unit = "rad/s" if radians else next(iter(QUANTITIES[quantity].units))
    return first_unit, ELECTRICAL if ERPM.search(source.labels[column]) else f"{NO_UNIT}: {first_unit} is assumed"


def _placed(base: Guess, label: str, target: Target) -> Guess:
    if is_setpoint(label):
        return base.without("a set point, not a reading")
    place, other = target.place_of(label)
    if not place:
        return base.without("no place of the model fits its name")
    common = set(tokens(label)) & set(tokens(place))
    weak = bool(common) and all(w.isdigit() for w in common) and not roles_of(label)
    whole = WHOLE if is_whole(label) else ""
    by_header, roles = target.places_by_header.get(label) == place, roles_of(label)[:1]
    room = HARDLY if by_header and place == "ambient" and not roles else ""
    if by_header and roles == [Role.AMBIENT] and place not in target.boundaries and target.boundaries:
        room = INDOORS
    if by_header and roles == [Role.COOLANT] and place not in target.boundaries and not is_spoken(label, OIL):
        room = FLUID_ALONE
    doubt = f"or {other}" if other else room or (NUMBERED if weak else base.doubt or whole)
    return replace(base, place=place, doubt=doubt)


def is_whole(label: str) -> bool:
    """Does it name the machine, and no part of it?"""
    return not roles_of(label) and is_spoken(label, MACHINE)


def _fed(base: Guess, label: str, target: Target) -> Guess:
    if base.quantity in ELSEWHERE:
        return base.without(f"a {base.quantity} needs more than its unit: docs/how-to/thermal-test.md")
    name = target.inputs_by_column.get(base.column) or target.input_of(label, base.quantity)
    return replace(base, feeds=name or QUANTITIES[base.quantity].feeds)


def single(guesses: list[Guess], target: Target, labels: Mapping[str, str]) -> list[Guess]:
    """One column per boundary and per input; of several readings go before set points, the first before the rest."""
    owner: dict[str, str] = {}
    out = {g.column: g for g in guesses}
    words_of_parts = {word for g in guesses if g.place for word in tokens(labels[g.column])}
    devices = {w for w in words_of_parts if is_unknown(w) or w in INSTRUMENT}  # the gpu's power heats the gpu

    def order(g: Guess) -> tuple[int, ...]:
        words = {*tokens(g.column), *tokens(labels[g.column])}
        inlet = bool(g.place) and not is_spoken(g.column, INLET)
        mixed = g.place == "ambient" and len(roles_of(g.column)) > 1  # the air of a frame
        of_machine = is_spoken(labels[g.column], MACHINE)  # before a cadence, and a battery
        later = {
            "current": bool(words & (SUPPLY | MEAN)),
            "power": 2 * (not words & LOSS) + (not words & devices),
            "speed": not of_machine,
        }.get(g.quantity, mixed)
        other = bool(g.place) and g.place not in words
        outdoors = bool(g.place and (is_within(g.column, OUTER) or is_spoken(g.column, INSTRUMENT)))  # no room of it
        more = len(words) * bool(g.place)  # "T room" is the room before "T chamber wall" is
        plain = not g.feeds or input_name(g) == g.feeds  # "Speed" is the speed before "S-1 [1/s]" is
        return is_setpoint(g.column), later, not READ & words, inlet, outdoors, other, g.why != SUREST, not plain, more

    for g in sorted(guesses, key=order):
        key = g.feeds or (g.place if g.place in target.boundaries else "")
        if not key:
            continue
        if g.feeds and is_setpoint(g.column):  # also a share of what is read in its own unit
            key = next((f for q in quantities_of(g.column) if (f := QUANTITIES[q].feeds) in owner), key)
        if key not in owner:
            owner[key] = g.column
            if g.feeds and is_setpoint(g.column):
                out[g.column] = g.also(DEMAND)
            continue
        of_part = g.quantity == "power" and (NO_UNIT not in g.doubt or roles_of(g.column) or is_spoken(g.column, ROOMS))
        if g.feeds and (g.feeds not in target.inputs or of_part) and not is_setpoint(g.column):  # of copper or iron
            stem, _, unit = input_name(g).rpartition("_")
            names = (f"{stem}{end}_{unit}" for end in ("", *(f"_{i}" for i in range(2, len(guesses) + 2))))
            out[g.column] = replace(g, feeds=next(n for n in names if owner.setdefault(n, g.column) == g.column))
        else:
            out[g.column] = g.without(f"{owner[key]} gives {key} already")
    return [out[g.column] for g in guesses]


def assigned(guesses: Sequence[Guess], source: Source, column: str, to: str, target: Target) -> list[Guess]:
    """With a column at another place or input, "" to leave it out; what gave a boundary or an input before gives way.

    to : a quantity is the usual input of it, which no law need follow yet.  Raises InputError where it cannot go there.
    """
    places = {**target.places, **target.boundaries}
    to = to if to in places or to in target.inputs else INPUTS.get(to, to)
    single = to in target.inputs or to in target.boundaries or (to in USUAL and to not in places)
    others = [g.without(f"{column} gives {to}") if single and to in (g.place, g.feeds) else g for g in guesses]
    return [_moved(g, source, to, target) if g.column == column else o for g, o in zip(guesses, others, strict=True)]


def _moved(g: Guess, source: Source, to: str, target: Target) -> Guess:
    """A column where the user puts it."""
    if not to:
        return g.without(MANUAL)
    if not source.is_numeric(g.column):
        raise InputError("holds words, not numbers", g.column, "a column of readings")
    is_place = to in target.places or to in target.boundaries
    quantity = "temperature" if is_place else target.inputs.get(to) or USUAL.get(to) or measure_of(to)
    if not quantity and to not in target.inputs:
        raise InputError(f"the model has no '{to}'", g.column, ", ".join([*target.places, *target.inputs][:8]))
    quantity = quantity or g.quantity
    if g.quantity and quantity != g.quantity and g.doubt not in (ON_OFF, AS_FLOW):
        raise InputError(f"is a {g.quantity}, '{to}' wants a {quantity}".replace("_", " "), g.column, "another column")
    units = [unit for unit in (g.unit, unit_of(source.units[g.column])) if unit in QUANTITIES[quantity].units]
    unit = units[0] if units else _unit(source, g.column, quantity, "")[0]
    place, feeds = (to, "") if quantity == "temperature" and to not in target.inputs else ("", to)
    return replace(g, quantity=quantity, unit=unit, place=place, feeds=feeds, why=OF_USER, doubt="")


def input_name(g: Guess) -> str:
    """An input called after the column, with the unit that memory holds."""
    unit = QUANTITIES[g.quantity].feeds.rpartition("_")[2]
    words = [w for w in tokens(g.column) if w.isascii() and w != unit.lower()]
    return "_".join([*words, unit]) if words else f"{g.quantity}_{unit}"


def in_memory(source: Source, g: Guess) -> Array:
    """Readings in the unit of memory, without a logger's codes."""
    values = source.numbers(g.column)
    return converted(_without_codes(values) if g.quantity == "temperature" else values, g.quantity, g.unit)


def readings_in_memory(source: Source, g: Guess) -> Array:
    """Those of its rows that have one."""
    values = in_memory(source, g)
    return values[np.isfinite(values)]


def _without_codes(values: Array) -> Array:
    """Temperatures as the file has them, without what a logger writes where it read nothing."""
    return np.where(coded(values), np.nan, values)
