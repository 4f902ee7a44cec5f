"""The observer in C99: the network's code with missing heat as an input, the filter (runtime/), and its numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from extras.monitor.observer import hypotheses as tests_of
from extras.monitor.observer.hypotheses import hypotheses
from extras.monitor.observer.kalman import ProcessNoise
from extras.monitor.observer.observer import CORRELATION_S
from extras.monitor.observer.process import LONGEST_S, Process
from thermoscope import InputError, MissingDependency, Network, plugin as th

MOST_BYTES = 10_000  # of what has to live from step to step on a controller
FILES = ("thermal_observer.h", "thermal_observer.c")
HERE = Path(__file__).resolve().parent / "runtime"
REAL, SINGLE = 8, 4  # bytes


def code_writer() -> Any:
    """What writes a network in C, of the extra `export`. Raises MissingDependency where it is not installed."""
    if "c" not in th.plugins("code"):
        raise MissingDependency("an observer in C needs the extra 'export': pip install 'thermoscope[export]'")
    return th.plugins("code")["c"]


@dataclass(frozen=True)
class ObserverModel:
    """model : the network with the missing heat of every body as an input;  given : the inputs that a user sets

    rise_K : usual rise of the tests;  bias (s,) K that the sensors read too much
    """

    model: Any  # of the writer
    process: Process
    noise: ProcessNoise
    rise_K: float
    sensors: tuple[th.Channel, ...]
    heats: tuple[str, ...]
    bias: th.Array

    @property
    def input_names(self) -> tuple[str, ...]:
        return tuple(s.name for s in self.model.signals if s.name not in self.heats)

    @property
    def bytes(self) -> int:
        """Of thermal_observer, as a C compiler lays it out, but for a few bytes between its parts."""
        n, m, s = self.process.size, len(self.process.bodies), len(self.sensors)
        doubles = len(self.model.states) + len(self.model.signals) + 2 + s + 1
        singles = n * n + n * (s + m) + 2 * (s + m) + 3 * (m + 1) + s + 1 + (s + 1) * (s + 7)
        return REAL * doubles + SINGLE * singles


def observer_model(
    process: Process,
    noise: ProcessNoise,
    rise_K: float,
    sensors: Sequence[th.Channel],
    reference: th.Reference,
    looks: Sequence[Any],
    bias: th.Array | None = None,
) -> ObserverModel:
    """Raises InputError where it would not fit on a controller."""
    writer = code_writer()
    network, names = with_missing_heat(process.network, process.bodies)
    model = writer.packed(network, process.values, reference, looks)
    off = np.zeros(len(sensors)) if bias is None else bias
    result = ObserverModel(model, process, noise, rise_K, tuple(sensors), names, off)
    if result.bytes > MOST_BYTES:
        what = (
            f"an observer of {process.size} temperatures and heats with {len(sensors)} sensors has {result.bytes} bytes"
        )
        raise InputError(what, "--as observer", f"at most {MOST_BYTES}: fewer sensors (--sensor), or a smaller network")
    return result


def with_missing_heat(network: Network, bodies: Sequence[str]) -> tuple[Network, tuple[str, ...]]:
    """The network with an input (W) for the missing heat of every body."""
    names = tuple(f"missing heat {body}" for body in bodies)
    laws = [th.MeasuredLoss(((1.0, (name,)),)) for name in names]
    sources = [th.heat_source(network, n, "missing", b, law) for n, b, law in zip(names, bodies, laws, strict=True)]
    return network.extended(sources=sources), names


def observer_files(of: ObserverModel) -> dict[str, str]:
    """File name -> text: everything that has to be compiled (thermal_observer.c takes thermal_network.c in)."""
    writer = code_writer()
    fixed = {name: (HERE / name).read_text(encoding="utf-8") for name in FILES}
    return {
        **writer.c_files(of.model),
        **fixed,
        "thermal_observer_sizes.h": _sizes(of),
        "thermal_observer_data.h": _data(of),
    }


def _sizes(of: ObserverModel) -> str:
    counts = {
        "SLOW": of.process.slow.size,
        "BODIES": len(of.process.bodies),
        "SENSORS": len(of.sensors),
        "GIVEN": len(of.input_names),
    }
    comments = [
        f"Observer of '{of.model.name}': {of.bytes} bytes from step to step; single precision but for temperatures.",
        f"Inputs u, in this order: {', '.join(of.input_names)}.",
        f"Sensors y (degC, NAN where nothing was read), in this order: {', '.join(c.name for c in of.sensors)}.",
        f"Missing heat q (W), in this order: {', '.join(of.process.bodies)}.",
    ]
    lines = [f"#define THERMAL_{name} {n}" for name, n in counts.items()]
    macro = "THERMAL_OBSERVER_SIZES_H"
    return "\n".join([th.c_comment(comments), f"#ifndef {macro}", f"#define {macro}", *lines, "#endif", ""])


def _data(of: ObserverModel) -> str:
    writer = code_writer()
    ints, reals, chained = writer.ints, writer.reals, writer.joined
    signals = [s.name for s in of.model.signals]
    network, rows = of.process.network, [c.row for c in of.sensors]
    sigma = np.array([c.sigma_K for c in of.sensors])
    names = tuple(c.name for c in of.sensors)
    odds = hypotheses(names, sigma, np.hypot(sigma, th.USUAL_DOUBT["gain"] * of.rise_K), of.process.bodies, of.noise.sd)
    numbers: Mapping[str, float] = {
        "NOISE_S": of.noise.time_s,
        "LONGEST_S": LONGEST_S,
        "HELD_FOR_S": CORRELATION_S,
        "START_K": th.USUAL_DOUBT["start"],
        "COLDEST_C": th.COLDEST,
        "HOTTEST_C": th.HOTTEST,
        "OUTLIER_SD": tests_of.OUTLIER,
        "LOST_AFTER_S": tests_of.LOST_S,
        "BACK_AFTER_S": tests_of.BACK_S,
        "FROZEN_AFTER_S": tests_of.FROZEN_S,
        "LONGER_RUN": tests_of.LONGER,
        "MOVED_SD": tests_of.MOTION,
        "FORGETS_AFTER_S": tests_of.FORGETS_S,
        "SURE_FROM": tests_of.SURE,
        "DOUBT_SD": tests_of.TOLERANCE,
        "TEMPER_BY": th.TEMPER["temper"].share,
        "TEMPER_PER_NAT": th.TEMPER["temper per nat"].share,
    }
    m = len(of.process.bodies)
    root = "},\n{".join(", ".join(f"{v:.17g}" for v in row) for row in of.noise.root)
    return "\n".join(
        [
            "/* The numbers of the observer; see thermal_observer_sizes.h. */",
            *(f"#define {name} {value:.17g}" for name, value in numbers.items()),
            ints("SLOW", of.process.slow),
            ints("BODY_STATE", [network.column(b) for b in of.process.bodies]),
            ints("HEAT_SIGNAL", [signals.index(n) for n in of.heats]),
            ints("GIVEN_SIGNAL", [signals.index(n) for n in of.input_names]),
            f"static const double NOISE_ROOT[][{max(m, 1)}] = {{{{{root or '0'}}}}};",
            ints("SENSOR_START", np.concatenate([[0], np.cumsum([r.index.size for r in rows])])),
            ints("SENSOR_AT", chained(r.index for r in rows)),
            reals("SENSOR_WEIGHT", chained(r.weights for r in rows)),
            ints("SENSOR_STATE", [of.process.state(c) for c in of.sensors]),
            reals("SENSOR_SD", sigma),
            reals("SENSOR_BIAS", of.bias),
            reals("LAG_S", [c.lag_s for c in of.sensors]),
            reals("TABLE_SD", of.noise.sd),
            reals("ALLOWED_SD", odds.tolerance),
            reals("SPREAD_SD", odds.spread),
            reals("LOG_PRIOR", odds.prior),
            "",
        ]
    )
