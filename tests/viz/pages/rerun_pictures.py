"""A recording in rerun's own hands: checked by its tool, and pictures by its viewer without a window."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from geom.errors import InputError, MissingDependency

if TYPE_CHECKING:
    from rerun.experimental import ViewerClient

COMMAND = "apt-get install -y libvulkan1 mesa-vulkan-drivers"
TRIES = 4  # the viewer gives up on a picture after 15 s, which a busy computer may need to draw it
START_S = 60.0  # a viewer that needs more does not start
WARM_UPS, LOAD_S = 3, 1.0  # a plot finds its scale, and its lines, only after it was drawn once; the last picture stays


def snapshots(recording: str | Path, pictures: Mapping[str | Path, tuple[str, float]]) -> list[Path]:
    """Write PNG pictures of the whole viewer: path -> (timeline, seconds, or the number on `revision`)."""
    paths = []
    with _viewer() as viewer:
        viewer.open(str(Path(recording).resolve()))
        for png, (timeline, at) in pictures.items():
            path = Path(png).resolve()
            path.parent.mkdir(parents=True, exist_ok=True)
            if timeline == "revision":
                viewer.set_time(timeline, sequence=int(at), play_state="paused")
            else:
                viewer.set_time(timeline, duration=float(at), play_state="paused")
            for _ in range(WARM_UPS):
                _patiently(lambda path=path: viewer.save_screenshot(str(path)))  # type: ignore[misc]
                time.sleep(LOAD_S)
            paths.append(path)
    return paths


def _patiently(act: Callable[[], None]) -> None:
    for last in (False,) * (TRIES - 1) + (True,):
        try:
            return act()
        except TimeoutError:
            if last:
                raise


@contextmanager
def program() -> Iterator[tuple[str, dict[str, str]]]:
    """The rerun program, and an environment with a home of its own in which its usage statistics are off."""
    found = shutil.which("rerun", path=str(Path(sys.executable).parent)) or shutil.which("rerun")
    if found is None:
        raise MissingDependency("the rerun program is missing; install it with: uv pip install rerun-sdk")
    with TemporaryDirectory() as home:
        alone = {**os.environ, "HOME": home, "XDG_CONFIG_HOME": home, "XDG_RUNTIME_DIR": home}
        subprocess.run([found, "analytics", "disable"], env=alone, capture_output=True, check=False)
        yield found, alone


@contextmanager
def _viewer() -> "Iterator[ViewerClient]":
    """A viewer that listens to this computer only, on a free port; ended afterwards."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with program() as (found, alone):
        command = [found, "--headless", "--bind", "127.0.0.1", "--port", str(port), "--hide-welcome-screen"]
        null, vulkan = subprocess.DEVNULL, {"WGPU_BACKEND": "vulkan", **alone}
        process = subprocess.Popen(command, env=vulkan, stdout=null, stderr=null, start_new_session=True)
        try:
            yield _connected(process, port)
        finally:
            # The program is a script that starts the viewer: both are ended
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGTERM)
            process.wait(timeout=30)


def _connected(process: subprocess.Popen, port: int) -> "ViewerClient":
    """Wait until the viewer listens."""
    from rerun.experimental import ViewerClient

    end = time.monotonic() + START_S
    while time.monotonic() < end and process.poll() is None:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy")
        time.sleep(0.2)
    raise MissingDependency(f"the rerun viewer cannot draw here; a software Vulkan helps: {COMMAND}")


def printed(path: str | Path, detail: str) -> str:
    """What a recording holds, as rerun's own tool prints it.  detail : -v to -vvv"""
    with program() as (found, alone):
        command = [found, "rrd", "print", detail, str(path)]
        return subprocess.run(command, env=alone, capture_output=True, text=True, check=True).stdout


def verify(path: str | Path) -> None:
    """Check a recording with rerun's own tool."""
    with program() as (found, alone):
        done = subprocess.run([found, "rrd", "verify", str(path)], env=alone, capture_output=True, text=True)
    if done.returncode:
        raise InputError(
            f"not a valid recording: {done.stderr.strip()[-300:]}", str(path), "a file written by this version"
        )
