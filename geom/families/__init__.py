"""Families of machines: each turns its parameters into named prismatic parts."""

from __future__ import annotations

from geom.families.family import Family
from geom.plugins import plugins


def families() -> dict[str, Family]:
    """All families by name, those of other packages too (entry points "thermoscope.families")."""
    from geom.families import radial_flux, series_dc

    builtin = (series_dc.FAMILY, radial_flux.PMSM, radial_flux.TEFC)
    return {family.name: family for family in (*builtin, *plugins("families").values())}
