"""A permanent-magnet machine in transient: copper and magnetic loss, closed air, a base on a foot."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, cg, splu

from geom import build_mesh, load_machine
from simulated.physics import conduction, films
from simulated.physics.conduction import Body, Face, Solid
from simulated.physics.draws import Draws
from simulated.physics.losses import RPM, copper
from simulated.physics.materials import RESIN, SLOPES, nominal_contact
from simulated.physics.plant import TOLERANCE_W, Plant
from simulated.physics.surfaces import Conditions

Array = NDArray[np.float64]
WINDING = {"winding": 0.45, "winding.left": 0.35, "winding.right": 0.35}  # part -> share of copper in it
IN_ROTOR = 0.15  # of the magnetic loss: in the magnets


@dataclass(frozen=True)
class PmLosses:
    """R20 : resistance at 20 degC that the meter sees (ohm);  phases : copper loss = phases x R x I^2

    magnetic : iron and magnet loss (W) at 383 rpm;  friction : of each bearing (W) at 383 rpm
    """

    R20: float
    phases: float
    magnetic: float
    friction: float


@dataclass(frozen=True)
class PmPlant(Plant):
    """A Plant whose losses are PmLosses and whose films are PmFilms."""

    def sources(self, T: Array, now: Conditions) -> tuple[Array, Array]:
        heat, losses = np.zeros_like(T), self.losses
        assert isinstance(losses, PmLosses)
        watts, turning = losses.phases * losses.R20 * now.current2, now.rpm / 383.0
        for part, share in self.copper_shares().items():
            self._add(heat, part, share * watts, lambda nodes: copper(T[nodes]))
        self._add(heat, "stator.core", (1 - IN_ROTOR) * losses.magnetic * turning**1.4)
        self._add(heat, "magnets", IN_ROTOR * losses.magnetic * turning**2)
        for bearing in ("bearing.left", "bearing.right"):
            self._add(heat, bearing, losses.friction * turning)
        return heat, np.zeros(self.air.size)

    def _solved(self, matrix: sparse.csr_matrix, rhs: Array, guess: Array) -> Array:
        """Conjugate gradients behind a factor of an earlier matrix, made anew when it no longer helps."""
        known = self._cache.get("factor")
        if known is not None:
            T, failed = cg(matrix, rhs, guess, rtol=0.0, atol=TOLERANCE_W, maxiter=30, M=known)
            if not failed:
                return np.asarray(T)
        factor = splu(
            matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
        self._cache["factor"] = LinearOperator(matrix.shape, factor.solve)
        return np.asarray(factor.solve(rhs))

    def copper_shares(self) -> dict[str, float]:
        """Share of the copper in each piece of the winding."""
        volume = {p: fill * float(self.body.volume[self.body.nodes(p)].sum()) for p, fill in WINDING.items()}
        return {p: v / sum(volume.values()) for p, v in volume.items()}

    def winding_mean(self, T: Array) -> float:
        return sum(share * self.mean(part, T) for part, share in self.copper_shares().items())

    def path(self, T: Array, now: Conditions, below: bool) -> float:
        """Heat that foot and base (below) or all else carry off per kelvin between laminations and ambient (W/K)."""
        heat = 0.0
        for face in self.body.faces.values():
            if face.fluid == "ambient" and (face.part in ("foot", "base")) == below:
                h = self.films.coefficient(face.part, "ambient", T[face.nodes], now.ambient, now)
                heat += float(face.areas * h @ (T[face.nodes] - now.ambient))
        return heat / (self.mean("stator.core", T) - now.ambient)

    def ohm(self, T: Array) -> float:
        """What a perfect ohmmeter shows."""
        losses = self.losses
        assert isinstance(losses, PmLosses)
        return losses.R20 * sum(share * float(copper(self.mean(p, T))) for p, share in self.copper_shares().items())


def contacts(names: Iterable[str], draws: Draws) -> dict[str, float]:
    """Conductance of every contact (W/m2/K); left and right are alike, the base's is one of the hidden values."""
    return {n: draws.around(f"contact.{_side(n)}", nominal_contact("pm", n), 0.25) for n in names}


def _side(name: str) -> str:
    return name.replace(".left", "").replace(".right", "")


def solids(machine: Any, draws: Draws) -> dict[str, Solid]:
    """geom's materials moved by draws; the layer between liner and laminations is one of the hidden values."""
    common = draws.around("capacity.machine", 1.0, 0.04)
    out = {}
    for part in machine.parts:
        found, name = machine.material_of(part.name), _side(part.name)
        factor = draws.around(f"conductivity.{name}", 1.0, 0.20 if name == "slot.gap" else 0.08)
        k, rho_c = (factor * found.k_plane, factor * found.k_axial), common * found.rho * found.cp
        out[part.name] = Solid(k, rho_c, SLOPES.get(found.name, RESIN))
    return out


def build(name: str, losses: PmLosses, base: str, draws: Draws, axial: float, segments: int) -> PmPlant:
    """The machine of geom's library with this name; axial (m): thickest layer, laminations conduct badly across."""
    machine = load_machine(name)
    mesh = build_mesh(machine, 0.06, segments, 1, axial)
    body = conduction.build(mesh, solids(machine, draws), contacts(mesh.contacts, draws))
    return PmPlant(body, losses, draw(draws, machine.geometry, base), ClosedAir())  # type: ignore[arg-type]


Index = NDArray[np.int64]
TURNING = ("shaft", "rotor.core", "magnets")
CELLS = ("air.left", "airgap", "air.right")


@dataclass(frozen=True)
class PmFilms:
    """factors : multiplier by part outside, by air space inside;  emissivity : of the machine's body and of the base

    diameter : of the body (m);  rotor_radius, gap (m)
    """

    factors: dict[str, float]
    emissivity: float
    base_emissivity: float
    diameter: float
    rotor_radius: float
    gap: float

    def coefficient(self, part: str, fluid: str, T: Array, T_fluid: Array | float, now: Conditions) -> Array:
        """h (W/m2/K) at every node of a face, for its temperatures T (degC)."""
        if fluid == "ambient":
            glow = films.radiation(T, now.ambient, self.base_emissivity if part == "base" else self.emissivity)
            return self.factors[part] * self._outside(part, T, now) + glow
        return self.factors[fluid] * self._inside(part, fluid, float(np.mean(T_fluid)), now) * np.ones_like(T)

    def _outside(self, part: str, T: Array, now: Conditions) -> Array:
        dT, mean = T - now.ambient, (T + now.ambient) / 2
        if part == "shaft":
            return films.turning_shaft(now.rpm * RPM, mean, 0.05)
        if part in ("base", "foot"):
            return films.natural_third(dT, mean, 0.10)
        if part == "stator.core":
            return films.natural_third(dT, mean, 0.125)
        return films.natural_plate(dT, mean, self.diameter)

    def _inside(self, part: str, fluid: str, T: float, now: Conditions) -> float:
        tip = now.rpm * RPM * self.rotor_radius
        if fluid == "airgap":
            return films.annulus(now.rpm * RPM, T, self.rotor_radius, self.gap)
        return films.end_space((1.0 if part in TURNING else 0.3) * tip)


@dataclass(frozen=True)
class ClosedAir:
    """Three spaces of air without capacity and without exchange between them."""

    size: int = len(CELLS)

    def cells(self, face: Face, body: Body) -> Index:
        return np.full(len(face.nodes), CELLS.index(face.fluid))

    def advection(self) -> tuple[Array, Array]:
        return np.zeros((self.size, self.size)), np.zeros(self.size)


def draw(draws: Draws, geometry: Any, base: str) -> PmFilms:
    """base : "none", "plate" or "bench"; the same draws for every machine, each base with its own emissivity."""
    body = ("stator.core", "endcap.left", "endcap.right", "bearing.left", "bearing.right", "shaft")
    common = draws.around("natural.body", 1.0, 0.15)
    factors = {part: common * draws.around(f"natural.{part}", 1.0, 0.04) for part in (*body, "foot")}
    factors |= {fluid: draws.around(f"film.{fluid}", 1.0, 0.2) for fluid in CELLS}
    factors["base"] = draws.around(f"natural.base.{base}", 1.0, 0.15) if base != "none" else 1.0
    nominal = {"none": 0.1, "plate": 0.03, "bench": 0.10}[base]
    bare = draws.around(f"emissivity.base.{base}", nominal, 0.3) if base != "none" else nominal
    emissivity, s = min(draws.around("emissivity.body", 0.85, 0.06), 0.95), geometry.stator
    return PmFilms(factors, emissivity, bare, s.outer_diameter, s.bore_diameter / 2 - s.air_gap, s.air_gap)
