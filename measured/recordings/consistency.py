"""A sheet against itself and against the network: what is said twice, or of something that is not there, is named."""

import difflib
from collections.abc import Iterator, Mapping

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from lumped.model.network import Network
from lumped.schemas.reader import suggestion
from measured.recordings.data_table import cell, twice
from measured.recordings.sheet import Column, Sheet
from measured.recordings.tables import Samples
from measured.recordings.units import QUANTITIES

NOISE = 0.02  # of the largest reading: as far below zero a power meter may read when nothing flows
NEAR = 0.8  # likeness of two names from which one is taken as a slip of the other
AMOUNTS = ("_W", "_percent")  # inputs whose laws take the amount, so that a sign would be lost


def checked_sheet(sheet: Sheet, network: Network) -> list[str]:
    """InputError for what contradicts; notes on constants that nothing reads."""
    _boundaries(sheet, network)
    return list(_unread(sheet, network))


def _boundaries(sheet: Sheet, network: Network) -> None:
    """Every boundary is given by one column or one constant, and every constant is of a boundary."""
    for name in sheet.boundaries:
        if name not in network.boundaries:
            right = suggestion(name, network.boundaries)
            raise InputError(f"no boundary is called '{name}'", f"{sheet.where} [boundaries]", right)
    places = [c.place for c in sheet.columns if c.is_temperature and c.place in network.boundaries]
    for name in twice([*places, *sheet.boundaries]):
        columns = [f"[columns.{c.name}]" for c in sheet.columns if c.is_temperature and c.place == name]
        columns += ["[boundaries]"] if name in sheet.boundaries else []
        what = f"boundary '{name}' is given by {' and by '.join(columns)}"
        raise InputError(what, sheet.where, "one of them: use = false, or delete the constant")


def _unread(sheet: Sheet, network: Network) -> Iterator[str]:
    """Notes on constants that no law reads; a slip of a name that one does read is refused."""
    read, usual = network.inputs, {quantity.feeds for quantity in QUANTITIES.values()}
    names = {c.feeds for c in sheet.columns}
    for name in set(sheet.inputs) - read - usual:
        near = difflib.get_close_matches(name, sorted(read - names - set(sheet.inputs)), n=1, cutoff=NEAR)
        if near:
            raise InputError(f"no law reads the input '{name}'", f"{sheet.where} [inputs]", suggestion(name, read))
        yield f"{sheet.where} [inputs]: no law of the model reads '{name}'"


def without_sign(network: Network, name: str) -> bool:
    """Whether a loss takes the amount of this input, so that -5 would heat as 5 does."""
    for source in network.sources:
        if name in source.law.reads:
            plus, minus = ({n: np.array([s if n == name else 1.0]) for n in source.law.reads} for s in (1.0, -1.0))
            a, b = float(np.mean(source.law.factor(plus))), float(np.mean(source.law.factor(minus)))
            if a == b != 0.0:
                return True
    return False


def is_amount(network: Network, name: str) -> bool:
    """Whether an input is a power or a share that a loss takes the amount of."""
    return name.endswith(AMOUNTS) and without_sign(network, name)


def checked_heat(
    sheet: Sheet, samples: Samples, inputs: Mapping[str, Array], network: Network
) -> tuple[dict[str, Array], list[str]]:
    """The inputs without negative powers: noise around nothing becomes 0 with a note, more than that is refused."""
    out, notes, columns = dict(inputs), [], {c.feeds: c for c in sheet.columns if c.feeds}
    for name, values in inputs.items():
        read = samples.values[columns[name].name] if name in columns else values
        lowest = float(np.nanmin(read))
        if lowest < 0.0 and is_amount(network, name):
            where = _cell(columns[name], samples) if name in columns else f"{sheet.where} [inputs] {name}"
            if lowest < -NOISE * float(np.nanmax(np.abs(read))):
                what = f"{lowest:g} is negative, and the loss that reads '{name}' would heat by it"
                raise InputError(what, where, "a power that is not negative: is a clamp reversed?")
            out[name] = np.maximum(values, 0.0)
            notes.append(f"{where}: readings down to {lowest:.3g} are taken as 0")
    return out, notes


def _cell(column: Column, samples: Samples) -> str:
    """Where a column is lowest."""
    row = int(np.nanargmin(samples.values[column.name]))
    return cell(samples.file, column.header, row, samples.line)
