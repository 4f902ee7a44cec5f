"""model.toml: the model as it stands, revision by revision. Revisions are only ever added; the last one counts."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from geom.description.toml_file import read_toml
from geom.errors import InputError
from geom.storage import locked, write_whole
from lumped.model.network import Network, Parameter
from lumped.schemas.reader import Table, suggestion
from measured.case import AddedEffect, Model, Reference, SignalReference
from validation.parameters.unknowns import measured

ACTIONS = ("calibrate", "add", "remove", "answer", "step back")
HEADER = "Written by thermoscope: one [[revision]] per step, the last one counts. Delete this file to start again."
Pair = tuple[float, float]
ROUNDED = 1e-6  # of a bound: values are written with eight digits


@dataclass(frozen=True)
class Revision:
    """One step of the model.

    effects : in the model after this step;  values : parameter -> value;  intervals : parameter -> (low, high) 95 %
    rmse_K : test -> (before, after);  evidence : what spoke for the step
    answers : what the user was asked and said so far; of a boundary or a sensor how well it is known (K)
    reference : what exponents and effects refer to; None in files of before it was kept, and where nothing was fitted
    """

    number: int
    action: str
    effects: tuple[str, ...] = ()
    effect: str = ""
    values: Mapping[str, float] = field(default_factory=dict)
    intervals: Mapping[str, Pair] = field(default_factory=dict)
    rmse_K: Mapping[str, Pair] = field(default_factory=dict)
    why: str = ""
    evidence: Mapping[str, float | str] = field(default_factory=dict)
    answers: Mapping[str, bool | float] = field(default_factory=dict)
    reference: Reference | None = None

    def document(self) -> dict[str, Any]:
        """As model.toml holds it."""
        out: dict[str, Any] = {"number": self.number, "action": self.action}
        if self.effect:
            out["effect"] = self.effect
        out["effects"], out["why"] = list(self.effects), self.why
        out["values"] = {k: float(f"{v:.8g}") for k, v in self.values.items()}
        out["intervals"] = {k: [float(f"{x:.5g}") for x in pair] for k, pair in self.intervals.items()}
        rmse = {t: [float(f"{x:.6g}") for x in pair] for t, pair in self.rmse_K.items()}
        out["rmse_K"] = {t: {"before": a, "after": b} for t, (a, b) in rmse.items()}
        more = {"evidence": dict(self.evidence), "answers": dict(self.answers)}
        more |= {"reference": _reference_document(self.reference)} if self.reference else {}
        return {**out, **{key: table for key, table in more.items() if table}}


@dataclass(frozen=True)
class History:
    """All revisions, numbered from 1; revision 0 is the model as declared."""

    revisions: tuple[Revision, ...] = ()

    @property
    def last(self) -> Revision:
        return self.revisions[-1] if self.revisions else Revision(0, "calibrate")

    @property
    def reference(self) -> Reference | None:
        """The newest that was kept: a model that went back to its beginning refers to the same."""
        return next((r.reference for r in reversed(self.revisions) if r.reference is not None), None)

    def model(self, network: Network, revision: Revision) -> Model:
        """The model after one of the revisions."""
        effects = tuple(AddedEffect(*name.partition("@")[::2]) for name in revision.effects)
        reference = revision.reference or self.reference
        return Model(network, effects, dict(revision.values), revision.number, reference, revision.intervals)

    def and_then(self, revision: Revision) -> "History":
        """One revision more; what the user answered stays."""
        answers = {**self.last.answers, **revision.answers}
        return self._longer(replace(revision, answers=answers))

    def _longer(self, revision: Revision) -> "History":
        return History((*self.revisions, replace(revision, number=self.last.number + 1)))

    def back_to(self, number: int) -> "History":
        """One more revision, equal to an earlier one."""
        by_number = {0: Revision(0, "step back"), **{r.number: r for r in self.revisions}}
        if number not in by_number:
            raise InputError(f"no revision {number}", "model.toml", f"0 to {self.last.number}")
        again, now = by_number[number], {test: after for test, (_, after) in self.last.rmse_K.items()}
        rmse = {t: (now.get(t, after), after) for t, (_, after) in again.rmse_K.items()}
        return self._longer(replace(again, action="step back", effect="", rmse_K=rmse, why=f"as in revision {number}"))


def load_history(path: Path) -> History:
    """The history of a case; none when there is no model.toml yet."""
    if not path.exists() and not path.is_symlink():
        return History()
    top = Table(read_toml(path, "a model.toml written by thermoscope"), str(path))
    revisions = tuple(_revision(t) for t in top.listed("revision"))
    lines = path.read_bytes().count(b"\n")
    if top.number("lines", lines) != lines or not revisions:  # the first line says how many: one that is cut off has it
        what = f"has {lines} lines, not as many as were written: it was cut off or changed by hand"
        raise top.error(what, "the file as thermoscope wrote it, or none: the model as declared")
    top.close()
    if [r.number for r in revisions] != list(range(1, len(revisions) + 1)):
        raise top.error("revisions are not numbered 1, 2, 3, ...", "the file as thermoscope wrote it")
    return History(revisions)


def save_history(path: Path, history: History, before: History) -> History:
    """Write `history` over `before`, and return it as the file has it.

    Raises InputError when the file holds something else by now: another command or tab was quicker.
    """
    import tomlkit

    with locked(path.parent):
        standing = load_history(path)
        if standing != before:
            what = f"the model was changed by another tab or command: it is at revision {standing.last.number}, this "
            what += f"step began at {before.last.number}"
            raise InputError(what, str(path), "the step again (in the workbench 'take over' first)")
        document, revisions = tomlkit.document(), tomlkit.aot()
        document.add("lines", 0)
        document.add(tomlkit.comment(HEADER))
        for revision in history.revisions:
            revisions.append(tomlkit.item(revision.document()))
        document.add("revision", revisions)
        document["lines"] = tomlkit.dumps(document).count("\n")
        write_whole(path, tomlkit.dumps(document))
        return load_history(path)


def checked_values(revision: Revision, parameters: Iterable[Parameter], where: str) -> None:
    """Every value belongs to a parameter the model has, and lies within that parameter's bounds."""
    have, place = {p.name: p for p in parameters}, where
    again = next((e for i, e in enumerate(revision.effects) if e in revision.effects[:i]), None)
    if again is not None:
        raise InputError(f"effect '{again}' is in the model twice", place, "each effect once")
    for name in revision.intervals:
        if name not in revision.values:
            raise InputError(f"intervals: '{name}' has no value", place, suggestion(name, revision.values))
    for name, value in revision.values.items():
        if measured(name):
            continue  # of a sensor or test that may have gone since; its bounds are those of the tests
        if name not in have:
            raise InputError(f"unknown parameter '{name}'", place, suggestion(name, have))
        low, high = have[name].low, have[name].high
        if not low - ROUNDED * abs(low) <= value <= high + ROUNDED * abs(high):
            right = f"{low:g} to {high:g}; undo the step, or calibrate again"
            raise InputError(f"values {name} = {value:g} is out of its bounds", place, right)


def _revision(table: Table) -> Revision:
    evidence, rmse = _inner(table, "evidence"), _inner(table, "rmse_K")
    tests = {name: _inner(rmse, name) for name in rmse.data}
    out = Revision(
        int(table.number("number")),
        table.word("action", None, ACTIONS),
        table.words("effects", []),
        table.word("effect", ""),
        _inner(table, "values").constants("values"),
        _pairs(_inner(table, "intervals")),
        {name: (t.number("before"), t.number("after")) for name, t in tests.items()},
        table.word("why", ""),
        {k: v if isinstance(v, str) else evidence.number(k, of="value") for k, v in evidence.data.items()},
        _answers(_inner(table, "answers")),
        _reference(_inner(table, "reference")),
    )
    table.close()
    return out


def _reference_document(of: Reference) -> dict[str, Any]:
    """As model.toml holds it: what is not known is left out."""
    signals = {
        name: {k: v for k, v in vars(one).items() if v is not None and v is not False and v != ""}
        for name, one in of.signals.items()
    }
    errors = {n: {"rmse_K": float(f"{error:.4g}"), "role": role} for n, (error, role) in of.errors.items()}
    start = {} if of.start_C is None else {"start_C": of.start_C}
    tables = {"sizes": dict(of.sizes), "signals": signals, "errors": errors}
    return {"tests": list(of.tests), **start, **{key: table for key, table in tables.items() if table}}


def _reference(table: Table) -> Reference | None:
    if not table.data:
        return None
    signals, errors, sizes = (_inner(table, key) for key in ("signals", "errors", "sizes"))
    out = Reference(
        {name: _signal(_inner(signals, name)) for name in signals.data},
        sizes.constants("sizes"),
        table.words("tests", []),
        {name: _error(_inner(errors, name)) for name in errors.data},
        _optional(table, "start_C"),
    )
    table.close()
    return out


def _signal(table: Table) -> SignalReference:
    level, low, high = (table.number(key) for key in ("level", "low", "high"))
    at_load, quantity = _optional(table, "at_load"), table.word("quantity", "")
    out = SignalReference(level, low, high, at_load, quantity, table.flag("machine", False))
    table.close()
    return out


def _optional(table: Table, key: str) -> float | None:
    return table.number(key) if key in table.data else None


def _error(table: Table) -> tuple[float, str]:
    out = table.number("rmse_K"), table.word("role")
    table.close()
    return out


def _inner(table: Table, key: str) -> Table:
    return Table(table.raw(key, {}), f"{table.where} {key}")


def _answers(table: Table) -> dict[str, bool | float]:
    """yes or no; of a boundary or a sensor a number (K)."""
    numbers = {k for k, v in table.data.items() if isinstance(v, int | float) and not isinstance(v, bool)}
    return {k: table.number(k, of="answers") if k in numbers else table.flag(k) for k in table.data}


def _pairs(table: Table) -> dict[str, Pair]:
    out = {}
    for name in table.data:
        pair = table.numbers(name, of="intervals")
        if len(pair) != 2 or pair[0] > pair[1]:
            raise table.error(f"{name} = {list(pair)} is not an interval", "[low, high]")
        out[name] = (pair[0], pair[1])
    return out
