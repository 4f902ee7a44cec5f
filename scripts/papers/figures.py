"""Figures of the thermal test paper that are drawings or need the field: 1, 2, 3 and 9."""

import numpy as np
from numpy.typing import NDArray

from extras.bench.measuring.protocol import STEPS
from lumped.integration.simulate import simulate
from scripts.papers.machines import m1
from scripts.papers.page import Row, Section
from validation.comparison.compare import physical
from validation.comparison.predict import record, thermal
from validation.parameters.unknowns import standing

Array = NDArray[np.float64]
NODES = {  # fig. 1, from the middle to the outside -> parts of the network
    "shaft": ("shaft",),
    "rotor lamination": ("rotor.core",),
    "magnets": ("magnets",),
    "winding": ("winding",),
    "end windings": ("winding.left", "winding.right"),
    "stator lamination": ("stator.core",),
    "end-caps": ("endcap.left", "endcap.right"),
    "base": ("base", "base.plate"),
}
STAGES = (
    ("fig. 3, 1: thermal test", "`thermoscope bench protocol` lists and checks its steps"),
    (
        "fig. 3, 2: temperatures when switched off",
        "`thermoscope bench protocol RECORD.toml`; `after = { ... }` in a sheet",
    ),
    ("fig. 3, 3: uncertainty", "the same: worst case, GUM and Monte Carlo side by side"),
    ("fig. 9, 1: sensitivity analysis", "`thermoscope bench screen MACHINE`, with `--design morris` or `sobol`"),
    ("fig. 9, 2: tests for what is critical, calibration", "`thermoscope model calibrate cases/pmsm-bases`, `bases`"),
    ("fig. 9, 3: uncertainty, validation", "`thermoscope test compare`, `thermoscope bench carry SOURCE CASE...`"),
)


def figure_1() -> Section:
    """The paper's nodes and ours."""
    network = m1().case.model.network
    head = ("node of the paper", "parts here", "shapes beside the mean", "heat capacity (kJ/K)")
    rows = []
    for node, parts in NODES.items():
        shapes = sum(any(s.startswith(f"{p}#") for p in parts) for s in network.states)
        C = sum(network.C[network.states.index(p)] for p in parts)
        rows.append((node, ", ".join(parts), str(shapes), f"{C / 1e3:.2f}"))
    words = (
        f"The paper draws its network without values. Ours has {len(network.states)} states condensed from the field: "
        "beside the nodes that the paper shows, slot liner, gap, foot, bearings and three spaces of air; shapes carry "
        "what one temperature per node cannot, such as the fin of the base."
    )
    return Section("Figure 1: the network", words, table=(head, *rows))


def slots() -> tuple[float, float, float]:
    """Spread in one slot's winding, between slots' means, and between the winding's ends and middle (K), at 8 A."""
    case = m1().case
    network, test = thermal(standing(case)), next(t for t in case.tests if t.name == "bench")
    known = {p.name for p in network.parameters}
    values = {k: v for k, v in physical(case).items() if k in known}
    run = simulate(network, record(test, {}), values, keep_states=True)
    assert run.z is not None
    shapes = network.recovery.parts["winding"]  # type: ignore[union-attr]
    T = shapes.V @ run.z[-1][shapes.states]
    angle = np.arctan2(shapes.xyz[:, 1], shapes.xyz[:, 0]) % (2 * np.pi)
    number = (angle / (2 * np.pi / 18)).astype(int)
    inside = [float(np.ptp(T[number == k])) for k in range(18)]
    means = [float(T[number == k].mean()) for k in range(18)]
    z = shapes.xyz[:, 2]
    ends = np.abs(z - z.mean()) > 0.45 * np.ptp(z)
    return max(inside), float(np.ptp(means)), float(T[ends].mean() - T[~ends].mean())


def figure_2() -> Section:
    inside, between, along = slots()
    why = "in the model only the base tells slots apart; the paper's differ by how they were made"
    rows = (
        Row("within one slot", "10 K", f"{inside:.1f} K", "from liner to the bundle's middle and along the slot"),
        Row("between slots", "8 K", f"{between:.1f} K", why),
        Row("end of the slot against its middle", "-", f"{along:+.1f} K"),
    )
    words = (
        "Spread of the winding's temperature on the bench at the end of the test, from the network's own field. The "
        "paper's thermocouples have no published positions. Where a sensor sits is worth kelvins, which is why means "
        "from resistance and back-EMF are compared."
    )
    return Section("Figure 2: three slots", words, rows)


def figures_3_and_9() -> Section:
    steps = tuple((f"{k + 1}. {name}", f"{when}: {what}") for k, (name, when, what, _) in enumerate(STEPS))
    words = "The flow charts as commands, and below the steps of the test that `thermoscope bench protocol` checks."
    return Section("Figures 3 and 9: flow charts", words, table=(("stage", "here"), *STAGES, *steps))
