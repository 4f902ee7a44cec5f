"""From prisms to a named tetrahedral mesh."""
