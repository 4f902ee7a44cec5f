"""The published screening: table I's seven factors on a permanent-magnet machine, four responses, transient runs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from extras.bench.factors.factorial import Design, Effects, Factor, Response, Varied, effects
from extras.bench.reduction.pm_network import PmSettings, Rows, pm_network, table_of
from thermoscope import Record, plugin as th, simulate

AMBIENT = 20.0  # degC
TABLE_I = (
    Factor("A", "convection", 5.0, 10.0),
    Factor("B", "emissivity", 0.2, 0.8),
    Factor("C", "base", True, False),
    Factor("D", "winding impregnation", 0.2, 0.8),
    Factor("E", "end-winding impregnation", True, False),
    Factor("F", "speed", 200.0, 400.0),
    Factor("G", "magnetic loss", 1.0, 1.5),
)
WITH_GAP = (*TABLE_I, Factor("H", "liner gap", 0.7, 1.4))  # mm, M2's and M1's: calibrated, not screened, in the paper
STEP, PATH = "winding minus magnets", "R_w (mK/W)"
RESPONSES = {"magnets": "magnets", "winding": "winding", "end winding": "winding.left", "lamination": "stator.core"}
BATH = ("winding impregnation", "end-winding impregnation")  # filled in one and the same bath
POOR, GOOD = 0.2, 0.8  # impregnation of the end windings, "no" and "yes"


@dataclass(frozen=True)
class Load:
    """The simulated test: current (A) for some hours; the magnetic loss (W) does not depend on the speed here."""

    current: float = 8.0
    hours: float = 6.0
    step_s: float = 300.0
    magnetic_W: float = 76.0
    resistance_ohm: float = 2.73
    phases: float = 1.0


def run(
    machine: th.MachineDescription, levels: Mapping[str, Any], load: Load, rows_of: Rows | None = None
) -> dict[str, float]:
    """Rises over ambient (K) at the end of the test; `levels` by the factors' names, others at table I's low."""
    level = {f.name: f.low for f in TABLE_I} | dict(levels)
    network = pm_network(machine, settings(level, load), rows_of)
    rows = [network.places[place].mean for place in RESPONSES.values()]
    time = np.arange(0.0, load.hours * 3600.0 + 1.0, load.step_s)
    inputs = {"current_A": np.full(time.size, load.current), "speed_rpm": np.full(time.size, float(level["speed"]))}
    record = Record(time, inputs, {"ambient": np.full(time.size, AMBIENT)}, AMBIENT)
    y = simulate(network, record, rows=rows).y[-1] - AMBIENT
    return dict(zip(RESPONSES, (float(v) for v in y), strict=True))


def settings(level: Mapping[str, Any], load: Load) -> PmSettings:
    """Factors' levels as settings of the network."""
    end = level["end-winding impregnation"]
    return PmSettings(
        convection=level["convection"],
        emissivity=level["emissivity"],
        base=(level["emissivity"] if level["base"] > 0.5 else None),
        impregnation=level["winding impregnation"],
        end_impregnation=(GOOD if end is True else POOR if end is False else float(end)),
        resistance_ohm=load.resistance_ohm,
        phases=load.phases,
        magnetic_W=load.magnetic_W * level["magnetic loss"] * 383.0 / level["speed"],
        friction_W=0.0,
        gap_mm=level.get("liner gap"),
    )


def path_mK_W(rises: Mapping[str, float], load: Load) -> float:
    """R_w of fig. 10: the step winding to magnets over the copper loss that drives it (mK/W)."""
    loss = load.phases * load.resistance_ohm * load.current**2 * (1 + th.ALPHA_CU * (rises["winding"] + AMBIENT - 20.0))
    return 1e3 * (rises["winding"] - rises["magnets"]) / loss


@dataclass(frozen=True)
class Screening:
    """design and rises (n_run, n_response) K, with the effects on every response, on the step winding to magnets (K)
    and on R_w, that step over the copper loss (mK/W).
    """

    design: Design
    rises: th.Array
    effects: Mapping[str, Effects]

    def document(self) -> dict[str, Any]:
        effects = {name: e.document() for name, e in self.effects.items()}
        head = {"runs": len(self.rises), "resolution": self.design.resolution, "responses": list(RESPONSES)}
        return {**head, "effects": effects}


def screen(machine: th.MachineDescription, design: Design, load: Load | None = None) -> Screening:
    """All runs of a design, one transient each."""
    table = table_of(machine)
    runs = [run(machine, level, load or Load(), table) for level in design.settings()]
    rises = np.array([list(one.values()) for one in runs])
    response_of = {name: rises[:, j] for j, name in enumerate(RESPONSES)}
    response_of[STEP] = response_of["winding"] - response_of["magnets"]
    response_of[PATH] = np.array([path_mK_W(one, load or Load()) for one in runs])
    return Screening(design, rises, {name: effects(design, y, name) for name, y in response_of.items()})


def varied(machine: th.MachineDescription, load: Load | None = None) -> tuple[list[Varied], dict[str, Response]]:
    """Table I and the liner gap as continuous factors, and three responses: magnets (K), the step winding to magnets
    (K), and R_w (mK/W).

    The voids of slots and of end windings are filled in one and the same bath, so the two count as one group.
    """
    table, test = table_of(machine), load or Load()
    cache: dict[tuple[tuple[str, float], ...], dict[str, float]] = {}

    def rises(levels: Mapping[str, float]) -> dict[str, float]:
        key = tuple(sorted(levels.items()))
        if key not in cache:
            cache[key] = run(machine, levels, test, table)
        return cache[key]

    between = {"base": (0.0, 1.0), "end-winding impregnation": (POOR, GOOD)}  # of what has no levels in between
    limits = {f.name: between.get(f.name, (f.low, f.high)) for f in WITH_GAP}
    factors = [Varied(n, low, high, "impregnation" * (n in BATH)) for n, (low, high) in limits.items()]
    return factors, {
        "magnets": lambda levels: rises(levels)["magnets"],
        STEP: lambda levels: rises(levels)["winding"] - rises(levels)["magnets"],
        PATH: lambda levels: path_mK_W(rises(levels), test),
    }
