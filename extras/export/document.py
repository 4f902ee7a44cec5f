"""A model as data: for JSON, and as structs for MAT files."""

import io
from dataclasses import asdict
from typing import Any

import numpy as np

from extras.export.c_code import heading
from extras.export.model import Model, Output
from extras.export.products import Function, Mapped, Positive, Powered, Straight, Sum, Tabulated
from thermoscope import plugin as th

KINDS: dict[type, str] = {
    Powered: "power",
    Straight: "straight",
    Positive: "positive",
    Tabulated: "table",
    Mapped: "map",
}
LAWS = ("constant", "power", "radiation", "linear", "table", "film table", "inverse", "stream table")


def document(model: Model) -> dict[str, Any]:
    """C dx/dt = -K0 z - sum of terms, z = [x; u; 1]; a term takes factor * law * (P z) out of its rows.

    P is given by its triplets row, col, val over the states; hot and cold are weighted sums of z.
    """
    return {
        "about": heading(model),
        "name": model.name,
        "revision": model.revision,
        "effects": list(model.effects),
        "states": list(model.states),
        "inputs": [asdict(s) for s in model.inputs],
        "boundaries": [asdict(s) for s in model.boundaries],
        "initial_degC": model.initial_degC,
        "start_degC": model.start_degC,
        "C": model.C,
        "K0": model.K0,
        "terms": [_term(model, e) for e in range(len(model.factors))],
        "outputs": [_output(o) for o in model.outputs],
    }


def _output(o: Output) -> dict[str, Any]:
    return {
        "name": o.name,
        "col": o.row.index,
        "val": o.row.weights,
        "limit_degC": o.limit,
        "error_K": o.error_K,
        "role": o.role,
    }


def _term(model: Model, e: int) -> dict[str, Any]:
    T = model.terms
    first, end = T.part[e, [th.ROW, th.END]]
    entries = slice(T.begin[first], T.begin[end])
    return {
        "name": model.term_names[e],
        "row": np.repeat(T.row[first:end], np.diff(T.begin[first : end + 1])),
        "col": T.at[entries],
        "val": T.weight[entries],
        "hot": _weighted_sum(T, T.part[e, th.HOT]),
        "cold": _weighted_sum(T, T.part[e, th.COLD]),
        "law": _law(model, e),
        "factor": factor(model.factors[e]),
    }


def _weighted_sum(T: th.Terms, row: int) -> dict[str, Any]:
    some = slice(T.begin[row], T.begin[row + 1])
    return {"col": T.at[some], "val": T.weight[some]}


def _law(model: Model, e: int) -> dict[str, Any]:
    T = model.terms
    code, (a, b) = int(T.kind[e, 0]), T.par[e]
    points = T.point[slice(*T.part[e, [th.POINT, th.LAST]])]
    out = {"kind": LAWS[code], "a": float(a), "b": float(b), "x": points[:, 0], "y": points[:, 1]}
    if code == th.FILM:
        return {**out, **_films(points)}
    return {**out, **_stream(model, e, points)} if code == th.STREAM else out


def _films(points: th.Array) -> dict[str, Any]:
    films = th.FIRST_C + th.STEP_K * np.arange(th.FILMS)
    return {"x": points[: len(points) // th.FILMS, 0], "films": films, "y": points[:, 1].reshape(th.FILMS, -1)}


def _stream(model: Model, e: int, points: th.Array) -> dict[str, Any]:
    """u = |input|, or `size` without one: at ln(u) - shift over hot + cold; b: see StreamTable; or still air."""
    T = model.terms
    of, size = model.sizes[T.part[e, th.PLACE] - len(model.factors)]
    nt, nd = int(T.par[e, 0]), int(max(-T.par[e, 1], 0.0))
    end = len(points) - th.FILMS * nd - (nd > 0)
    grid = points[nt : nt + (end - nt) // (1 + nt), 0]
    y = points[nt + len(grid) : end, 1].reshape(nt, -1)
    still = {"still": _films(points[end:-1]), "exponent": points[-1, 0]} if nd else {}
    total, shift = points[:nt].T
    return {"input": of or "", "size": size, "total": total, "shift": shift, "x": grid, "y": y, **still}


def factor(total: Sum) -> list[dict[str, Any]]:
    """Products of functions of one input, to be summed."""
    return [{"coefficient": p.coefficient, "functions": [_function(f) for f in p.functions]} for p in total]


def _function(f: Function) -> dict[str, Any]:
    out = {"kind": KINDS[type(f)], **asdict(f)}
    return {**out, "y": np.reshape(f.y, (len(f.x1), len(f.x2)))} if isinstance(f, Mapped) else out


def mat(model: Model) -> bytes:
    """The document as a MAT file (level 5), one struct `model`; lists are cells, columns count from 1."""
    from scipy.io import savemat

    out = io.BytesIO()
    savemat(out, {"model": _celled(document(model))}, long_field_names=True, oned_as="column")
    return out.getvalue()


def _celled(value: Any, key: str = "") -> Any:
    if isinstance(value, dict):
        return {k: _celled(v, k) for k, v in value.items()}
    if isinstance(value, list):
        cells = np.empty((len(value), 1), object)
        for i, item in enumerate(value):
            cells[i, 0] = _celled(item)
        return cells
    if isinstance(value, str):
        return th.xml_text(value)  # halves of letters are in no file
    if value is None:
        return np.nan
    if key in ("row", "col"):
        return np.asarray(value, float) + 1.0
    return np.asarray(value, float) if isinstance(value, tuple | np.ndarray | bool) else value
