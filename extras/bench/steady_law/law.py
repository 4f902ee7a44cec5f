"""One law from a table of steady tests: its numbers with intervals, words, and what it predicts with a band."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from extras.bench.steady_law.forms import Label, conductances, edge, temperature
from extras.bench.steady_law.search import MOST, Fit, searched
from extras.bench.steady_law.steady_tests import STEP_K, SteadyTests, steady_tests
from thermoscope import plugin as th

SURE = 0.95  # probability from which an input is in the law
LEAST_LEVELS = 3  # of an input whose highest may be left out: two others tell its exponent
FINEST_K = 1e-3  # no sensor agrees better with any law


@dataclass(frozen=True)
class Prediction:
    """mean, half : (n,) degC of the sensors' mean and half its 95 % band;  readings, halves : (n, c), of each sensor"""

    mean: th.Array
    half: th.Array
    readings: th.Array
    halves: th.Array

    def agreement(self, tests: SteadyTests) -> dict[str, Any]:
        """Rms (K) of all readings and of the worst sensor, and the share of readings in their band."""
        off = self.readings - tests.readings
        each = np.sqrt(np.mean(off**2, axis=0))
        worst = {"worst_K": float(each.max()), "worst": tests.names[int(each.argmax())]}
        inside = float(np.mean(np.abs(off) <= self.halves))
        return {"tests": len(off), "rms_K": float(np.sqrt(np.mean(off**2))), **worst, "inside": inside}


@dataclass(frozen=True)
class SteadyLaw:
    """fits : forms that the readings do not exclude;  best : the first of those that has no more than seven numbers

    shares : (s, c) of each sensor above the mean, of its rise over the coolant, and over ambient where there are two
    sensor_K : (c,) sd of a sensor about that at the usual rise;  spread : (s, s) covariance of shares / sensor_K
    """

    tests: SteadyTests
    fits: Sequence[Fit]
    best: Fit
    shares: th.Array
    sensor_K: th.Array
    spread: th.Array

    @cached_property
    def weights(self) -> th.Array:
        """Probabilities of the forms."""
        size = np.exp([f.log_evidence - self.fits[0].log_evidence for f in self.fits])
        return np.asarray(size / size.sum())

    @cached_property
    def follows(self) -> dict[str, float]:
        """Input -> probability that the cooling follows it."""
        there = np.array([[i in f.form.inputs for f in self.fits] for i in range(len(self.tests.columns.inputs))])
        names = (name for name, _ in self.tests.columns.inputs)
        return dict(zip(names, (there @ self.weights).tolist(), strict=True))

    @property
    def verdict(self) -> str:
        """'law', or 'no law' where no input is surely in it."""
        return "law" if max(self.follows.values()) >= SURE else "no law"

    @property
    def factor(self) -> float:
        """Half a 95 % interval in standard deviations."""
        from scipy.stats import t as student

        return float(student.ppf(0.975, max(len(self.tests.heat) - self.best.x.size, 1)))

    def predict(self, tests: SteadyTests) -> Prediction:
        """Temperatures at other inputs by the law; the band also has what the other forms say."""
        mean = temperature(self.best.form, self.best.x, tests)[0]
        variance, scatter = np.zeros(mean.size), tests.scatter(mean)
        for weight, f in zip(self.weights, self.fits, strict=True):
            T, J = temperature(f.form, f.x, tests)
            one = np.einsum("np,pq,nq->n", J, f.covariance, J) + (f.sigma_K * scatter) ** 2
            variance += weight * (one + (T - mean) ** 2)
        B = _rises(mean, tests)[:, : len(self.shares)]
        sensors = (np.einsum("ns,st,nt->n", B, self.spread, B) + scatter**2)[:, None] * self.sensor_K**2
        halves = self.factor * np.sqrt(variance[:, None] * (1.0 + self.shares.sum(axis=0)) ** 2 + sensors)
        return Prediction(mean, self.factor * np.sqrt(variance), mean[:, None] + B @ self.shares, halves)

    def curve(self, inputs: th.Array, inlet: float) -> tuple[th.Array, th.Array]:
        """Conductance to the coolant (W/K) at some inputs and one inlet, and half its 95 % band."""
        T, none = np.full(len(inputs), inlet), np.empty((len(inputs), 0))
        at = steady_tests(self.tests.columns, (), inputs, np.ones(T.size), T, T, none, self.tests.scales)
        G, square = np.exp(conductances(self.best.form, self.best.x, at)[0]), np.zeros(T.size)
        for weight, f in zip(self.weights, self.fits, strict=True):
            log_G, J, _, _ = conductances(f.form, f.x, at)
            square += weight * (np.einsum("np,pq,nq->n", J, f.covariance, J) * G**2 + (np.exp(log_G) - G) ** 2)
        return G, self.factor * np.sqrt(square)

    def to_coolant(self, tests: SteadyTests) -> th.Array:
        """(n,) heat of tests (W), less what goes to ambient by the law."""
        G0 = conductances(self.best.form, self.best.x, tests)[2]
        return np.asarray(tests.heat - G0 * (tests.mean - tests.ambient))

    @cached_property
    def numbers(self) -> dict[Label, dict[str, Any]]:
        """What each number of the law is: its name, value, 95 % interval and unit."""
        half = self.factor * np.sqrt(np.diag(self.best.covariance))
        return {
            label: self._number(label, float(v), float(h))
            for label, v, h in zip(self.best.form.labels, self.best.x, half, strict=True)
        }

    def _number(self, label: Label, v: float, h: float) -> dict[str, Any]:
        form, columns = self.best.form, self.tests.columns
        kind, term, power = (*label, 0, 0)[:3]
        of = f" of G{int(term) + 1}" if len(form.terms) > 1 and (kind != "v" or form.fluid > 1) else ""
        i, how = form.limit or (0, "")
        viscosity = "exponent of 1 / viscosity" if columns.fluid else f"factor per {STEP_K:g} K of coolant"
        name, unit = {
            "G": (f"G{of[-1:]}{self._at(int(term))}", "W/K"),
            "a": (f"exponent of {columns.inputs[int(power)][0]}{of}", "1"),
            "v": (f"{viscosity}{of}", "1"),
            "at": (f"{columns.inputs[i][0]} counts {how}", columns.inputs[i][1]),
            "m": ("m", "1"),
            "G0": ("G0", "W/K"),
        }[str(kind)]

        def value(v: float) -> float:
            if kind == "at":
                return edge(form, v, self.tests)[0] * float(self.tests.scales.highest[i])
            log = v + (self.tests.scales.log_G if unit == "W/K" else 0.0)
            return v if kind == "a" or (kind == "v" and columns.fluid) else float(np.exp(log))

        return {"name": name, "value": value(v), "low": value(v - h), "high": value(v + h), "unit": unit}

    def _at(self, t: int) -> str:
        """at 4 l/min and 10000 rpm"""
        highest, inputs = self.tests.scales.highest, self.tests.columns.inputs
        words = [f"{highest[i]:g} {inputs[i][1] or inputs[i][0]}" for i in self.best.form.terms[t]]
        return f" at {' and '.join(words)}" if words else ""

    @property
    def formula(self) -> str:
        """As one writes it down."""
        form, scales, inputs = self.best.form, self.tests.scales, self.tests.columns.inputs
        value = {label: n["value"] for label, n in self.numbers.items()}
        warmer = f"{{:.4g}}^((T_in - {scales.inlet:.3g})/{STEP_K:g})"
        fluid = f"(nu({scales.inlet:.3g} degC)/nu)^{{:.3g}}" if self.tests.columns.fluid else warmer
        parts = []
        for t, term in enumerate(form.terms):
            text = f"{value['G', t]:.4g}"
            for i in term:
                base = inputs[i][0]
                if form.limit == (i, "up to"):
                    base = f"min({base}, {value['at',]:.4g})"
                elif form.limit == (i, "from"):
                    base = f"max({base} - {value['at',]:.4g}, 0)"
                power = f"^{value['a', t, i]:.3g}" if ("a", t, i) in value else ""
                text += f" ({base}/{scales.highest[i]:g}){power}"
            parts.append(" ".join([text, *([fluid.format(value["v", min(t, form.fluid - 1)])] if form.fluid else [])]))
        m = value.get(("m",))
        G = " + ".join(parts) if m is None else f"({' + '.join(f'[{p}]^{m:.3g}' for p in parts)})^(1/{m:.3g})"
        ambient = f" + {value['G0',]:.3g} (T - T_ambient)" if form.ambient else ""
        return f"heat = G (T - T_in{' - heat/(2 m cp)' if form.warming else ''}){ambient}, G = {G} W/K"

    @property
    def sentence(self) -> str:
        """The law in words."""
        form, inputs = self.best.form, self.tests.columns.inputs
        value = {label: n["value"] for label, n in self.numbers.items()}
        if self.verdict == "no law":
            usual, sigma = np.exp(self.tests.scales.log_G), self.best.sigma_K
            unclear = f"No law: the readings do not say that the cooling follows {' or '.join(self.follows)}"
            return f"{unclear}: about {usual:.3g} W/K, from which tests scatter by {sigma:.2g} K."
        words = []
        for t, term in enumerate(form.terms):
            words.append(f"{value['G', t]:.3g} W/K{self._at(t)}")
            for i in term:
                power = f"with {inputs[i][0]}^{value['a', t, i]:.2f}" if ("a", t, i) in value else ""
                words[-1] += f", {power or f'in proportion to {inputs[i][0]}'}"
        if form.limit:
            at = self.numbers["at",]
            words.append(f"{at['name']} {at['value']:.3g} {at['unit']}")
        if form.blend:
            words.append("the two help each other" if value["m",] < 1.0 else "the larger one counts most")
        if form.warming:
            words.append("at the coolant's mean temperature")
        if form.ambient:
            words.append(f"{value['G0',]:.2g} W/K to ambient")
        words += [f"it does not follow {name}" for name, p in self.follows.items() if p <= 1.0 - SURE]
        words += [f"if it follows {name} is not sure" for name, p in self.follows.items() if 1.0 - SURE < p < SURE]
        return f"A law of {len(self.numbers)} numbers: {'; '.join(words)}."

    @property
    def doubts(self) -> list[str]:
        """What cannot be as the table says."""
        tests = self.tests
        hotter = int((tests.coolant + self.to_coolant(tests) / tests.mcp > tests.mean).sum())
        words = "a coolant of this flow would leave hotter than the mean reading"
        why = "some of the heat goes elsewhere, or the flow is larger"
        return [f"In {hotter} of {len(tests.heat)} tests {words}: {why}."] if hotter else []

    def document(self) -> dict[str, Any]:
        """All of it, for JSON."""
        names = ("verdict", "sentence", "formula", "follows", "doubts")
        fit = {"numbers": list(self.numbers.values()), "sigma_K": self.best.sigma_K, "inlet_C": self.tests.scales.inlet}
        shares = dict(zip(self.tests.names, self.shares.T.tolist(), strict=True))
        agreement = self.predict(self.tests).agreement(self.tests)
        return {**{n: getattr(self, n) for n in names}, **fit, "shares": shares, "agreement": agreement}


def find_law(tests: SteadyTests, tell: Callable[[str], None] = lambda _: None) -> SteadyLaw:
    """The law of at most seven numbers that a table of steady tests speaks for, with all that it cannot exclude."""
    fits, w = searched(tests, tell), tests.scatter(tests.mean)[:, None]
    rises, above = _rises(tests.mean, tests) / w, (tests.readings - tests.mean[:, None]) / w
    choices: list[tuple[float, th.Array, th.Array, th.Array]] = []
    for s in (1, 2) if np.linalg.matrix_rank(rises) > 1 else (1,):
        B = rises[:, :s]
        shares = np.linalg.lstsq(B, above, rcond=None)[0]
        left = np.sum((above - B @ shares) ** 2, axis=0) + FINEST_K**2
        bic = float(np.sum(len(w) * np.log(left) + s * np.log(len(w))))
        spread = np.asarray(np.linalg.inv(B.T @ B), float)
        choices.append((bic, np.asarray(shares, float), np.asarray(np.sqrt(left / (len(w) - s)), float), spread))
    _, shares, sensor_K, spread = min(choices, key=lambda c: c[0])
    return SteadyLaw(tests, fits, next(f for f in fits if f.x.size <= MOST), shares, sensor_K, spread)


def checks(law: SteadyLaw, tell: Callable[[str], None] = lambda _: None) -> list[dict[str, Any]]:
    """The highest level of each input left out in turn: what a law of the rest says of the tests there."""
    tests, out = law.tests, []
    for i, (name, unit) in enumerate(tests.columns.inputs):
        levels = tests.levels(i)
        there = np.flatnonzero(tests.inputs[:, i] == levels[-1])
        if levels.size >= LEAST_LEVELS and len(tests.heat) - there.size > MOST + 1:
            tell(f"predicting {name} {levels[-1]:g}")
            part, rest = find_law(tests.only(np.flatnonzero(tests.inputs[:, i] < levels[-1]))), tests.only(there)
            words = f"{name} {levels[-1]:g} {unit}".strip()
            out.append({"left_out": words, **part.predict(rest).agreement(rest), "law": part.sentence})
    return out


def _rises(T: th.Array, tests: SteadyTests) -> th.Array:
    """(n, 2) K over the coolant, and over ambient."""
    return np.column_stack([T - tests.coolant, T - tests.ambient])
