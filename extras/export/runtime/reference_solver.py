"""Reference solver of an exported thermal network: NumPy and SciPy. See `model["about"]` for inputs and outputs."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import RegularGridInterpolator


def function(f, u):
    x, kind = u[f["input"]], f["kind"]
    if kind == "power":
        return abs(x / f["at"]) ** f["exponent"]
    if kind in ("straight", "positive"):
        return f["offset"] + f["slope"] * x if kind == "straight" else float(f["way"] * x > 0)
    if kind == "table":
        return np.interp(abs(x) if f["size"] else x, f["x"], f["y"])
    at, grids = np.array([x, u[f["other"]]]), (np.array(f["x1"]), np.array(f["x2"]))
    inside = np.clip(abs(at) if f["size"] else at, [g.min() for g in grids], [g.max() for g in grids])
    return RegularGridInterpolator(grids, np.array(f["y"]))(inside)[0]


def film(g, hot, cold):
    return np.interp((hot + cold) / 2, g["films"], [np.interp(abs(hot - cold), g["x"], y) for y in g["y"]])


def stream(g, hot, cold, u):
    u, x, y = max(abs(u), 1e-9), np.array(g["x"]), np.array(g["y"])
    T = np.clip(hot + cold, g["total"][0], g["total"][-1])
    at = max(np.log(u) - np.interp(T, g["total"], g["shift"]), x[0])
    k = min(np.searchsorted(x, at, "right") - 1, x.size - 2)
    each = y[:, k] + (y[:, k + 1] - y[:, k]) * (at - x[k]) / (x[k + 1] - x[k])
    h = np.interp(T, g["total"], each)
    if "still" in g:
        still, n = film(g["still"], hot, cold), g["exponent"]
        return (h**n + still**n) ** (1 / n) - still
    return max(h, np.expm1(min(h * g["b"] / u, 5.0)) * u / g["b"]) if g["b"] > 0 else h


def law(g, hot, cold, u):
    h, c, d = hot + 273.15, cold + 273.15, abs(hot - cold)
    if g["kind"] == "film table":
        return film(g, hot, cold)
    if g["kind"] == "stream table":
        return stream(g, hot, cold, u[g["input"]] if g["input"] else g["size"])
    laws = {
        "constant": lambda: 1.0,
        "power": lambda: (d * d + 1e-4) ** (g["a"] / 2),
        "linear": lambda: 1 + g["a"] * (hot - g["b"]),
        "inverse": lambda: 1 / (1 + g["a"] * (hot - g["b"])),
        "table": lambda: np.interp(hot - cold if g["x"][0] < 0 else d, g["x"], g["y"]),
        "radiation": lambda: 5.670374419e-8 * (h * h + c * c) * (h + c),
    }
    return laws[g["kind"]]()


def flow(model, x, u):
    z = np.concatenate([x, [u[b["name"]] for b in model["boundaries"]], [1.0]])
    F = -np.array(model["K0"]) @ z
    for t in model["terms"]:
        hot, cold = (float(np.dot(t[s]["val"], z[np.array(t[s]["col"], int)])) for s in ("hot", "cold"))
        share = sum(p["coefficient"] * np.prod([function(f, u) for f in p["functions"]]) for p in t["factor"])
        np.subtract.at(F, t["row"], law(t["law"], hot, cold, u) * share * np.array(t["val"]) * z[t["col"]])
    return F


def solve(model, time, signals, x0):
    """Outputs (n_time, n_output) degC; signals: name -> (n_time,); x0 (n_state,); every state needs a capacity."""

    def slope(t, x):
        return flow(model, x, {n: np.interp(t, time, u) for n, u in signals.items()}) / model["C"]

    most = {"max_step": np.diff(time).max(), "rtol": 1e-6, "atol": 1e-4}
    z = solve_ivp(slope, (time[0], time[-1]), x0, "BDF", time, **most).y
    z = np.vstack([z, *(signals[b["name"]] for b in model["boundaries"])])
    return np.array([np.dot(o["val"], z[o["col"]]) for o in model["outputs"]]).T
