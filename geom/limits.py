"""What a file may ask of the machine that reads it: one table, looked at before anything of that size is kept.

A limit stands far above what people measure and far below what a computer of 8 GB cannot hold. Who has more raises it
by its environment variable.
"""

import os
import time
from dataclasses import dataclass

from geom.errors import InputError


@dataclass(frozen=True)
class Limit:
    """At most `usual` of a `unit`, or what the environment says instead.  why : what it bounds, and why this number"""

    name: str
    usual: int
    unit: str
    why: str

    @property
    def variable(self) -> str:
        """The name of its environment variable."""
        return f"THERMOSCOPE_MOST_{self.name.upper()}"

    @property
    def most(self) -> int:
        """What holds now."""
        text = os.environ.get(self.variable, str(self.usual)).replace("_", "")
        if not text.isdecimal() or not int(text):
            raise InputError(f"{text!r} is not a limit", self.variable, f"a whole number of {self.unit}, at least 1")
        return int(text)

    def check(self, amount: float, where: object, what: str = "asks for") -> None:
        """InputError where an amount is beyond; it says which limit, and how to raise it."""
        if amount > self.most:
            cure = f"the limit '{self.name}', raised by {self.variable}={self.most * 10}"
            right = f"at most {self.most:,} {self.unit}: {cure}"
            raise InputError(f"{what} {amount:,.0f} {self.unit}", str(where), right)


BYTES = Limit("bytes", 2**29, "bytes", "of a recording in memory: a day of 50 channels at 1 Hz is a tenth of that")
ROWS = Limit("rows", 5_000_000, "rows", "of a recording, empty ones counted: 50 days at 1 Hz, an hour at 1 kHz")
COLUMNS = Limit("columns", 10_000, "columns", "of a recording: the largest loggers have some hundreds")
CELLS = Limit("cells", 50_000_000, "cells", "of a recording, rows times columns: 400 MB as numbers")
SECONDS = Limit("seconds", 300, "seconds", "to read one recording or STEP file: 512 MB of text take about one minute")
INSTANTS = Limit("instants", 2_000_000, "instants", "at which a test is compared: more would not fit with tangents")
DROP_BYTES = Limit("drop_bytes", 2**30, "bytes", "of one drop on the workbench: an hour at 1 kHz in text, twice over")
TOML_BYTES = Limit("toml_bytes", 2**24, "bytes", "of a file in TOML: written by hand, or by us, it is far smaller")
PART_BYTES = Limit("part_bytes", 2**24, "bytes", "of the styles of a workbook, which are kept whole: most have 0.1 MB")
MACHINE_BYTES = Limit("machine_bytes", 2**24, "bytes", "of a machine file of another program: most have half a MB")
STEP_BYTES = Limit("step_bytes", 2**27, "bytes", "of a STEP file: a machine with all its screws is a third of that")
MESH_POINTS = Limit("mesh_points", 400_000, "points", "of a mesh: to condense a machine of 338,000 takes 12 GB")
CACHE_BYTES = Limit("cache_bytes", 2_000_000_000, "bytes", "of all cached results: some ten machines, meshes and all")
LIMITS = tuple(limit for limit in list(globals().values()) if isinstance(limit, Limit))


class ReadingTime:
    """How long a file has been read.  where : the file"""

    def __init__(self, where: object) -> None:
        self.where, self.begin = where, time.monotonic()

    def check(self) -> None:
        """InputError where it takes too long."""
        SECONDS.check(time.monotonic() - self.begin, self.where, "was read for")
