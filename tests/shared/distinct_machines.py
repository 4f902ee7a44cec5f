"""Machines of the library that are meshed in another way each: what is left out has the same parts in other lengths."""

from geom import library

ALIKE = {"pmsm-m2-no-base", "pmsm-m2-plate", "pmsm-m3-no-base", "pmsm-m3-plate"}  # on the bases of M1, which are there
DISTINCT = [name for name in library() if name not in ALIKE]
