"""How sure a predicted temperature is, at sensors and at places without one."""

from validation.bands.band import Bands, Place, bands
from validation.bands.posterior import Belief, belief

__all__ = ["Bands", "Belief", "Place", "bands", "belief"]
