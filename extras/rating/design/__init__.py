"""From a case or a machine file to a design problem, and from its Pareto set back to machine files."""
