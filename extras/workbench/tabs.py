"""One session per tab: made when a browser comes without one, ended when none has been connected for a while."""

import asyncio
import base64
import hashlib
import re
import secrets
import shutil
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from aiohttp import WSMsgType, web
from aiohttp.http_exceptions import HttpProcessingError

from extras.workbench.access_control import served
from extras.workbench.dropped import DROP_PREFIX, stored
from extras.workbench.machines import Bench
from extras.workbench.session import Session, started
from thermoscope import plugin as th

MOST = 8  # tabs, each with a server of its own
IDLE_S = 900.0  # a tab that is left alone so long is closed

INLINE = re.compile(rb"<script>(.*?)</script>", re.S)


def _named(script: bytes) -> str:
    """A script as a policy names it."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode()}'"


@cache
def hashes(page: Path) -> str:
    """The scripts inside a page."""
    return " ".join(_named(script) for script in INLINE.findall(page.read_bytes()))


@cache
def _page_policy(*further: str) -> str:
    """Of a page that runs no script but the viewer's."""
    first = ["default-src 'none'", f"script-src {_named(th.script().encode())}", "style-src 'unsafe-inline'"]
    return "; ".join([*first, "base-uri 'none'", "form-action 'none'", *further])


def report_policy() -> str:
    """Of the report, which runs the viewer in a frame of its own."""
    return _page_policy("img-src 'self' data:", "font-src data:", "frame-ancestors 'none'")


def policy(page: Path, host: str) -> str:
    """Of a page of trame: its own scripts and socket. 'unsafe-eval': Vue compiles its templates in the browser."""
    return "; ".join(
        [
            "default-src 'none'",
            f"script-src 'self' 'unsafe-eval' {hashes(page)}",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src 'self' data:",
            f"connect-src 'self' blob: ws://{host} wss://{host}",
            "worker-src 'self' blob:",
            "manifest-src 'self'",
            "base-uri 'self'",
            "form-action 'none'",
            "object-src 'none'",
            "frame-src 'self'",
            "frame-ancestors 'none'",
        ]
    )


class Tab:
    """A session behind a trame server of its own, reached through this process's one port."""

    def __init__(self, bench: Bench, name: str, turn_to: Callable[[Bench], None]) -> None:
        from trame.app import get_server

        from extras.workbench.page import draw

        self.name, self.connected, self.left = name, 0, time.monotonic()
        server: Any = get_server(name, client_type="vue3")
        self.session = Session(bench, server, turn_to)
        draw(self.session)
        self._server = server
        quiet = {"show_connection_info": False, "open_browser": False, "disable_logging": True}
        self._task = server.start(backend="generic", exec_mode="task", timeout=0, **quiet)
        self.session.open()
        started(self.session.watch_bench())
        self.folders = {"": Path(server._www), **{k: Path(v) for k, v in server.serve.items()}}

    async def talk(self, socket: web.WebSocketResponse) -> None:
        """Carry messages between a browser and the session until it leaves."""
        link = await self._server._server["ws"].connect()

        async def to_browser(binary: bool, message: Any) -> None:
            with suppress(ConnectionError):  # the browser may leave at any moment
                await (socket.send_bytes(message) if binary else socket.send_str(message))

        link.on_message(to_browser)
        self.connected += 1
        try:
            async for message in socket:
                if message.type in (WSMsgType.BINARY, WSMsgType.TEXT):
                    await link.send(message.type == WSMsgType.BINARY, message)
        finally:
            self.connected -= 1
            self.left = time.monotonic()
            await self._server._server["ws"].disconnect(link)

    async def close(self) -> None:
        self.session.close()
        await self._server.stop()
        await asyncio.gather(self._task, return_exceptions=True)


class Tabs:
    """All tabs of one server.  largest_drop : of files dropped on a page (bytes)"""

    def __init__(self, bench: Bench, largest_drop: int) -> None:
        self.bench, self.largest_drop = bench, largest_drop
        self.open: dict[str, Tab] = {}

    async def new(self, request: web.Request) -> web.StreamResponse:
        """A session of its own for a browser tab that comes without one."""
        raise web.HTTPFound(f"/tab/{await self._opened()}/index.html")

    async def _opened(self) -> str:
        """The name of a new session."""
        if len(self.open) >= MOST:
            await self.sweep(0.0)
        if len(self.open) >= MOST:
            raise web.HTTPServiceUnavailable(text=f"{MOST} tabs are open; close one and try again in a minute")
        name = secrets.token_hex(12)  # the browser side of trame writes addresses in small letters
        self.open[name] = Tab(self.bench, name, self.turn_to)
        return name

    async def fetch(self, request: web.Request) -> web.StreamResponse:
        """The page's own files, the socket, and the report; an unknown tab starts a new one."""
        tab, name = self.open.get(request.match_info["tab"]), request.match_info["name"]
        if tab is None:
            raise web.HTTPFound("/") if name == "index.html" else web.HTTPNotFound()
        if name == "ws":
            socket = web.WebSocketResponse(max_msg_size=16 * 2**20, heartbeat=30, compress=False)
            await socket.prepare(request)
            await tab.talk(socket)
            return socket
        if name == "viewer.html":
            headers = {"Content-Security-Policy": _page_policy("frame-ancestors 'self'")}
            return web.Response(text=tab.session.viewer_page, content_type="text/html", headers=headers)
        if name == "viewer-rest.json":
            return web.json_response(tab.session.viewer_rest)
        if name == "report.html":
            path: Path | None = tab.session.bench.folder.settings.out / "report.html"
        else:
            path = served(tab.folders, name)
        if path is None or not path.is_file():
            raise web.HTTPNotFound()
        headers = {}
        if path.suffix == ".html":
            headers["Content-Security-Policy"] = (
                report_policy() if name == "report.html" else policy(path, request.host)
            )
        return web.FileResponse(path, headers=headers)

    def turn_to(self, bench: Bench) -> None:
        """The case that new tabs open from now on; those that are open keep theirs."""
        self.bench = bench

    async def receive(self, request: web.Request) -> web.Response:
        """Recordings dropped on a page; the page's state says what became of them."""
        tab = self.open.get(request.match_info["tab"])
        if tab is None or not request.content_type.startswith("multipart/"):
            raise web.HTTPNotFound()
        folder = Path(tempfile.mkdtemp(prefix=DROP_PREFIX))
        try:
            try:
                files = await stored(await request.multipart(), folder, self.largest_drop)
            except (HttpProcessingError, ValueError) as fault:  # such as a zero byte in a name
                raise web.HTTPBadRequest(text="not readable as an upload of files") from fault
            if files:
                await tab.session.take_in(files)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        return web.Response(status=204)

    async def address(self, request: web.Request) -> web.Response:
        """Where the page finds its session, which trame's browser side asks for first.

        A browser that duplicates a tab copies its address: the copy gets a session of its own.
        """
        scheme, tab = "wss" if request.secure else "ws", request.match_info["tab"]
        if tab in self.open and self.open[tab].connected:
            tab = await self._opened()
        return web.json_response({"sessionURL": f"{scheme}://{request.host}/tab/{tab}/ws", "secret": "wslink-secret"})

    async def sweep(self, idle_s: float = IDLE_S) -> None:
        """End the sessions that nobody has looked at for `idle_s` and that calculate nothing."""
        now = time.monotonic()
        for name, tab in list(self.open.items()):
            if not tab.connected and not tab.session.calculates and now - tab.left > idle_s:
                await self.open.pop(name).close()

    async def close(self) -> None:
        for name in list(self.open):
            await self.open.pop(name).close()
