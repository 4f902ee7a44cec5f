"""Hidden effects in the true machines' own terms. Amplitudes are those an engineer would quote; laws and places differ
from any textbook's: they sit on cells, bend with temperature, and follow other exponents."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from hidden.truth.body import Array, Joint, Skeleton
from hidden.truth.change import Change
from hidden.truth.films import wind
from hidden.truth.machine import Film, Loss

METER = 0.04  # twice what shunts and meters of a bench may be off by: less is no wrong range


def tapered(n: int) -> Array:
    """Shares that fall along a body and sum to 1."""
    w = 1.0 + 0.6 * np.linspace(0.5, -0.5, n)
    return np.asarray(w / w.sum())


def to_room(body: str, h: Callable[[Array, Array, Mapping[str, float]], Array | float]) -> Change:
    """A film on a body, unevenly spread; h in W/K over all of it."""

    def terms(s: Skeleton) -> tuple[Film, ...]:
        cells = s.cells(body)
        return (Film("hidden film", cells, "T_ambient", tapered(cells.size), h),)

    return Change(terms=terms)


def airflow(body: str, a: float, size: float = 0.2) -> Change:
    """Road wind on a body: a W/K at 10 m/s if it grew with v^0.8; it grows with v^0.63, the same at 8 m/s."""
    level = float(wind(np.array(60.0), np.array(20.0), np.array(8.0), size))

    def h(T: Array, Ta: Array, u: Mapping[str, float]) -> Array:
        return wind(T, Ta, np.array(u["vehicle_speed_mps"]), size) / level * a * 0.8**0.8

    return to_room(body, h)


def draught(body: str, a: float) -> Change:
    """Steady extra cooling, a W/K at 40 degC, 0.1 %/K more when hotter."""

    return to_room(body, lambda T, Ta, u: a * (1.0 + 0.001 * (T - 40.0)))


def spinning(body: str, a: float) -> Change:
    """A turning part that cools to the room: a W/K at 1000 rpm if with n^0.7; with n^0.8 here, equal at 1500 rpm."""

    return to_room(body, lambda T, Ta, u: a * 1.5**0.7 * (u["speed_rpm"] / 1500.0) ** 0.8)


def bridge(name: str, a: float, one: str, other: str, spots: tuple[float, float] = (0.5, 0.5)) -> Change:
    """Conduction a (W/K) between spots of two bodies, 0.05 %/K more when warmer."""
    return Change(joints=(Joint(f"hidden {name}", one, other, a, spots, 5e-4),))


def made_in(body: str, watts: Callable[[Array, Mapping[str, float]], Array]) -> Change:
    """Loss (W) in a body, unevenly spread."""

    def terms(s: Skeleton) -> tuple[Loss, ...]:
        cells = s.cells(body)
        return (Loss("hidden loss", cells, tapered(cells.size), watts),)

    return Change(terms=terms)


def heating(
    body: str, a: float, speed: tuple[float, float] = (0, 0), current: tuple[float, float] = (0, 0), fade: float = 0.0
) -> Change:
    """Extra loss a (W) at 1000 rpm and 100 A.

    speed, current : (exponent a textbook would use, true exponent); equal at 1500 rpm; fade : less per K above 60 degC
    """

    def watts(T: Array, u: Mapping[str, float]) -> Array:
        n = 1.5 ** speed[0] * (abs(u["speed_rpm"]) / 1500.0) ** speed[1] if speed[0] else 1.0
        amps = (abs(u["current_A"]) / 100.0) ** current[1] if current[1] else 1.0
        return a * n * amps * (1.0 - fade * (T - 60.0))

    return made_in(body, watts)


def stirred_gap(a: float, rotor: str, stator: str) -> Change:
    """Extra exchange across the gap: a W/K at 1000 rpm if with n^0.5; with n^0.6 here, equal at 1500 rpm."""

    def h(T: Array, Ta: Array, u: Mapping[str, float]) -> float:
        return a * 1.5**0.5 * (u["speed_rpm"] / 1500.0) ** 0.6

    def terms(s: Skeleton) -> tuple[Film, ...]:
        cells = s.cells(rotor)
        return (Film("hidden gap", cells, s.cells(stator), np.full(cells.size, 1.0 / cells.size), h),)

    return Change(terms=terms)


def fading(films: str, a: float) -> Change:
    """Films of a body lose the share a within an hour, faster at first."""
    return Change(signals={f"fade.{films}": lambda time: np.minimum(a * 1.1 * (time / 3600.0) ** 0.9, 0.95)})


def covered(films: Sequence[str], a: float) -> Change:
    """A cover over some films: the share a of each is lost."""
    return Change(signals={f"cover.{name}": lambda time: np.full(time.shape, a) for name in films})


def less(name: str, a: float) -> Change:
    """An input is in truth exp(-a) times what is written down: a pump that slips, a meter on the wrong range."""
    return Change(driven={name: lambda time, planned: np.exp(-a) * planned})


def joined(body: str, a: float) -> Change:
    """A shaft of a W/K to a driven machine that warms up by 30 K in the course of a test, and faster when it turns."""

    def watts(T: Array, u: Mapping[str, float]) -> Array:
        return a * (u["T_ambient"] + u["joined_K"] * (0.4 + 0.6 * min(abs(u["speed_rpm"]) / 1500.0, 1.0)) - T)

    def terms(s: Skeleton) -> tuple[Loss, ...]:
        cells = s.cells(body)
        return (Loss("joined machine", cells[-1:], np.ones(1), watts),)

    return Change(terms=terms, signals={"joined_K": lambda time: -30.0 * np.expm1(-time / 1500.0)})


def warming(body: str, P20: float, a: float) -> Change:
    """What a copper loss of P20 (W) at 20 degC and 1 A gains with temperature, a per K."""

    def terms(s: Skeleton) -> tuple[Loss, ...]:
        cells = s.cells(body)
        gained = lambda T, u: P20 * u["current_A"] ** 2 * a * (T - 20.0)  # noqa: E731
        return (Loss("resistance that follows", cells, np.full(cells.size, 1.0 / cells.size), gained),)

    return Change(terms=terms)


def switched(body: str, a: float, switch: str) -> Change:
    """Heat of a W while an input is on."""
    return made_in(body, lambda T, u: a * u[switch])


def blown(body: str, a: float, switch: str) -> Change:
    """A film of a W/K on a body while an input is on."""
    return to_room(body, lambda T, Ta, u: a * u[switch] * (1.0 + 0.001 * (T - 40.0)))


def room_air(body: str, a: float) -> Change:
    """A lid open: a W/K straight from a body of air to the room, more with the root of the difference."""
    return to_room(body, lambda T, Ta, u: a * (((T - Ta) ** 2 + 4.0) / 100.0) ** 0.25)
