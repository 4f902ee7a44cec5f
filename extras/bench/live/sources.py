"""Where rows come from and set points go to: a file, a pipe, a TCP line, or topics of an MQTT broker.

Every line is a row: cells under the header of the first line, or a JSON object. A set point goes out as one JSON line.
"""

import asyncio
import json
import math
import queue
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError
from functools import partial
from pathlib import Path
from typing import IO, Any
from urllib.parse import urlsplit

from extras.bench.live.store import BenchError, Row
from thermoscope import InputError, plugin as th

POLL_S = 0.2  # between two looks at a file that grows
BYTES = 2**20  # of a line: more is not a row
TOPIC = "thermoscope"  # TOPIC/rows comes, TOPIC/set goes
Line = str | Exception


class Source:
    """Lines as they come, read by a thread of its own.  send : None where set points cannot go the same way"""

    def __init__(self, where: str) -> None:
        self.where, self.lines = where, queue.Queue[Line | None]()
        self.send: Callable[[str], None] | None = None

    def start(self, read: Callable[[], Iterator[str]]) -> None:
        threading.Thread(target=self._read, args=[read], daemon=True).start()

    def _read(self, read: Callable[[], Iterator[str]]) -> None:
        try:
            for line in read():
                self.lines.put(line)
            self.lines.put(None)
        except (OSError, ValueError) as fault:
            self.lines.put(fault)

    def line(self, timeout: float) -> str | None:
        """The next line, None at the end. queue.Empty where none comes in time, BenchError where the line is broken."""
        got = self.lines.get(timeout=timeout)
        if isinstance(got, Exception):
            raise BenchError(f"is gone: {got}", self.where, "a line that lasts; the rows so far are kept")
        return got

    def set(self, set_point: Mapping[str, float]) -> None:
        if self.send is not None:
            self.send(json.dumps({"set": dict(set_point)}))


def source_of(follow: str) -> Source:
    """tcp://HOST:PORT, mqtt://HOST[:PORT][/TOPIC], - for a pipe, else a file that may still grow."""
    address = urlsplit(follow)
    if address.scheme == "tcp":
        return _tcp(follow, address.hostname or "", address.port or 0)
    if address.scheme == "mqtt":
        return _mqtt(follow, address.hostname or "", address.port or 1883, address.path.strip("/") or TOPIC)
    source = Source(follow)
    if follow == "-":
        source.send = partial(print, flush=True)
        source.start(lambda: iter(sys.stdin.readline, ""))
        return source
    file = Path(follow)
    if not file.is_file():
        raise InputError("no such file", follow, "a recording, - for a pipe, tcp://HOST:PORT, or mqtt://HOST")
    source.start(lambda: _growing(file))
    return source


def _growing(file: Path) -> Iterator[str]:
    with file.open(encoding="utf-8", newline="") as stream:
        line = ""
        while True:
            line += stream.readline(BYTES)
            if line.endswith("\n"):
                yield line
                line = ""
            else:
                time.sleep(POLL_S)


def _tcp(where: str, host: str, port: int) -> Source:
    source = Source(where)
    try:
        link = socket.create_connection((host, port), timeout=10.0)
    except (OSError, OverflowError) as fault:
        raise InputError(f"no bench answers: {fault}", where, "a bench that listens at tcp://HOST:PORT") from None
    link.settimeout(None)
    stream: IO[str] = link.makefile("r", encoding="utf-8", newline="\n")
    source.send = lambda line: link.sendall(f"{line}\n".encode())
    source.start(lambda: _until_closed(link, stream))
    return source


def _until_closed(link: socket.socket, stream: IO[str]) -> Iterator[str]:
    with link, stream:
        yield from iter(lambda: stream.readline(BYTES), "")
    raise ConnectionResetError("closed by the other side")


def _mqtt(where: str, host: str, port: int, topic: str) -> Source:
    """A client in a thread: rows of TOPIC/rows come in, set points go to TOPIC/set."""
    th.required(["aiomqtt"])
    import aiomqtt

    source, ready, state = Source(where), threading.Event(), dict[str, Any]()

    async def run() -> None:
        try:
            async with aiomqtt.Client(host, port) as client:
                await client.subscribe(f"{topic}/rows", qos=1)
                state["client"], state["loop"] = client, asyncio.get_running_loop()
                ready.set()
                async for message in client.messages:
                    source.lines.put(bytes(message.payload).decode("utf-8", "replace"))  # type: ignore[arg-type]
        except aiomqtt.MqttError as fault:
            state["fault"] = fault
            source.lines.put(fault)
            ready.set()

    def send(line: str) -> None:
        going = state["client"].publish(f"{topic}/set", line, qos=1)
        try:
            asyncio.run_coroutine_threadsafe(going, state["loop"]).result(5.0)
        except (aiomqtt.MqttError, TimeoutError, RuntimeError, CancelledError) as fault:  # it ends, or has ended
            raise OSError(str(fault)) from None

    threading.Thread(target=lambda: asyncio.run(run()), daemon=True).start()
    if not ready.wait(10.0) or state.get("fault"):
        raise InputError(f"no broker answers: {state.get('fault', 'no reply')}", where, "mqtt://HOST[:PORT][/TOPIC]")
    source.send = send
    return source


class Parser:
    """Lines to rows.  header : of the cells, from the first line that is no JSON object"""

    def __init__(self, where: str, header: list[str]) -> None:
        self.where, self.header, self.count = where, header, 0

    def row(self, line: str) -> Row | None:
        """One row; None for an empty line and for a header that is said again."""
        self.count += 1
        text = line.strip()
        if text.startswith("{"):
            return self._object(text)
        cells = [c.strip().strip('"') for c in text.split(",")]
        if not text or cells == self.header:
            return None
        values = [th.as_number(c) for c in cells]
        if not self.header or all(v is None for v in values):
            self.header = cells
            return None
        if len(cells) != len(self.header):
            right = f"{len(self.header)}: {', '.join(self.header)}"
            raise BenchError(f"{len(cells)} cells", f"{self.where} line {self.count}", right)
        return {n: math.nan if v is None else v for n, v in zip(self.header, values, strict=True)}

    def _object(self, text: str) -> Row:
        try:
            return {str(n): math.nan if v is None else float(v) for n, v in json.loads(text).items()}
        except (ValueError, TypeError, AttributeError):
            right = '{"time_s": 5, "T_core": 21.4}'
            raise BenchError("is not a row", f"{self.where} line {self.count}", right) from None
