"""The server of the workbench: one port, one process, a session per tab."""

import asyncio
import os
import secrets
import signal
from collections.abc import AsyncIterator, Callable
from contextlib import suppress

from aiohttp import web

from extras.workbench.access_control import AccessControl
from extras.workbench.appearance import appearance_of
from extras.workbench.jobs import FailedError, StoppedError, prepare
from extras.workbench.machines import Bench, Machines
from extras.workbench.steps import comparing_job, drawing_job
from extras.workbench.tabs import Tabs
from thermoscope import InputError, plugin as th

SWEEP_S = 30.0  # between looks for idle tabs
SHORTEST = 16  # characters: 64 bits where they are hexadecimal


def token_for(token: str | None) -> str:
    """What a browser must show: the given token or a new one. Other users and programs share this computer's ports."""
    if token is not None and len(token) < SHORTEST:
        raise InputError(f"the token has {len(token)} characters", "THERMOSCOPE_TOKEN", f"at least {SHORTEST}")
    return token or secrets.token_urlsafe(24)


def application(folder: th.Folder, access: AccessControl, largest_drop: int = th.DROP_BYTES.most) -> web.Application:
    """The pages of a case, for those who have access; model and machine are prepared once it is served.

    largest_drop : of files dropped on a page (bytes)
    """
    os.environ["TRAME_ARGS"] = "--server"  # trame would read our command line as its own
    prepare()
    parts = th.stored_documents(folder)
    documents = [] if parts is None else [(folder.history, {k: v for part in parts for k, v in part.items()})]
    opened = Bench(folder, None if folder.stored is None else appearance_of(folder), Machines(documents))
    tabs = Tabs(opened, largest_drop)
    app = web.Application(middlewares=[access.middleware])
    app.router.add_get("/", tabs.new)
    app.router.add_get("/tab/{tab}/{name:.+}", tabs.fetch)
    app.router.add_post("/tab/{tab}/paraview/", tabs.address)
    app.router.add_post("/tab/{tab}/recordings", tabs.receive)

    async def sweeping(_: web.Application) -> AsyncIterator[None]:
        first = asyncio.create_task(_prepared(opened))

        async def sweep() -> None:
            while True:
                await asyncio.sleep(SWEEP_S)
                await tabs.sweep()

        task = asyncio.create_task(sweep())
        yield
        task.cancel()
        await tabs.close()
        opened.stop()
        await asyncio.gather(first, return_exceptions=True)

    app.cleanup_ctx.append(sweeping)
    return app


async def _prepared(opened: Bench) -> None:
    """Before anyone asks: the machine is drawn and the model compared, each beside the other."""
    if opened.folder.built is not None and opened.machines.find(opened.folder.history) is None:
        opened.machines.drawing(opened.folder, drawing_job)
    with suppress(FailedError, StoppedError):  # every tab that waits is told
        await opened.compared(comparing_job)


def serve_until_stopped(app: web.Application, access: AccessControl, port: int, ready: Callable[[str], None]) -> None:
    """Serve until Ctrl-C; `ready` gets the address to open once it can be opened."""
    asyncio.run(_serve(app, access, port, ready))


async def _serve(app: web.Application, access: AccessControl, port: int, ready: Callable[[str], None]) -> None:
    end, runner = asyncio.Event(), web.AppRunner(app, shutdown_timeout=2.0)
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, end.set)
    await runner.setup()
    try:
        await _listening(runner, access.host, port)
        name = f"[{access.host}]" if ":" in access.host else access.host
        ready(f"http://{name}:{runner.addresses[0][1]}/" + (f"?token={access.token}" if access.token else ""))
        await end.wait()
    finally:
        await runner.cleanup()


async def _listening(runner: web.AppRunner, host: str, port: int) -> None:
    """Open the port; InputError for a name that is none of this computer's, and for a port that is taken."""
    try:
        await web.TCPSite(runner, host, port).start()
    except OSError as fault:
        right = "--host 127.0.0.1, or a name of this computer; --port 0 takes a free port"
        raise InputError(
            f"cannot listen there: {fault.strerror or fault}", f"--host {host} --port {port}", right
        ) from None
