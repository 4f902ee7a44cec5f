"""Temperatures and missing heat while a machine runs, from the sensors at hand, and where the model fails."""

from extras.monitor.observer.kalman import ProcessNoise
from extras.monitor.observer.observer import Observer, Sample, observer

__all__ = ["Observer", "ProcessNoise", "Sample", "observer"]
