"""A permanent-magnet machine without housing as a network of a dozen nodes by hand formulas.

Areas and masses come from the description of the parts, so M1, M2 and M3 are one model with their constructive
differences. Small and soon made, it serves screening and calibration; the one condensed from the field is accurate.
Films: Churchill and Chu, McAdams; end space: Schubert; slot: a heated bundle, liner and gap in series.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from thermoscope import Network, plugin as th, read_network

Rows = Mapping[str, th.PartRow]
K_AIR = 0.028  # W/m/K, air near 50 degC
AIR_K = 0.026  # W/m/K
K1, K2, K3 = th.SCHUBERT
WALL = 0.3  # share of the rotor's tip speed that passes a wall at rest
# Of their space (assumed): end turns lie looser than wires in slots.
COPPER_SHARE = {"winding": 0.45, "winding.left": 0.35, "winding.right": 0.35}
JOINTS = {
    "base": 500.0,
    "foot": 1000.0,
    "endcap": 1000.0,
    "shaft": 4000.0,
    "bearing": 150.0,
    "seat": 1500.0,
    "magnets": 520.0,
    "gap": 5000.0,
    "wire": 1000.0,
}
BANDS = 5  # of a base plate, from foot to rim; chosen


@dataclass(frozen=True)
class PmSettings:
    """What table I of the paper varies, and what table II sets.

    convection : W/m2/K on every outer face, None: by correlation;  emissivity : of the body
    base : what carries heat away below: None, or the emissivity of the machine's base plate
    impregnation, end_impregnation : share of the voids that resin fills, 0 to 1: between the wires, and in the slot
        also between liner and laminations, for one bath reaches both
    resistance_ohm : at 20 degC as a meter sees it; phases x R x I^2 is the copper loss
    magnetic_W, at 383 rpm;  gap_mm : effective, None as drawn
    """

    convection: float | None = None
    emissivity: float = 0.85
    base: float | None = 0.1
    impregnation: float = 1.0
    end_impregnation: float = 1.0
    resistance_ohm: float = 2.85
    phases: float = 1.0
    magnetic_W: float = 0.0
    gap_mm: float | None = None
    in_magnets: float = 0.15
    friction_W: float = 10.0


def pm_network(machine: th.MachineDescription, settings: PmSettings, rows: Rows | None = None) -> Network:
    """The network of a machine with magnets in open laminations.  rows : its table of parts, if already made"""
    return read_network(_Builder(machine, settings, rows or table_of(machine)).document(), machine.name)


def table_of(machine: th.MachineDescription) -> Rows:
    """Areas and masses of the parts by name."""
    return {row.name: row for row in th.part_table(machine, 72)}


def bundle(fill: float, k_resin: float, impregnation: float) -> float:
    """Conductivity (W/m/K) across a bundle of wires whose voids resin fills only in part: air and resin mixed first."""
    return th.winding_conductivity(fill, 385.0, filled(impregnation, k_resin))[0]


def filled(share: float, k_resin: float) -> float:
    """Conductivity (W/m/K) of a void that resin fills to a share, air the rest."""
    return k_resin if share >= 1 else th.winding_conductivity(share, k_resin, AIR_K)[0]


class _Builder:
    """Collects the tables of the document."""

    def __init__(self, machine: th.MachineDescription, settings: PmSettings, rows: Rows) -> None:
        self.machine, self.settings, self.g = machine, settings, machine.dimensions
        self.rows = rows
        self.nodes: dict[str, Any] = {}
        self.links: dict[str, Any] = {}
        self.surfaces: dict[str, Any] = {}
        self.parameters: dict[str, Any] = {}

    def document(self) -> dict[str, Any]:
        self._nodes()
        self._winding()
        for side in ("left", "right"):
            air = f"air.{side}"
            for part in (f"winding.{side}", f"endcap.{side}", "stator.core", "rotor.core", "shaft"):
                area = self.rows[part].faces[f"{part}.{air}"]
                self._stirred(part, air, area, 1.0 if part in ("rotor.core", "shaft") else WALL)
        self._rotor()
        diameter, rows = self.g.stator.outer_diameter, self.rows
        self._film("stator.core", "horizontal cylinder", diameter, rows["stator.core"].faces["stator.core.outer"])
        for cap in ("endcap.left", "endcap.right"):
            self._film(cap, "vertical plate", diameter, rows[cap].faces[f"{cap}.outer"])
        self._film("shaft", "horizontal cylinder", self.g.shaft.diameter, rows["shaft"].faces["shaft.outer"])
        if self.settings.base is not None and "base" in self.rows:
            self._base(self.settings.base)
        self._shared()
        return {
            "network": {"name": self.machine.name, "boundaries": ["ambient"]},
            "nodes": self.nodes,
            "surfaces": self.surfaces,
            "means": self._means(),
            "links": self.links,
            "losses": self._losses(),
            "parameters": self.parameters,
        }

    def link(self, a: str, b: str, **keys: Any) -> None:
        self.links[f"{a}-{b}"] = {"between": [a, b], **keys}

    def contact(self, a: str, b: str, joint: str, resistance: float = 0.0) -> float:
        """K/W of the joint between two parts, and of what lies behind it."""
        return 1.0 / (JOINTS[joint] * self.rows[a].contacts[b]) + resistance

    def _capacity(self, *parts: str) -> float:
        return sum(self.rows[p].mass * self.machine.material_of(p).cp for p in parts if p in self.rows)

    def _nodes(self) -> None:
        for part in ("shaft", "rotor.core", "magnets", "stator.core", *COPPER_SHARE):
            self.nodes[part] = {"C_J_K": self._capacity(part)}
        for side in ("left", "right"):
            self.nodes[f"endcap.{side}"] = {"C_J_K": self._capacity(f"endcap.{side}", f"bearing.{side}")}
            self.nodes[f"air.{side}"] = {"kind": "fluid"}
        self.nodes["slot.liner"] = {"C_J_K": self._capacity("slot.liner", "slot.gap")}

    def _winding(self) -> None:
        """Bundle -> liner -> gap -> teeth, and along the wires to the end windings."""
        g, rows, length = self.g, self.rows, self.g.stator.stack_length
        k = bundle(0.45, 0.2, self.settings.impregnation)
        inside = 1.0 / (8 * math.pi * k * length * g.stator.slots)
        liner = g.stator.liner / (self.machine.conductivity("slot.liner")[0] * rows["winding"].contacts["slot.liner"])
        wire = self.contact("winding", "slot.liner", "wire", inside + liner)
        self.link("winding", "slot.liner", R_K_W=wire, prior_sd=0.15)
        gap_mm = 1e3 * g.stator.liner_gap if self.settings.gap_mm is None else self.settings.gap_mm
        area = rows["stator.core"].contacts["slot.gap"]
        joints = 1 / (JOINTS["gap"] * area) + self.contact("slot.gap", "slot.liner", "gap")
        k_gap = filled(self.settings.impregnation, self.machine.conductivity("slot.gap")[0])
        self.link("slot.liner", "stator.core", R_K_W=joints + 1e-3 * gap_mm / (k_gap * area), prior_sd=0.3)
        k_end = bundle(0.35, 0.15, self.settings.end_impregnation)
        along = self.machine.conductivity("winding")[1]
        k_out = self.machine.conductivity("winding.left")[1] * k_end / bundle(0.35, 0.15, 1.0)
        for side in ("left", "right"):
            area = rows["winding"].contacts[f"winding.{side}"]
            path = length / 6 / along + (g.winding.straight + g.winding.end / 3) / k_out
            self.link("winding", f"winding.{side}", R_K_W=path / area)

    def _stirred(self, part: str, air: str, area: float, share: float) -> None:
        tip = 383 * th.RPM * (self.g.stator.bore_diameter / 2 - self.g.stator.air_gap)
        turning = {"input": "speed_rpm", "at": 383, "exponent": K3}
        forced = {"h_W_m2K": K1 * K2 * (share * tip) ** K3, "of": turning}
        self.link(part, air, area_m2=area, h_W_m2K=K1, forced=forced)

    def _rotor(self) -> None:
        """Air gap in pure conduction (Ta < 41 at these speeds), magnets, shaft, bearings."""
        rows, g = self.rows, self.g
        gap = K_AIR / g.stator.air_gap * rows["rotor.core"].faces["rotor.core.gap"]
        self.link("rotor.core", "stator.core", G_W_K=gap, prior_sd=0.2)
        self.link("magnets", "rotor.core", R_K_W=self.contact("magnets", "rotor.core", "magnets"))
        self.link("rotor.core", "shaft", R_K_W=self.contact("rotor.core", "shaft", "shaft"))
        for side in ("left", "right"):
            bearing, cap = f"bearing.{side}", f"endcap.{side}"
            R = self.contact("shaft", bearing, "bearing") + self.contact(cap, bearing, "seat")
            self.link(cap, "shaft", R_K_W=R)
            self.link(cap, "stator.core", R_K_W=self.contact(cap, "stator.core", "endcap"))

    def _film(self, part: str, surface: str, size: float, area: float, emissivity: float | None = None) -> None:
        """A face to ambient: still air (or a given coefficient) and radiation."""
        face = f"{part}.outer"
        if face not in self.surfaces:
            self.surfaces[face] = {"of": part, "area_m2": area, "washed_by": "ambient"}
        name = {"between": [face, "ambient"]}
        radiation = {"emissivity": self.settings.emissivity if emissivity is None else emissivity}
        self.links[f"{face}-ambient"] = {**name, **self._still(surface, size), "radiation": radiation}

    def _still(self, surface: str, size: float) -> dict[str, Any]:
        if self.settings.convection is not None:
            return {"h_W_m2K": self.settings.convection}
        return {"natural": {"surface": surface, "size_m": size}}

    def _base(self, emissivity: float) -> None:
        """Foot, and a plate as a chain of bands along its length."""
        b, foot, rows = self.g.base, self.g.foot, self.rows
        k = self.machine.conductivity("base")[0] * b.thickness
        post = foot.height / (self.machine.conductivity("foot")[0] * rows["foot"].contacts["base"])
        spread = math.log(max(b.width / (foot.width + foot.length), 1.05)) / (2 * math.pi * k)
        above = 1 / (JOINTS["foot"] * rows["foot"].contacts["stator.core"])
        below = 1 / (JOINTS["base"] * rows["foot"].contacts["base"])
        self.link("stator.core", "base.0", R_K_W=above + post + below + spread, prior_sd=0.4)
        half = b.length / 2
        edges = [0.0, *(foot.length / 2 + (half - foot.length / 2) * i / (BANDS - 1) for i in range(BANDS))]
        capacity, foot_capacity = self._capacity("base"), self._capacity("foot")
        for i in range(BANDS):
            node, share = f"base.{i}", (edges[i + 1] - edges[i]) / half
            self.nodes[node] = {"C_J_K": capacity * share + (foot_capacity if i == 0 else 0.0)}
            one, size = b.length * b.width * share, b.length * b.width / (2 * (b.length + b.width))
            self._film(node, "plate facing up", size, one, emissivity)
            under = self._still("plate facing down", size)
            self.links[f"{node}.under-ambient"] = {
                "between": [node, "ambient"],
                "area_m2": one,
                **under,
                "radiation": {"emissivity": emissivity},
            }
            if i:
                step = (edges[i + 1] - edges[i - 1]) / 2
                self.link(f"base.{i - 1}", node, G_W_K=2 * k * b.width / step)

    def _means(self) -> dict[str, Any]:
        volume = {p: fill * self.rows[p].volume for p, fill in COPPER_SHARE.items()}
        _, *ends = (round(v / sum(volume.values()), 6) for v in volume.values())
        shares = dict(zip(volume, (round(1.0 - sum(ends), 6), *ends), strict=True))  # sums to 1 when written too
        return {"winding.copper": {"of": shares}}

    def _losses(self) -> dict[str, Any]:
        s, speed = self.settings, {"input": "speed_rpm", "at": 383, "exponent": 1.4}
        shares: dict[str, Any] = self._means()["winding.copper"]["of"]
        copper = {
            "at": shares,
            "kind": "copper",
            "currents": ["current_A"],
            "factor": s.phases,
            "R20_ohm": s.resistance_ohm,
            "temperature_of": "winding",
            "prior_sd": 0.02,
        }
        out: dict[str, Any] = {"copper": copper}
        if s.magnetic_W:
            parts = {"stator.core": 1 - s.in_magnets, "magnets": s.in_magnets}
            out["magnetic"] = {
                "at": parts,
                "kind": "iron",
                "eddy_W": 0.0,
                "hysteresis_W": s.magnetic_W,
                "speed_at": 383,
                "prior_sd": 0.15,
            }
        caps: dict[str, Any] = {"endcap.left": 0.5, "endcap.right": 0.5}
        out["bearings"] = {"at": caps, "kind": "bearing", "P_W": s.friction_W, "of": speed}
        return out

    def _shared(self) -> None:
        """What machines of one make share: still air, emissivity, end space; and the base's own films."""
        films = [n for n, v in self.links.items() if v["between"][1] == "ambient"]
        body = [n for n in films if not n.startswith("base")]
        still = "" if self.settings.convection is not None else ":natural"
        self._parameter("convection", [f"link:{n}{still}" for n in body], 0.2, "spread of still-air correlations")
        self._parameter("emissivity", [f"link:{n}:radiation" for n in body], 0.15, "paint and age of the surface")
        ends = [n for n, v in self.links.items() if v["between"][1].startswith("air.")]
        both = [f"link:{n}{m}" for n in ends for m in ("", ":forced")]
        self._parameter("end space", both, 0.4, "published sets differ by 2 to 3")
        if "base.0" in self.nodes:
            base_films = [f"link:{n}{m}" for n in films if n.startswith("base.") for m in (still, ":radiation")]
            words = "published plates facing up and down differ by a factor of 2"
            self._parameter("base films", base_films, 0.4, words)
        self._parameter(
            "capacity", [f"capacity:{n}" for n in self.nodes if "C_J_K" in self.nodes[n]], 0.05, "fill factors"
        )

    def _parameter(self, name: str, acts: list[str], sd: float, source: str) -> None:
        self.parameters[name] = {"acts_on": acts, "prior_sd": sd, "low": 0.1, "high": 10.0, "source": source}
