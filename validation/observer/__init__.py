"""Temperatures and missing heat while a machine runs, from the sensors at hand, and where the model fails."""

from validation.observer.observer import Observer, Sample, observer
from validation.observer.process_noise import ProcessNoise

__all__ = ["Observer", "ProcessNoise", "Sample", "observer"]
