"""What is kept between commands, and where."""

from __future__ import annotations

import os
from pathlib import Path


def cache_folder() -> Path:
    """Where meshes and bases are kept: $THERMOSCOPE_CACHE, else a folder of the user's."""
    home = os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache"))
    return Path(os.environ.get("THERMOSCOPE_CACHE", Path(home) / "thermoscope"))
