"""One case for every correlation: how it is called in any units, what it gives at rest, where its range ends."""

import importlib
import inspect
import math
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import lumped.correlations
from lumped.correlations import (
    Info,
    air_gap,
    bearings,
    contacts,
    ducts,
    end_space,
    fins,
    forced,
    natural,
    oil,
    rotating,
)
from lumped.transfer.coolant import ATF
from lumped.transfer.properties import Fluid, air, ethylene_glycol

AIR, GLYCOL = air(60.0), ethylene_glycol(60.0, 0.5)
ATF80 = ATF(80.0)
K40, K80 = air(40.0).k, air(80.0).k
PR = air(20.0).Pr
POPIEL_AT_5 = 1 + (0.0571322 + 0.20305 * PR**-0.43) * 5 ** (
    0.9165 - 0.0043 * PR**0.5 + 0.01333 * math.log(PR) + 0.0004809 / PR
)


@dataclass(frozen=True)
class Units:
    """How many of another system's units make a metre, a second, a kilogram and a kelvin."""

    m: float = 1.0
    s: float = 1.0
    kg: float = 1.0
    K: float = 1.0

    @property
    def W(self) -> float:
        return self.kg * self.m**2 / self.s**3

    @property
    def v(self) -> float:
        return self.m / self.s

    @property
    def film(self) -> float:
        return self.W / self.m**2 / self.K

    @property
    def k(self) -> float:
        return self.W / self.m / self.K

    @property
    def Pa(self) -> float:
        return self.kg / self.m / self.s**2

    def fluid(self, f: Fluid) -> Fluid:
        heat = self.W * self.s / self.kg / self.K
        return replace(
            f,
            rho=f.rho * self.kg / self.m**3,
            cp=f.cp * heat,
            k=f.k * self.k,
            mu=f.mu * self.Pa * self.s,
            beta=f.beta / self.K,
        )


# Constants of nature and of the sources that carry units: (module, name) -> the same in other units.
CARRY_UNITS: dict[tuple[object, str], Callable[[Units], object]] = {
    (natural, "G"): lambda u: natural.G * u.v / u.s,
    (fins, "G"): lambda u: fins.G * u.v / u.s,
    (oil, "G"): lambda u: oil.G * u.v / u.s,
    (fins, "INVERSE_METRE"): lambda u: fins.INVERSE_METRE / u.m,
    (contacts, "SIGMA"): lambda u: contacts.SIGMA * u.film / u.K**3,
    (contacts, "ZERO_C"): lambda u: contacts.ZERO_C * u.K,
    (bearings, "KYLANDER"): lambda u: _kylander(bearings.KYLANDER, u),
}


def _kylander(constants, u):
    scale, largest, fastest = constants
    return scale * u.K * u.s / (u.W * u.m**2), largest * u.m, fastest * u.v


@dataclass(frozen=True)
class Case:
    """One correlation.

    run : (fluid, units) -> its answer there;  gives : the unit of the answer
    outside : a reachable point outside its range
    sweep, top : over its driving quantity from 0 to `top`;  rest : the right answer at 0 (conduction, nothing, ...)
    """

    run: Callable[[Fluid, Units], tuple[float, Info]]
    gives: Callable[[Units], float]
    outside: Callable[[], tuple[float, Info]]
    sweep: Callable[[float], float]
    top: float
    rest: float


def _film(run, outside, sweep, top, rest):
    return Case(run, lambda u: u.film, outside, sweep, top, rest)


def _still(run, outside, sweep, rest, top=300.0):
    """A film of still fluid over the surface's temperature."""
    return _film(lambda f, u: run(lambda T: u.fluid(f), u), outside, sweep, top, rest)


CASES = {
    "churchill_chu_cylinder": _still(
        lambda of, u: natural.churchill_chu_cylinder(0.3 * u.m, 60 * u.K, 20 * u.K, of),
        lambda: natural.churchill_chu_cylinder(9.0, 300.0, 20.0),
        lambda x: natural.churchill_chu_cylinder(0.3, 20 + x, 20.0)[0],
        0.36 * air(20.0).k / 0.3,
    ),
    "churchill_chu_plate": _still(
        lambda of, u: natural.churchill_chu_plate(0.3 * u.m, 60 * u.K, 20 * u.K, of),
        lambda: natural.churchill_chu_plate(9.0, 300.0, 20.0),
        lambda x: natural.churchill_chu_plate(0.4, 20 + x, 20.0)[0],
        0.825**2 * air(20.0).k / 0.4,
    ),
    "popiel_cylinder": _still(
        lambda of, u: natural.popiel_cylinder(0.3 * u.m, 0.02 * u.m, 60 * u.K, 20 * u.K, of),
        lambda: natural.popiel_cylinder(9.0, 0.2, 300.0, 20.0),
        lambda x: natural.popiel_cylinder(0.4, 0.05, 20 + x, 20.0)[0],
        POPIEL_AT_5 * 0.825**2 * air(20.0).k / 0.4,
    ),
    "mcadams_plate": _still(
        lambda of, u: natural.mcadams_plate(0.1 * u.m, 60 * u.K, 20 * u.K, True, of),
        lambda: natural.mcadams_plate(0.003, 21.0, 20.0),
        lambda x: natural.mcadams_plate(0.2, 20 + x, 20.0)[0],
        0.0,
    ),
    "van_de_pol_tierney": _still(
        lambda of, u: fins.van_de_pol_tierney(0.02 * u.m, 0.012 * u.m, 0.25 * u.m, 70 * u.K, 30 * u.K, of),
        lambda: fins.van_de_pol_tierney(0.05, 0.05, 0.05, 200.0, 20.0),
        lambda x: fins.van_de_pol_tierney(0.02, 0.01, 0.25, 20 + x, 20.0)[0],
        0.0,
        200.0,
    ),
    "jones_smith": _still(
        lambda of, u: fins.jones_smith(0.012 * u.m, 60 * u.K, 20 * u.K, of),
        lambda: fins.jones_smith(0.1, 200.0, 20.0),
        lambda x: fins.jones_smith(0.012, 20 + x, 20.0)[0],
        0.0,
        200.0,
    ),
    "elenbaas": _still(
        lambda of, u: fins.elenbaas(0.01 * u.m, 0.2 * u.m, 60 * u.K, 20 * u.K, of),
        lambda: fins.elenbaas(0.001, 0.5, 21.0, 20.0),
        lambda x: fins.elenbaas(0.01, 0.2, 20 + x, 20.0)[0],
        0.0,
        200.0,
    ),
    "heiles": _film(
        lambda f, u: fins.heiles(8 * u.v, 0.02 * u.m, 0.25 * u.m, 1.7, u.fluid(f)),
        lambda: fins.heiles(40.0, 0.02, 0.25),
        lambda x: fins.heiles(x, 0.02, 0.25)[0],
        30.0,
        0.0,
    ),
    "heiles_decaying": _film(
        lambda f, u: fins.heiles_decaying(
            8 * u.v, 0.02 * u.m, 0.25 * u.m, partial(fins.straight_decay, 0.2), 1.7, u.fluid(f)
        ),
        lambda: fins.heiles_decaying(60.0, 0.02, 0.25, partial(fins.straight_decay, 0.2)),
        lambda x: fins.heiles_decaying(x, 0.02, 0.25, partial(fins.straight_decay, 0.2))[0],
        30.0,
        0.0,
    ),
    "flat_plate": _film(
        lambda f, u: forced.flat_plate(8 * u.v, 0.5 * u.m, u.fluid(f)),
        lambda: forced.flat_plate(400.0, 10.0),
        lambda x: forced.flat_plate(x, 0.5)[0],
        60.0,
        0.0,
    ),
    "churchill_bernstein": _film(
        lambda f, u: forced.churchill_bernstein(8 * u.v, 0.3 * u.m, u.fluid(f)),
        lambda: forced.churchill_bernstein(1e-6, 0.3),
        lambda x: forced.churchill_bernstein(x, 0.3)[0],
        60.0,
        0.3 * air(30.0).k / 0.3,
    ),
    "duct_film": _film(
        lambda f, u: ducts.duct_film(8 * u.v, 0.02 * u.m, 0.3 * u.m, u.fluid(f)),
        lambda: ducts.duct_film(5000.0, 0.2, 2.0),
        lambda x: ducts.duct_film(x, 0.02, 0.25)[0],
        50.0,
        3.66 * K40 / 0.02,
    ),
    "gnielinski_annulus": _film(
        lambda f, u: ducts.gnielinski_annulus(8 * u.v, 0.1 * u.m, 0.12 * u.m, 0.3 * u.m, u.fluid(f)),
        lambda: ducts.gnielinski_annulus(1500.0, 0.1, 0.2, 2.0),
        lambda x: ducts.gnielinski_annulus(x, 0.1, 0.12, 0.5)[0],
        40.0,
        (3.66 + 1.2 * (5 / 6) ** -0.8) * K40 / 0.02,
    ),
    "schmidt_helical": _film(
        lambda f, u: ducts.schmidt_helical(u.v, 0.01 * u.m, 0.3 * u.m, u.fluid(f)),
        lambda: ducts.schmidt_helical(500.0, 0.01, 0.3, GLYCOL),
        lambda x: ducts.schmidt_helical(x, 0.009, 0.2, GLYCOL)[0],
        5.0,
        3.66 * GLYCOL.k / 0.009,
    ),
    "taylor_film": _film(
        lambda f, u: air_gap.taylor_film(300 / u.s, 0.1 * u.m, 0.001 * u.m, u.fluid(f)),
        lambda: air_gap.taylor_film(100.0, 0.1, 0.03),
        lambda x: air_gap.taylor_film(x, 0.1, 0.001)[0],
        1500.0,
        2 * K80 / 0.001,
    ),
    "becker_kaye": _film(
        lambda f, u: air_gap.becker_kaye(300 / u.s, 0.1 * u.m, 0.001 * u.m, u.fluid(f)),
        lambda: air_gap.becker_kaye(100.0, 0.1, 0.03),
        lambda x: air_gap.becker_kaye(x, 0.1, 0.001)[0],
        1500.0,
        K80 / 0.001,
    ),
    "romanazzi_howey": _film(
        lambda f, u: air_gap.romanazzi_howey(300 / u.s, 0.1 * u.m, 0.003 * u.m, u.fluid(f)),
        lambda: air_gap.romanazzi_howey(2000.0, 0.1, 0.02),
        lambda x: air_gap.romanazzi_howey(x, 0.1, 0.003)[0],
        1500.0,
        2 * K80 / 0.003,
    ),
    "kosterin_finatev": _film(
        lambda f, u: air_gap.kosterin_finatev(300 / u.s, 20 * u.v, 0.1 * u.m, 0.003 * u.m, u.fluid(f)),
        lambda: air_gap.kosterin_finatev(300.0, 1.0, 0.1, 0.001),
        lambda x: air_gap.kosterin_finatev(300.0, x, 0.1, 0.003)[0],
        60.0,
        air_gap.taylor_film(300.0, 0.1, 0.003)[0],
    ),
    "gazley_slotting": Case(
        lambda _, u: air_gap.gazley_slotting(0.01 * u.m, 0.001 * u.m, 2e3),
        lambda u: 1.0,
        lambda: air_gap.gazley_slotting(0.01, 0.001, 2e4),
        lambda x: air_gap.gazley_slotting(0.01, 0.001, x)[0],
        9e3,
        1.0,
    ),
    "rotating_disc": _film(
        lambda f, u: rotating.rotating_disc(300 / u.s, 0.1 * u.m, u.fluid(f)),
        lambda: rotating.rotating_disc(3e4, 0.3),
        lambda x: rotating.rotating_disc(x, 0.2)[0],
        400.0,
        0.0,
    ),
    "levich_disc": _film(
        lambda f, u: rotating.levich_disc(300 / u.s, 0.1 * u.m, u.fluid(f)),
        lambda: rotating.levich_disc(3e3, 0.1, ATF80),
        lambda x: rotating.levich_disc(x, 0.08, ATF80)[0],
        300.0,
        0.0,
    ),
    "rotating_shaft": _film(
        lambda f, u: rotating.rotating_shaft(300 / u.s, 0.05 * u.m, u.fluid(f)),
        lambda: rotating.rotating_shaft(1.0, 0.05),
        lambda x: rotating.rotating_shaft(x, 0.06)[0],
        400.0,
        0.0,
    ),
    "saari_windage": Case(
        lambda f, u: rotating.saari_windage(300 / u.s, 0.1 * u.m, 0.001 * u.m, 0.2 * u.m, 1.0, u.fluid(f)),
        lambda u: u.W,
        lambda: rotating.saari_windage(5e5, 0.1, 0.01, 0.2),
        lambda x: rotating.saari_windage(x, 0.1, 0.001, 0.2)[0],
        2500.0,
        0.0,
    ),
    "disc_windage": Case(
        lambda f, u: rotating.disc_windage(300 / u.s, 0.1 * u.m, 0.05 * u.m, u.fluid(f)),
        lambda u: u.W,
        lambda: rotating.disc_windage(3e4, 0.3),
        lambda x: rotating.disc_windage(x, 0.2)[0],
        600.0,
        0.0,
    ),
    "free_jet": _film(
        lambda f, u: oil.free_jet(3 * u.v, 0.002 * u.m, 0.01 * u.m, u.fluid(f)),
        lambda: oil.free_jet(30.0, 0.002, 0.01, ATF80),
        lambda x: oil.free_jet(x, 0.002, 0.01, ATF80)[0],
        10.0,
        0.0,
    ),
    "falling_film": _film(
        lambda f, u: oil.falling_film(1e-4 * u.m * u.v, 0.05 * u.m, u.fluid(f)),
        lambda: oil.falling_film(1e-5, 0.05, ATF80),
        lambda x: oil.falling_film(x**9, 0.05, ATF80)[0],  # it grows with its ninth root
        0.4,
        0.0,
    ),
    "sprayed_face": _film(
        lambda f, u: oil.sprayed_face(3e-5 * u.m**2 * u.v, 6, 0.002 * u.m, 0.02 * u.m**2, 0.06 * u.m, u.fluid(f)),
        lambda: oil.sprayed_face(1e-6, 6, 0.002, 0.02, 0.06, ATF80),
        lambda x: oil.sprayed_face(x**9, 6, 0.002, 0.02, 0.06, ATF80)[0],
        0.35,
        0.0,
    ),
    "end_space": _film(
        lambda _, u: end_space.end_space(10 * u.v, 20 * u.film, 0.5 / u.v**0.7, 0.7),
        lambda: end_space.end_space(80.0),
        lambda x: end_space.end_space(x)[0],
        50.0,
        15.0,
    ),
    "cooper_mikic_yovanovich": _film(
        lambda _, u: contacts.cooper_mikic_yovanovich(180 * u.k, 0.1, 2e-6 * u.m, 1e6 * u.Pa, 1e9 * u.Pa, 0.026 * u.k),
        lambda: contacts.cooper_mikic_yovanovich(180.0, 0.1, 2e-6, 1e8, 1e9),
        lambda x: contacts.cooper_mikic_yovanovich(180.0, 0.1, 2e-6, x, 1e9)[0] if x else 0.0,
        1e7,
        0.0,
    ),
    "radiation_film": _film(
        lambda _, u: contacts.radiation_film(0.9, 80 * u.K, 20 * u.K),
        lambda: contacts.radiation_film(1.2, 80.0, 20.0),
        lambda x: contacts.radiation_film(0.9, 20.0 + x, 20.0)[0],
        300.0,
        4 * 0.9 * 5.670374419e-8 * 293.15**3,
    ),
    "kylander_bearing": Case(
        lambda _, u: bearings.kylander_bearing(0.06 * u.m, 100 / u.s),
        lambda u: u.K / u.W,
        lambda: bearings.kylander_bearing(0.2, 10.0),
        lambda x: bearings.kylander_bearing(0.06, x)[0],
        500.0,
        0.45 * (0.12 - 0.06) * 33.0,
    ),
}


def declared() -> dict[str, Callable[..., tuple[float, Info]]]:
    """Name -> function, for every public function of the room that answers with an Info."""
    found = {}
    for module in pkgutil.iter_modules(lumped.correlations.__path__, "lumped.correlations."):
        for name, f in inspect.getmembers(importlib.import_module(module.name), inspect.isfunction):
            if f.__module__ == module.name and not name.startswith("_") and "Info]" in str(f.__annotations__["return"]):
                found[name] = f
    return found
