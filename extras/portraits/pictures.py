"""Pictures of a machine as it looks: thermoscope show picture CASE machine, or temperature instead of machine."""

from pathlib import Path

from thermoscope import plugin as th


def machine_picture(s: th.Subject, png: Path) -> None:
    """The machine cut open."""
    from extras.portraits.portrait import portrait

    s.require_drawing()
    portrait(s.built.machine, title=s.built.machine.name, png=png).close()


def temperature_picture(s: th.Subject, png: Path) -> None:
    """The same, coloured by temperature at the end of the most telling test."""
    from extras.portraits.portrait import portrait

    s.require_drawing()
    title = f"{s.when}: temperature of the model"
    portrait(s.built.machine, nodes=s.nodes, T=s.field(), title=title, limits=s.limits, png=png).close()
