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
    x = abs(x) if f["size"] else x
    if kind == "table":
        return np.interp(x, f["x"], f["y"])
    at = np.clip(
        [x, abs(u[f["other"]]) if f["size"] else u[f["other"]]],
        *np.transpose([(min(g), max(g)) for g in (f["x1"], f["x2"])]),
    )
    return RegularGridInterpolator((f["x1"], f["x2"]), np.array(f["y"]))(at)[0]


def law(g, hot, cold):
    h, c, d = hot + 273.15, cold + 273.15, abs(hot - cold)
    if g["kind"] == "film table":
        return np.interp((hot + cold) / 2, g["films"], [np.interp(d, g["x"], y) for y in g["y"]])
    return {
        "constant": lambda: 1.0,
        "power": lambda: (d * d + 1e-4) ** (g["a"] / 2),
        "linear": lambda: 1 + g["a"] * (hot - g["b"]),
        "radiation": lambda: 5.670374419e-8 * (h * h + c * c) * (h + c),
        "table": lambda: np.interp(hot - cold if g["x"][0] < 0 else d, g["x"], g["y"]),
    }[g["kind"]]()


def flow(model, x, u):
    z = np.concatenate([x, [u[b["name"]] for b in model["boundaries"]], [1.0]])
    F = -np.array(model["K0"]) @ z
    for t in model["terms"]:
        hot, cold = (float(np.dot(t[s]["val"], z[np.array(t[s]["col"], int)])) for s in ("hot", "cold"))
        c = law(t["law"], hot, cold) * sum(
            p["coefficient"] * np.prod([function(f, u) for f in p["functions"]]) for p in t["factor"]
        )
        np.subtract.at(F, t["row"], c * np.array(t["val"]) * z[t["col"]])
    return F


def solve(model, time, signals, x0):
    """Outputs (n_time, n_output) degC; signals: name -> (n_time,); x0 (n_state,); every state needs a capacity."""

    def at(t):
        return {name: np.interp(t, time, values) for name, values in signals.items()}

    run = solve_ivp(
        lambda t, x: flow(model, x, at(t)) / model["C"],
        (time[0], time[-1]),
        x0,
        "BDF",
        time,
        rtol=1e-6,
        atol=1e-4,
        max_step=np.diff(time).max(),
    )
    z = np.vstack([run.y, *(signals[b["name"]] for b in model["boundaries"])])
    return np.array([np.dot(o["val"], z[o["col"]]) for o in model["outputs"]]).T
