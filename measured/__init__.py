"""What was measured: recordings, sheets, sensors, and the cases that hold them. No model is run here.

Names are loaded when they are used: a command pays for nothing else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from measured.case import AddedEffect, Case, Channel, Model, Test
    from measured.recordings.formats import read_recording
    from measured.recordings.sheet import load_sheet

_HOME = {
    "AddedEffect": "measured.case",
    "Case": "measured.case",
    "Channel": "measured.case",
    "Model": "measured.case",
    "Test": "measured.case",
    "load_sheet": "measured.recordings.sheet",
    "read_recording": "measured.recordings.formats",
}
__all__ = ["AddedEffect", "Case", "Channel", "Model", "Test", "load_sheet", "read_recording"]
__getattr__, __dir__ = loaded_when_used(__name__, _HOME)
