"""The commands of this extra; none is loaded until it runs."""

from thermoscope import plugin as th

use_commands = th.CommandGroup("use", f"{__package__}.commands", "export")
