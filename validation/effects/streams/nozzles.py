"""Oil nozzles that are blocked."""

from lumped.model.network import Link, Network
from lumped.model.sites import part_of, standing_links
from lumped.transfer.laws import Wrapped
from lumped.transfer.streamed import Streamed
from validation.effects.base import Scene
from validation.effects.films.fouling import Blockage

SPRAYED = "sprayed_face"  # the correlation of a face under nozzles


def sprayed(network: Network) -> list[Link]:
    """Films of faces under nozzles."""
    return [link for link in standing_links(network) if _sprayed(link)]


def _sprayed(link: Link) -> bool:
    law = link.law
    while isinstance(law, Wrapped):
        law = law.base
    return isinstance(law, Streamed) and law.table.domain is not None and law.table.domain.what.startswith(SPRAYED)


def inlet(network: Network, link: Link) -> str:
    """What feeds the oil of a film: the first of the stream through it, or a boundary itself."""
    oil = link.places[1]
    if oil in network.boundaries:
        return oil
    streams = (x for x in standing_links(network) if x.kind == "stream" and network.column(oil) in x.rows)
    return next((x.places[0] for x in streams), oil)


class NozzleBlockage(Blockage):
    """A share of the nozzles above a part gives no oil: h = h0 (1 + a), -1 <= a <= 0; the others keep theirs."""

    kind = "nozzles"
    title = "oil nozzles are blocked"
    sits = "a part under oil nozzles"
    source = "definition: every nozzle wets a share of the face; -1 is a face that no oil reaches"
    isolating_test = "measure the flow of each nozzle; run with the flow doubled"
    typical = (-0.5, -0.1)
    low = -1.0
    confused_with = ("flow", "loss.winding")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return list(dict.fromkeys(part_of(scene.network, link.places[0]) for link in sprayed(scene.network)))

    def links(self, network: Network) -> list[Link]:
        return [link for link in sprayed(network) if part_of(network, link.places[0]) == self.place]


class AllNozzles(NozzleBlockage):
    """The same share of all nozzles that are fed together gives no oil: a clogged filter, a rail without pressure."""

    kind = "nozzles.all"
    title = "oil nozzles of all parts are blocked"
    sits = "a boundary or node that feeds the oil nozzles of more than one part"
    isolating_test = "read the pressure before and after the filter; measure the flow"
    confused_with = ("nozzles", "flow")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        network = scene.network
        pairs = [(inlet(network, link), part_of(network, link.places[0])) for link in sprayed(network)]
        return [first for first in dict.fromkeys(x for x, _ in pairs) if len({p for x, p in pairs if x == first}) > 1]

    def links(self, network: Network) -> list[Link]:
        return [link for link in sprayed(network) if inlet(network, link) == self.place]
