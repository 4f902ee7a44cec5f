"""Which base a machine stood on: every base of the network held against every test, all tests calibrated together.

A wrong base must not be made good by the films: for each test and each base the whole model is fitted anew to all
tests, within the same priors. Tests on other bases hold the body's films, so what a wrong base costs is in the
deviance: misfit of the readings and strain of the priors.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geom.errors import InputError
from geom.table import select_fields
from lumped.machine.bases import Switched
from lumped.model.network import Network
from measured.case import Case, Test
from validation.bases.base_heat import BaseHeat, base_heat
from validation.calibration.calibrate import Fit, calibrated, no_progress
from validation.parameters.unknowns import working

NONE = "none"
DECISIVE = 10.0  # of deviance, as in the race of effects: odds of 150 to 1
Progress = Callable[[str], None]


@dataclass(frozen=True)
class BaseDeviance:
    """A base for one test.  deviance : over the best base of this test;  declared : the sheet says so

    heat : what this base carries off at the test's end, by mechanism
    """

    test: str
    base: str
    declared: bool
    deviance: float
    heat: BaseHeat

    @property
    def excluded(self) -> bool:
        return self.deviance > DECISIVE

    def document(self) -> dict[str, Any]:
        row = select_fields(self, "test", "base", "declared", "deviance", "excluded")
        return {**row, "heat_W": self.heat.document()}


def switches(network: Network) -> dict[str, str]:
    """Base -> the input that couples it."""
    laws = [link.law for link in network.links]
    names = {law.switch: None for law in laws if isinstance(law, Switched) and law.closed}
    return {name.removeprefix("on_"): name for name in names}


def declared_base(test: Test, bases: Mapping[str, str]) -> str:
    """The base that the test's inputs say."""
    return next((base for base, name in bases.items() if float(np.mean(test.inputs[name])) > 0.5), NONE)


def on_base(test: Test, base: str, bases: Mapping[str, str]) -> Test:
    """The test as if on another base."""
    inputs = {name: np.full(test.time.size, float(one == base)) for one, name in bases.items()}
    return replace(test, inputs={**test.inputs, **inputs})


def which_base(case: Case, names: Sequence[str] = (), progress: Progress = no_progress) -> list[BaseDeviance]:
    """Every base for every test (or those named) that is not held out, best first within a test."""
    bases, tests = switches(case.model.network), [t for t in case.tests if t.role != "hold-out"]
    if not bases:
        right = "a machine file with [bases], see docs/how-to/thermal-test.md"
        raise InputError("the network knows no bases", case.name, right)
    if unknown := [n for n in names if n not in [t.name for t in tests]]:
        choices = ", ".join(t.name for t in tests)
        raise InputError(f"no test '{unknown[0]}'", case.name, f"tests that are not held out: {choices}")
    declared_fit = _fitted(case, tests, None)
    subjects = [t for t in tests if not names or t.name in names]
    return [h for test in subjects for h in _of_test(case, tests, test, bases, declared_fit, progress)]


def _of_test(
    case: Case, tests: Sequence[Test], test: Test, bases: Mapping[str, str], declared_fit: Fit, progress: Progress
) -> list[BaseDeviance]:
    sheet_base, fits = declared_base(test, bases), {}
    for base in (NONE, *bases):
        progress(f"trying {test.name} on {base}")
        variant = [on_base(t, base, bases) if t is test else t for t in tests]
        fits[base] = declared_fit if base == sheet_base else _fitted(case, variant, declared_fit)
    cost = {base: deviance(fit) for base, fit in fits.items()}
    least = min(cost.values())
    rows = [
        BaseDeviance(
            test.name,
            base,
            base == sheet_base,
            cost[base] - least,
            base_heat(fit.network, on_base(test, base, bases), fit.values),
        )
        for base, fit in fits.items()
    ]
    return sorted(rows, key=lambda h: h.deviance)


def _fitted(case: Case, tests: Sequence[Test], start: Fit | None) -> Fit:
    """All tests fitted under the sensors' own uncertainty, so that no misfit passes for noise."""
    network, unknowns = working(case)
    values = case.model.values if start is None else start.values
    return calibrated(network, tests, unknowns, values, 0, noise=None if start is None else start.noise)


def deviance(fit: Fit) -> float:
    """Misfit of the readings and strain of the priors: twice the objective."""
    return 2.0 * fit.objective


def base_hypotheses(case: Case, progress: Progress = no_progress) -> list[BaseDeviance]:
    """Every base for every test; none where the network has no bases."""
    return which_base(case, progress=progress) if switches(case.model.network) else []


def wrong_bases(hypotheses: Sequence[BaseDeviance]) -> list[str]:
    """In words, every test whose readings exclude the base that its sheet says."""
    return [_words(h, hypotheses) for h in hypotheses if h.declared and h.excluded]


def _words(sheet: BaseDeviance, hypotheses: Sequence[BaseDeviance]) -> str:
    possible = [h for h in hypotheses if h.test == sheet.test and not h.excluded]
    better = " or ".join(h.base for h in possible)
    return (
        f"{sheet.test} did not stand on the base its sheet says ({sheet.base}, deviance {sheet.deviance:.0f}) "
        f"but on: {better}. At the base, not in the films of the machine: {sheet.heat.against(possible[0].heat)}"
    )
