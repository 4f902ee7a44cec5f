"""Heat that bases carry off: conduction through their feet, then convection and radiation from their faces."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geom.description.roles import Role
from geom.table import TableRow
from lumped.integration.balance import Balance, balance
from lumped.integration.simulate import simulate
from lumped.machine.bases import Switched
from lumped.model.network import Link, Network
from lumped.model.sites import ambient, part_of, role
from lumped.transfer.laws import Radiation
from measured.case import Test
from validation.comparison.predict import heat_model, record

BODY = "stator.core"


@dataclass(frozen=True)
class BaseHeat(TableRow):
    """W at a test's end.  conduction : from the machine into feet and bases;  convection, radiation : from their faces

    body : from the machine's own outer faces;  rise_K : of the laminations over ambient
    """

    properties = ("path_W_K", "body_W_K")

    conduction: float
    convection: float
    radiation: float
    body: float
    rise_K: float

    @property
    def path_W_K(self) -> float:
        return self.conduction / self.rise_K

    @property
    def body_W_K(self) -> float:
        return self.body / self.rise_K

    def against(self, other: "BaseHeat") -> str:
        """How it differs, by mechanism."""
        return ", ".join(
            f"{name} {getattr(self, name):.0f} instead of {getattr(other, name):.0f} W"
            for name in ("conduction", "convection", "radiation")
        )


def base_heat(network: Network, test: Test, values: Mapping[str, float]) -> BaseHeat:
    """What the bases of a network carry off at the end of a test."""
    bare, heat = heat_model(network, values)
    run = record(test, {})
    flows = balance(bare, run, heat)
    core = simulate(bare, run, heat, [bare.places[BODY].mean]).y[-1, 0]
    feet = [x for x in bare.links if isinstance(x.law, Switched) and x.law.closed]
    air = str(ambient(bare))
    outside = [x for x in bare.links if x.places[1] == air]
    below = [x for x in outside if (role(bare, part_of(bare, x.places[0])) in (Role.FOOT, Role.BASE))]
    return BaseHeat(
        sum(_out_of_body(bare, flows, x) for x in feet),
        _sum(flows, [x for x in below if not isinstance(x.law.temperature, Radiation)]),
        _sum(flows, [x for x in below if isinstance(x.law.temperature, Radiation)]),
        _sum(flows, [x for x in outside if x not in below]),
        float(core - np.ravel(test.boundaries[air])[-1]),
    )


def _out_of_body(network: Network, flows: Balance, foot: Link) -> float:
    sign = -1.0 if role(network, foot.places[0]) is Role.FOOT else 1.0
    return sign * float(flows.power(foot.name)[-1])


def _sum(flows: Balance, links: list[Link]) -> float:
    return float(sum(flows.power(link.name)[-1] for link in links))
