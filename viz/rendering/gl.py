"""Can this computer draw off-screen? Asked in a subprocess: VTK without a GL library dies with a segmentation fault."""

import os
import subprocess
import sys
from functools import lru_cache

from geom.errors import MissingDependency

COMMAND = "apt-get install -y libegl1 libgl1-mesa-dri libgl1 libxrender1"
_WINDOWS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow", "vtkXOpenGLRenderWindow")
_DRAW = """
from vtkmodules.vtkRenderingCore import vtkRenderWindow
import vtkmodules.vtkRenderingOpenGL2
w = vtkRenderWindow(); w.SetOffScreenRendering(1); w.SetSize(8, 8); w.Render(); print('window', w.GetClassName())
"""


@lru_cache(maxsize=1)
def off_screen_window() -> str | None:
    """Class name of the first VTK window that draws off-screen here, or None. About 0.6 s, once per process."""
    preference = os.environ.get("VTK_DEFAULT_OPENGL_WINDOW")
    return next((name for name in ([preference] if preference else _WINDOWS) if _draws(name)), None)


def require_gl() -> None:
    """Make VTK draw off-screen, or raise MissingDependency with the command that installs what is missing."""
    window = off_screen_window()
    if window is None:
        raise MissingDependency(f"no off-screen OpenGL (EGL or OSMesa) for pictures; install it with: {COMMAND}")
    os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = window


def _draws(window: str) -> bool:
    environment = {**os.environ, "VTK_DEFAULT_OPENGL_WINDOW": window}
    try:
        command = [sys.executable, "-P", "-c", _DRAW]
        process = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return process.returncode == 0 and window in process.stdout
