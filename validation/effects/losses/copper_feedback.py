"""Copper that heats more when it is hot."""

from geom.constants import ALPHA_CU
from lumped.model.network import Network, Source
from lumped.model.sites import windings
from lumped.sources.loss_laws import EDDY
from lumped.transfer.laws import CONSTANT, Linear, Scaled, WithTemperature
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import copy_element, label

REFERENCE = 20.0  # degC, of losses that name no temperature at which they hold
UNSAID = ("constant", "stray")  # kinds that say nothing of how a loss comes about: in a winding it is copper's


class CopperFeedback(Effect):
    """Missing temperature feedback of a copper loss: P = P0 (1 + a (T - T0)), a in 1/K.

    T0 is the temperature at which the loss was declared, 20 degC where it says none. Losses that one parameter moves
    are one winding: their copper is of one kind, so that the first of them stands for all.
    """

    kind = "copper.feedback"
    title = "copper resistance rises with its temperature"
    sits = "a copper loss that follows a temperature, or says its reference"
    unit = "1/K"
    source = "IEC 60034-1: copper, 0.00393 1/K at 20 degC"
    isolating_test = "log the winding resistance during a constant-current run"
    typical = (0.0035, 0.0042)
    prior_sd = ALPHA_CU
    of_material = True
    high = 0.0125  # 1/K: above, the loss would be negative below -60 degC
    confused_with = ("copper.ac", "loss.winding")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [label(s) for s in _constant_copper(scene.network) if _winding(scene.network, s.name)[0] == s.name]

    def extend(self, network: Network) -> Network:
        mine, names = {s.name: s for s in network.sources}, []
        place = next(s.name for s in network.sources if label(s) == self.place)
        for source in (mine[n] for n in _winding(network, place)):
            reference, end = _reference(source) or REFERENCE, "" if source.name == place else f":{source.name}"
            # Eddy currents fall as the resistance rises: to first order in a, what is copied turns its sign.
            eddy = [(s, -1.0, f"{end}{EDDY}") for s in [mine.get(f"{source.name}{EDDY}")] if s is not None]
            for part, sign, tail in [(source, 1.0, end), *eddy]:
                names += [f"{self.name}:rise{tail}", f"{self.name}:base{tail}"]
                law = WithTemperature(Scaled(part.law, sign), Linear(1.0, reference))
                network = copy_element(network, part, names[-2], law)
                network = copy_element(network, part, names[-1], WithTemperature(Scaled(part.law, -sign)))
        return with_parameter(network, self.parameter(*names))


def _constant_copper(network: Network) -> list[Source]:
    """Declared copper losses that do not follow their temperature."""
    wound = set(windings(network))
    sources = [s for s in network.sources if not s.origin and not s.name.endswith(EDDY)]
    return [s for s in sources if _copper(s, wound) and _reference(s) is not None]


def _winding(network: Network, name: str) -> list[str]:
    """The copper losses that one parameter moves with this one; itself where none does."""
    targets = next(({t for t, _ in p.targets} for p in network.parameters if name in {t for t, _ in p.targets}), {name})
    return [s.name for s in _constant_copper(network) if s.name in targets] or [name]


def _copper(source: Source, wound: set[str]) -> bool:
    return source.kind == "copper" or (source.kind in UNSAID and source.place in wound)


def _reference(source: Source) -> float | None:
    """Where the loss holds as declared (degC); None if it follows its temperature already."""
    law = source.law.temperature
    if isinstance(law, Linear):
        return law.reference if law.alpha == 0.0 else None
    return REFERENCE if law == CONSTANT else None
