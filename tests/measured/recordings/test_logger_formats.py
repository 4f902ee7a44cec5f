"""A hundred and more formats of loggers: every column is what its writer meant, or its doubt is said aloud."""

import numpy as np
import pytest
from logger_formats import FORMATS, ROWS, signals

from geom.description.names import plain_header
from measured.importing.clock import clock_of
from measured.importing.guess import ON_OFF, guesses, in_memory
from measured.importing.source import read_source
from thermoscope.commands.test.new import first_model

# Names that the reader makes itself: of these formats columns are told by their order.
RENAMED = {
    *("no header", "Arduino", "a serial monitor", "a second name over each", "groups over names"),
    *("an object on every line", "objects in an object", "names and units between bars"),
    *("remarks beside a clock", "names for statistics programs", "a comment sign before the names"),
    *("what channels are in a row of remarks", "a japanese logger and its table of channels"),
    *("units in a table of channels", "milliseconds in brackets"),
}


@pytest.mark.parametrize("kind", FORMATS)
def test_every_column_is_what_it_was_written_as(tmp_path, kind):
    form = FORMATS[kind]
    (tmp_path / form.name).write_bytes(form.content())
    source = read_source(tmp_path / form.name)
    clock = clock_of(source)
    found = guesses(source, clock.columns, first_model([(source, clock)], {}).target)
    assert {g.column for g in found if g.used and g.doubt == ON_OFF} == {*form.switches}
    used = {g.column: g for g in found if g.used and g.doubt != ON_OFF}
    assert clock.seconds[:ROWS] == pytest.approx(form.step_s * np.arange(ROWS), abs=2e-3 * form.step_s)
    assert form.doubt in " ".join([clock.doubt, *source.notes, *(g.doubt for g in found)])
    values = signals(form.step_s)
    letters = [c for c in form.columns if c in values and c != "t"]
    names = (
        list(used)
        if kind in RENAMED
        else [plain_header(n) for n, c in zip(form.header(), form.columns) if c in letters]
    )
    assert set(used) == set(names), [g.doubt for g in found if not g.used]
    for name, letter in zip(names, letters, strict=True):
        g, read = used[name], in_memory(source, used[name])[:ROWS]
        assert (g.quantity == "temperature") == (letter in "WHBA")
        assert (g.place == "ambient") == (letter == "A")
        fine = np.isfinite(read) & (read > -9998.0)
        assert fine.mean() > 0.95
        coarse = 0.5 * 10.0**-form.digits / form.scale.get(letter, (1.0,))[0]
        assert read[fine] == pytest.approx(values[letter][fine], abs=1.01 * coarse)
