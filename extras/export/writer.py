"""What other extras need to write a network in C: entry point "c" of the group "thermoscope.code"."""

from extras.export.c_code import c_files, ints, joined, reals
from extras.export.model import Model, Output, outputs, packed

__all__ = ["Model", "Output", "c_files", "ints", "joined", "outputs", "packed", "reals"]
