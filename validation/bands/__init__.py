"""How sure a predicted temperature is, at sensors and at places without one."""

from validation.bands.band import Bands, Place, at_end, band_stretches, bands
from validation.bands.posterior import ParameterPosterior, parameter_posterior

__all__ = ["Bands", "ParameterPosterior", "Place", "at_end", "band_stretches", "bands", "parameter_posterior"]
