"""A joint worse than assumed."""

from lumped.model.network import Link, Network
from lumped.model.sites import across_gap, model_links, solids
from lumped.transfer.laws import CONSTANT
from validation.effects.base import Scene, WeakLinks
from validation.effects.build import label


def joints(network: Network) -> list[Link]:
    """Contacts, and hand-declared links between two solids whose conductance follows nothing: a film is not a joint."""
    inner = [link for link in model_links(network) if not set(link.places) & set(network.boundaries)]
    return [link for link in inner if link.kind == "contact" or (link.kind == "link" and _solid(network, link))]


def _solid(network: Network, link: Link) -> bool:
    """A shaft's link, bearing and all, is solid; what lies between parts of the field, one of which turns, is air."""
    follows = bool(link.law.reads) or link.law.temperature is not CONSTANT
    return (
        not follows and not across_gap(network, *link.places) and set(link.places) <= {p.name for p in solids(network)}
    )


class ContactResistance(WeakLinks):
    """A contact, fit or liner that conducts less than assumed: g = g0 (1 + a), -0.95 <= a <= 0."""

    kind = "contact"
    title = "contact resistance larger than assumed"
    sits = "a contact between two parts"
    source = "interface gap, R = gap / k_air (Motor-CAD default gaps, Staton 2005)"
    isolating_test = "DC heating at standstill with sensors on both sides of the joint"
    typical = (-0.8, -0.2)
    prior_sd = 0.4
    confused_with = ("contact", "loss.winding", "mass")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [label(link) for link in joints(scene.network)]

    def links(self, network: Network) -> list[Link]:
        return [link for link in joints(network) if label(link) == self.place]
