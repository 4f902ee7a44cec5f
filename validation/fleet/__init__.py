"""Many motors that should be equal: what differs between them, what drifts, and which one stands out."""

from validation.fleet.population import Population, population
from validation.fleet.unit import Statistics, UnitHistory, statistics

__all__ = ["Population", "Statistics", "UnitHistory", "population", "statistics"]
