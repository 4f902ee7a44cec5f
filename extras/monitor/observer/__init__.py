"""Temperatures and missing heat while a machine runs, from the sensors at hand, and where the model fails."""

from extras.monitor.observer.observer import Observer, Sample, observer
from extras.monitor.observer.process_noise import ProcessNoise

__all__ = ["Observer", "ProcessNoise", "Sample", "observer"]
