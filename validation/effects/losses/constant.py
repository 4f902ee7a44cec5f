"""Heat that flows in whatever the machine does."""

from dataclasses import dataclass

from lumped.model.sites import outside
from validation.effects.base import Scene
from validation.effects.losses.added_loss import AddedLoss


@dataclass(frozen=True)
class ConstantLoss(AddedLoss):
    """P = a, a constant power (W): a heater, the sun, a neighbour, electronics on standby."""

    kind = "loss.constant"
    title = "constant heat input"
    sits = "an outer part or face"
    source = "heat balance"
    isolating_test = "record with everything switched off"
    typical = (1.0, 100.0)
    confused_with = ("ambient.offset", "sensor.bias")
    heats = "extra"

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return outside(scene.network)
