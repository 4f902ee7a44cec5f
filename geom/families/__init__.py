"""Families of machines: each turns its parameters into named prismatic parts."""

from __future__ import annotations

from geom.families.family import Family


def families() -> dict[str, Family]:
    """All families by name."""
    from geom.families import radial_flux, series_dc

    return {family.name: family for family in (series_dc.FAMILY, radial_flux.PMSM, radial_flux.TEFC)}
