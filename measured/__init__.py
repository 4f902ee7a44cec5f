"""What was measured: recordings, sheets, sensors, and the cases that hold them. No model is run here.

Names are loaded when they are used: a command pays for nothing else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from measured.case import AddedEffect as AddedEffect, Case as Case, Channel as Channel, Model as Model, Test as Test
    from measured.recordings.formats import read_recording as read_recording
    from measured.recordings.sheet import load_sheet as load_sheet

__getattr__, __dir__ = loaded_when_used(__name__, __file__)
