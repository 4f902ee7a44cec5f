"""The tests an engineer can be asked for, carried out on the true machine. Made from a driven test's inputs."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from hidden.truth.archetype import Plan
from hidden.truth.body import Array

Inputs = dict[str, Array]
Step = Callable[[Array, Inputs], Inputs]


def held(**values: float) -> Step:
    """Inputs at a number, where the machine has them."""
    return lambda at, u: {k: np.full(at.size, values[k]) if k in values else v for k, v in u.items()}


def on_off(name: str, level: float, periods: int) -> Step:
    def step(at: Array, u: Inputs) -> Inputs:
        on = (at * 2 * periods / (at[-1] + 1.0)).astype(int) % 2 == 0
        return {**u, name: np.where(on, level, 0.0)} if name in u else u

    return step


def no_faster(speed_rpm: Step) -> Step:
    """The speeds of a step, brought down to the highest of the record; of one at standstill as they are."""

    def step(at: Array, u: Inputs) -> Inputs:
        top, new = np.abs(u["speed_rpm"]).max(), speed_rpm(at, u)
        share = min(top / new["speed_rpm"].max(), 1.0) if top else 1.0
        return {**new, "speed_rpm": share * new["speed_rpm"]}

    return step


def even_current(at: Array, u: Inputs) -> Inputs:
    return {k: np.full(at.size, np.sqrt(np.mean(v**2))) if k.endswith("_A") else v for k, v in u.items()}


def no_bars(at: Array, u: Inputs) -> Inputs:
    """A rotor that stands still under direct current carries none."""
    return {k: np.zeros(at.size) if k == "rotor_A" else v for k, v in u.items()}


def overloaded_then_off(at: Array, u: Inputs) -> Inputs:
    """30 % more than the effective current until half time, nothing after."""
    on = 1.3 * (at < at[-1] / 2)
    return {k: on * np.sqrt(np.mean(v**2)) if k.endswith("_A") else v for k, v in u.items()}


def at_two_speeds(at: Array, u: Inputs) -> Inputs:
    """A quarter of the time each: the highest speed of the record, a third of it, and again."""
    top = np.abs(u["speed_rpm"]).max()
    quarter = np.floor(4 * at / (at[-1] + 1.0))
    return {**u, "speed_rpm": np.where(quarter % 2 == 0, top, top / 3.0)}


def halved_flow(at: Array, u: Inputs) -> Inputs:
    late = np.where(at > 0.5 * at[-1], 0.5, 1.0)
    return {k: v * late if "flow" in k else v for k, v in u.items()}


def warmer(name: str, rise: float) -> Step:
    """A bath that is raised from 40 % of the test on."""
    return lambda at, u: {k: v + rise * (at > 0.4 * at[-1]) if k == name else v for k, v in u.items()}


STILL = held(speed_rpm=0.0, vehicle_speed_mps=0.0)
CANDIDATE_TESTS: Mapping[str, tuple[Step, ...]] = {
    "DC heating at standstill": (even_current, no_bars, STILL),
    "heating at standstill, then cooling down": (overloaded_then_off, no_bars, STILL),
    "no load, fast and slow": (held(current_A=0.0, rotor_A=0.0, vehicle_speed_mps=0.0), at_two_speeds),
    "spin without current": (
        held(current_A=0.0, rotor_A=0.0, vehicle_speed_mps=0.0),
        no_faster(held(speed_rpm=1000.0)),
    ),
    "same current at two speeds": (even_current, no_faster(on_off("speed_rpm", 1500.0, 2))),
    "cool-down with wind on and off": (held(speed_rpm=0.0), no_bars, on_off("vehicle_speed_mps", 12.0, 3)),
    "blower on the machine at standstill": (
        even_current,
        held(speed_rpm=0.0),
        no_bars,
        on_off("vehicle_speed_mps", 8.0, 3),
    ),
    "fan flow halved midway": (halved_flow,),
    "coolant inlet raised by 20 K": (warmer("T_coolant", 20.0),),
}


MINUTES = 240.0


def scaled_currents(factor: float) -> Step:
    return lambda at, u: {k: factor * v if k.endswith("_A") else v for k, v in u.items()}


def carried_out(name: str, base: Plan, factor: float = 1.0) -> Plan:
    """The plan of a candidate test, to be calibrated with: its four hours are the base's record, over and over.

    factor : on all currents, as it was planned
    """

    def inputs(rng: np.random.Generator, at: Array) -> Inputs:
        once = at[at < 60.0 * base.minutes]
        u = {k: np.resize(v, at.size) for k, v in base.inputs(rng, once).items()}
        for step in (*CANDIDATE_TESTS[name], scaled_currents(factor)):
            u = step(at, u)
        return u

    return replace(base, name=f"asked: {name}", role="calibrate", minutes=MINUTES, inputs=inputs)
