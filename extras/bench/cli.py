"""The commands of this extra; none is loaded until it runs."""

from thermoscope import plugin as th

WORDS = "The published test procedure, from resistances to screened models."
NAMES = "protocol,protocol.report,curves,law,bases,screen,screen.two-paths,screen.carry,live"
commands = th.CommandGroup("bench", f"{__package__}.commands", NAMES, WORDS)
