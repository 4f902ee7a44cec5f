"""The true machine: a dozen cells with formulas of their own, its instruments, and an operator who may not obey."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from simulated.bench.kinds import KINDS, Kind

STEP, PERIOD = 1.0, 5.0  # s, of the integration and of the logger
CELLS = ("slot", "end.de", "end.nde", "teeth", "yoke", "shell.de", "shell", "shell.nde", "cage", "hub", "flange")
PARTS = {"winding": (0, 1, 2), "core": (3, 4), "housing": (5, 6, 7), "rotor": (8, 9), "flange": (10,)}
SIGMA = 5.67e-8


@dataclass
class Truth:
    """What is true of a plant and nobody on the bench knows.  size : in the words of the law that `hidden` names"""

    kind: str
    seed: int
    hidden: str
    size: float
    dies: str
    dies_s: float
    lazy: bool
    clock: float
    factors: dict[str, float]

    def document(self) -> dict[str, Any]:
        return dict(vars(self))


def drawn(kind: str, seed: int, hidden: str | None = None) -> Truth:
    """A plant's truth; half of the operators obey late and not quite, a third of the plants loses a sensor."""
    rng = np.random.default_rng([seed, 11])
    k = KINDS[kind]
    names = ("C", "liner", "fit", "gap", "still", "stream", "copper", "iron", "friction", "bed", "seat", "power")
    sd = dict.fromkeys(names, 0.12) | {"C": 0.05, "copper": 0.03, "gap": 0.15, "friction": 0.2, "bed": 0.2, "seat": 0.2}
    factors = {n: float(np.exp(sd[n] * np.clip(rng.standard_normal(), -2, 2))) for n in names}
    what = str(rng.choice(k.hidden)) if hidden is None else hidden
    size = float(rng.uniform(0.6, 1.0))
    dies = str(rng.choice(k.sensors[1:])) if rng.random() < 1 / 3 else ""
    return Truth(
        kind, seed, what, size, dies, float(rng.uniform(300, 2400)), bool(rng.random() < 0.5),
        float(1 + 1e-3 * rng.uniform(-1, 1)), factors,
    )  # fmt: skip


class Plant:
    """A machine that runs: `apply` takes set points, `row` goes on to the next row of the logger."""

    def __init__(self, truth: Truth) -> None:
        self.truth, self.kind, self.time = truth, KINDS[truth.kind], 0.0
        self.rng = np.random.default_rng([truth.seed, 12])
        self.ambient = float(self.rng.uniform(18, 26))
        self.T = self.ambient + self.rng.normal(0.0, 0.3, len(CELLS))
        self.true = {"current_A": 0.0, "speed_rpm": 0.0}
        if self.kind.cooled[0].endswith("share"):
            self.true[self.kind.cooled[0]] = 1.0
        self.pending: list[tuple[float, dict[str, float]]] = []
        self.lag = {s: float(self.rng.uniform(5, 20)) for s in self.kind.sensors}
        self.bias = {s: float(self.rng.normal(0.0, 0.25)) for s in self.kind.sensors}
        self.read = {s: self._part(s) for s in self.kind.sensors}
        self.frozen: dict[str, float] = {}
        self.gap_s = float(self.rng.uniform(200, 1500))
        self.hottest: dict[str, float] = {}
        self._build(self.kind, truth)

    def _build(self, k: Kind, t: Truth) -> None:
        f, C = t.factors, k.C
        half = C["housing"] * 0.97 / 3
        self.C = f["C"] * np.array([
            0.5 * C["winding"], 0.25 * C["winding"], 0.25 * C["winding"], 0.4 * C["core"], 0.6 * C["core"], half, half,
            half, 0.7 * C["rotor"], 0.3 * C["rotor"], 0.3 * C["housing"],
        ])  # fmt: skip
        fit = k.fit * f["fit"] * (1.0 - 0.75 * t.size * (t.hidden == "contact@fit"))
        bridge = 1.5 * t.size * k.liner * (t.hidden == "coupling@winding|housing")
        edges = [
            (0, 1, 1.5 * k.liner), (0, 2, 1.5 * k.liner), (0, 3, 1.25 * k.liner * f["liner"]), (3, 4, 6 * k.fit),
            (4, 6, 0.6 * 1.1 * fit), (4, 5, 0.2 * 1.1 * fit), (4, 7, 0.2 * 1.1 * fit), (5, 6, 3 * k.fit),
            (6, 7, 3 * k.fit), (8, 9, 10 * k.gap), (1, 5, 0.5 * bridge + 1e-3), (2, 7, 0.5 * bridge + 1e-3),
        ]  # fmt: skip
        edges += [(9, 10, k.seat * f["seat"]), (10, 5, 9 * k.seat)] if k.seat else [(10, 5, 2 * k.fit)]
        self.i, self.j, self.G = (np.array(x) for x in zip(*edges, strict=True))

    def _part(self, name: str) -> float:
        return float(np.mean(self.T[list(PARTS[name])]))

    def apply(self, set_points: Mapping[str, float]) -> None:
        """What the bench asks for; a lazy operator comes late, one time in twelve not at all for some minutes."""
        delay = 0.0
        if self.truth.lazy:
            delay = float(self.rng.uniform(10, 60) + (self.rng.random() < 1 / 12) * 100)
        self.pending.append((self.time + delay, dict(set_points)))

    def _heat(self) -> np.ndarray:
        k, t, f, T, Ta = self.kind, self.truth, self.truth.factors, self.T, self.ambient
        n, amps = self.true["speed_rpm"] / k.rpm, self.true["current_A"] / k.amperes
        drop = (1.0 + 4e-4 * (0.5 * (T[self.i] + T[self.j]) - 40.0)) * self.G * (T[self.i] - T[self.j])
        q = np.bincount(self.j, drop, len(T)) - np.bincount(self.i, drop, len(T))
        gap = k.gap * (f["gap"] * (1.0 + 0.05 * n) + 4.0 * t.size * (t.hidden == "gap.convection@core|rotor") * n**0.75)
        across = gap * (T[8] - T[3])
        q[8] -= across
        q[3] += across
        copper = 1.5 * k.R * f["copper"] * self.true["current_A"] ** 2
        q[:3] += copper * np.array([0.46, 0.28, 0.26]) * (1.0 + 0.0039 * (T[:3] - 20.0))
        base = 1.5 * k.R * k.amperes**2
        q[:3] += (
            0.8 * t.size * base * (t.hidden == "copper.ac@winding") * amps**2 * n**1.85 * np.array([0.5, 0.25, 0.25])
        )
        iron = k.iron * f["iron"] * (0.45 * n + 0.4 * n**2 + 0.15 * n**1.5) * (1.0 - 5e-4 * (T[3] - 40.0))
        q[3:5] += iron * np.array([0.5, 0.5])
        rub = k.friction * f["friction"] * n**1.1 * (1.15 - 4e-3 * (T[10 if k.seat else 9] - 20.0))
        q[10 if k.seat else 9] += rub
        rotor = k.gap * 45.0 * t.size  # W: some ten kelvin across the gap
        q[8] += rotor * (
            (t.hidden == "windage@rotor") * n**2.8 + (t.hidden == "loss.rotor.load@rotor") * amps**2 * n**1.7
        )
        shell, clean = T[5:8], 1.0 - 0.75 * t.size * (t.hidden == "blockage@housing")
        rise = shell - Ta
        still = 1.35 * f["still"] * np.abs(rise / 0.2) ** 0.25
        glow = 0.78 * SIGMA * ((shell + 273.15) ** 4 - (Ta + 273.15) ** 4)
        draught = t.size * max(20.0, 0.5 * k.cooled[1] / k.area) * (t.hidden == "convection.constant@housing")
        q[5:8] -= k.area / 3 * (clean * (still * rise + glow) + draught * rise)
        if k.cooled[0]:
            top = k.rpm if k.cooled[0] == "speed_rpm" else 1.0
            share = max(self.true[k.cooled[0]] / top, 0.0) ** (k.cooled[2] * (1.0 + 0.3 * (f["power"] - 1.0)))
            stream = clean * k.cooled[1] * f["stream"] * share * np.array([0.27, 0.33, 0.40])
            q[5:8] -= stream * (shell - (20.0 if k.cooled[0] == "pump_share" else Ta))
        q[5] -= k.bed * f["bed"] * (T[5] - Ta)
        return np.asarray(q)

    def row(self) -> dict[str, float] | None:
        """The next row; None where it is lost."""
        for _ in range(round(PERIOD / STEP)):
            self.time += STEP
            for _, wanted in [p for p in self.pending if p[0] <= self.time]:
                off = 1.0 + 0.03 * self.rng.uniform(-1, 0) * self.truth.lazy
                self.true |= {name: off * v for name, v in wanted.items() if name in self.true}
            self.pending = [p for p in self.pending if p[0] > self.time]
            self.ambient += self.rng.normal(0.0, 0.004)
            for _ in range(2):
                self.T = self.T + 0.5 * STEP * self._heat() / self.C
            for s, lag in self.lag.items():
                self.read[s] += (self._part(s) - self.read[s]) * (1.0 - math.exp(-STEP / lag))
            for part, cells in PARTS.items():
                self.hottest[part] = max(self.hottest.get(part, -300.0), float(self.T[list(cells)].max()))
        t, k, noise = self.truth, self.kind, self.rng.normal(0.0, 1.0, 20)
        lost = self.rng.random() < 0.02 or self.gap_s <= self.time < self.gap_s + 40.0
        out = {"time_s": round(self.time * t.clock + 3.0, 2)}
        out |= {n: round(v * (1 + 0.003 * noise[i]), 4) for i, (n, v) in enumerate(self.true.items())}
        out["T_ambient"] = round(self.ambient + 0.05 * noise[4], 2)
        out |= {"T_coolant": round(20.0 + 0.05 * noise[5], 2)} if k.cooled[0] == "pump_share" else {}
        out |= {"T_plate": round(self.ambient + 0.05 * noise[6], 2)} if k.bed else {}
        for i, s in enumerate(k.sensors):
            read = round(self.read[s] + self.bias[s] + 0.1 * noise[8 + i], 1)
            dead = s == t.dies and self.time >= t.dies_s
            out[f"T_{s}"] = self.frozen.setdefault(s, read) if dead else read
        return None if lost else out
