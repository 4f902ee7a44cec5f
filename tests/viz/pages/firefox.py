"""Firefox on a screen that nobody sees, spoken to in its own protocol, WebDriver BiDi."""

import itertools
import json
import os
import re
import signal
import subprocess
from contextlib import asynccontextmanager

import aiohttp

START_S = 120  # a busy computer


class Tab:
    """One page; `said` collects its console and its faults."""

    def __init__(self, socket):
        self._socket, self._number, self.said, self.context = socket, itertools.count(1), [], ""

    async def ask(self, method, **parameters):
        number = next(self._number)
        await self._socket.send_json({"id": number, "method": method, "params": parameters})
        async for message in self._socket:
            found = json.loads(message.data)
            if found.get("method") == "log.entryAdded":
                self.said.append(found["params"]["text"])
            if found.get("id") == number:
                assert found["type"] == "success", found
                return found["result"]

    async def open(self, address):
        await self.ask("session.new", capabilities={})
        await self.ask("session.subscribe", events=["log.entryAdded"])
        self.context = (await self.ask("browsingContext.getTree"))["contexts"][0]["context"]
        await self.ask("browsingContext.navigate", context=self.context, url=address, wait="complete")

    async def evaluate(self, expression):
        """A number, text or truth value; a promise is waited for."""
        found = await self.ask(
            "script.evaluate", expression=expression, target={"context": self.context}, awaitPromise=True
        )
        assert found["type"] == "success", found
        return found["result"].get("value")


@asynccontextmanager
async def firefox(program, profile):
    """A tab of a Firefox that ends with the block."""
    command = ["xvfb-run", "-a", program, "--no-remote", "--profile", str(profile), "--remote-debugging-port", "0"]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, start_new_session=True
    )
    try:
        address = next(m[1] for line in process.stderr if (m := re.search(r"listening on (ws://\S+)", line)))
        timeout = aiohttp.ClientTimeout(total=START_S)
        async with aiohttp.ClientSession(timeout=timeout) as web, web.ws_connect(f"{address}/session") as socket:
            yield Tab(socket)
    finally:
        os.killpg(process.pid, signal.SIGTERM)  # the screen, too
        process.wait(timeout=60)
