"""What a winding may rise by: the limit of its thermal class, corrected for duty, coolant and altitude, row by row.

IEC 60034-1, windings that air cools indirectly. Clauses are quoted as deep as the headings of the standard go; the
numbers of its tables differ between editions and are left out, as is what editions differ in.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from thermoscope import plugin as th

STANDARDS = ("IEC 60034-1", "IEC 60349")
RESISTANCE, DETECTORS = "resistance", "ETD"
# K over a coolant of 40 degC, by resistance; of machines without a fan (or potted), and of those below 600 W
CLASSES: Mapping[str, float] = {"A": 60.0, "E": 75.0, "B": 80.0, "F": 105.0, "H": 125.0}
UNVENTILATED: Mapping[str, float] = {"A": 65.0, "E": 75.0, "B": 85.0, "F": 110.0, "H": 130.0}
SMALL_KW = 0.6
# By embedded detectors: above 200 kW, and from 5000 kW; below, the resistance alone counts
EMBEDDED: Mapping[str, float] = {"B": 90.0, "F": 115.0, "H": 140.0}
EMBEDDED_LARGE: Mapping[str, float] = {"B": 85.0, "F": 110.0, "H": 130.0}
DETECTORS_KW, LARGE_KW = 200.0, 5000.0
SHORT_TIME_K = 10.0  # more for short-time duty below 5000 kW
COOLANT_C, HOTTEST_C, DIFFERENCE_K = 40.0, 60.0, 30.0  # reference; beyond these two, limits are by agreement
LEVEL_M, HIGHEST_M, LOSS_M = 1000.0, 4000.0, 10_000.0  # up to here nothing changes; 1 % of the limit for every 100 m
GRADIENT_K_H = 2.0  # of a machine that counts as steady: 1 K per half hour
AGREEMENT = "by agreement in the standard: give [limit] K and source"


@dataclass(frozen=True)
class Rating:
    """What a limit depends on.  rated_kW, thermal_class, duty : of the machine;  fan : False without one, or potted

    site_m, test_m : altitude where it works, where it was tested;  site_C, test_C : coolant there (degC)
    agreed_K, source : a limit by contract or another standard, which is not corrected
    """

    rated_kW: float
    thermal_class: str
    standard: str = STANDARDS[0]
    duty: str = "S1"
    fan: bool = True
    site_m: float = 0.0
    test_m: float = 0.0
    site_C: float = COOLANT_C
    test_C: float = COOLANT_C
    agreed_K: float | None = None
    source: str = ""


@dataclass(frozen=True)
class Correction:
    """A row of the table of limits: what, where it stands, what it does to the limit, and the limit after it (K)."""

    what: str
    clause: str
    effect: str
    limit_K: float | None


def methods(rating: Rating, k: float) -> list[Correction]:
    """How the rise is determined, as rows above those of its limit."""
    rows = [
        Correction(f"by resistance, k = {k:g}", "8.6.2", "(R2 - R1) / R1 (k + t1) + t1 - ta", None),
        Correction("steady state", "8.7", f"within {GRADIENT_K_H:g} K/h", None),
    ]
    if rating.standard == STANDARDS[0]:
        delay = th.allowed_delay(rating.rated_kW)
        effect = f"a first reading counts up to {delay:g} s, up to {2 * delay:g} s it goes back to {delay:g} s"
        rows.insert(1, Correction(f"stopping time at {rating.rated_kW:g} kW", "8.6.2.3", effect, None))
    return rows


def corrections(rating: Rating, method: str) -> list[Correction]:
    """The limit of a method row by row; the last row's is the one that counts, None where there is none."""
    if rating.agreed_K is not None:
        return [Correction("limit by agreement", rating.source or "[limit]", "not corrected", rating.agreed_K)]
    if rating.standard != STANDARDS[0]:
        return [Correction(f"limits of {rating.standard}", "not read", "give [limit] K and source", None)]
    first = _tabled(rating, method)
    out = [first]
    for step in (_short_time, _coolant, _altitude):
        if out[-1].limit_K is not None:
            out.append(step(rating, out[-1].limit_K))
    return out


def _tabled(rating: Rating, method: str) -> Correction:
    name = f"class {rating.thermal_class}"
    if method == DETECTORS:
        if rating.rated_kW <= DETECTORS_KW:
            return Correction(name, "8.10", f"no limit up to {DETECTORS_KW:g} kW: the resistance counts", None)
        table = EMBEDDED if rating.rated_kW < LARGE_KW else EMBEDDED_LARGE
    else:
        table = CLASSES if rating.fan and rating.rated_kW >= SMALL_KW else UNVENTILATED
    if rating.thermal_class not in table or (rating.thermal_class == "E" and rating.rated_kW >= LARGE_KW):
        return Correction(name, "8.10", "not read: give [limit] K and source", None)
    how = "" if table is not UNVENTILATED else "below 600 W: " if rating.fan else "without a fan, or potted: "
    return Correction(name, "8.10", f"{how}{table[rating.thermal_class]:g} K", table[rating.thermal_class])


def _short_time(rating: Rating, limit: float) -> Correction:
    more = SHORT_TIME_K if rating.duty == "S2" and rating.rated_kW < LARGE_KW else 0.0
    return Correction(f"duty {rating.duty}", "4.2, 8.10", f"+{more:g} K" if more else "none", limit + more)


def _coolant(rating: Rating, limit: float) -> Correction:
    """Less by what the coolant of the site is above 40 degC; a cooler site gains nothing, editions differ there."""
    name = f"coolant {rating.site_C:g} degC at the site, {rating.test_C:.1f} degC in the test"
    if rating.site_C > HOTTEST_C or abs(rating.site_C - rating.test_C) > DIFFERENCE_K:
        return Correction(name, "6.3, 8.10", AGREEMENT, None)
    less = max(rating.site_C - COOLANT_C, 0.0)
    return Correction(name, "6.3, 8.10", f"-{less:g} K" if less else "none", limit - less)


def _altitude(rating: Rating, limit: float) -> Correction:
    """Thin air cools less: the limit of a test is higher where its site is the higher one, lower where it is lower."""
    name = f"altitude {rating.site_m:g} m of the site, {rating.test_m:g} m of the test"
    if max(rating.site_m, rating.test_m) > HIGHEST_M:
        return Correction(name, "6.2, 8.10", AGREEMENT, None)
    factor = 1.0 + (max(rating.test_m, LEVEL_M) - max(rating.site_m, LEVEL_M)) / LOSS_M
    return Correction(name, "6.2, 8.10", f"x {factor:.3f}" if factor != 1.0 else "none", limit * factor)
