"""Many motors that should be equal: what differs between them, what drifts, and which one stands out."""

from extras.monitor.fleet.population import Population, population
from extras.monitor.fleet.unit import Statistics, UnitHistory, statistics

__all__ = ["Population", "Statistics", "UnitHistory", "population", "statistics"]
