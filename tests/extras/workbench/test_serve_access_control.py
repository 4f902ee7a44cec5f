"""Who gets in and what can be fetched: asked over a real socket."""

import asyncio
import base64
import hashlib
import re
import socket
from contextlib import asynccontextmanager

import pytest
from aiohttp import ClientSession, CookieJar, web
from motor_case import with_motor
from small_case import small_case
from yarl import URL

from extras.workbench.access_control import AccessControl, loopback, served
from extras.workbench.cli import serve
from extras.workbench.serve import application, token_for
from extras.workbench.tabs import MOST, Tabs
from geom.errors import InputError
from viz.viewer.page import script as viewer_script

TOKEN = "a-token-of-enough-characters"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return with_motor(small_case(tmp_path_factory.mktemp("access")))


@pytest.fixture
def servers(monkeypatch):
    """The tabs of every server that starts, as it knows them itself."""
    begun = []

    class Known(Tabs):
        def __init__(self, *given):
            super().__init__(*given)
            begun.append(self)

    monkeypatch.setattr("extras.workbench.serve.Tabs", Known)
    return begun


async def looked_at(tabs, number):
    """Wait until a server has counted so many connected tabs: it does so after the browser hears of it."""
    for _ in range(6000):
        if sum(tab.connected for tab in tabs.open.values()) == number:
            return
        await asyncio.sleep(0.01)
    pytest.fail(f"never were {number} tabs connected")


def asked(folder, access, questions):
    """What `questions(address, session)` gives against a server of the case."""

    async def main():
        async with running(folder, access) as address, ClientSession(cookie_jar=CookieJar(unsafe=True)) as session:
            return await questions(address, session)

    return asyncio.run(main())


@asynccontextmanager
async def running(folder, access, **options):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    runner = web.AppRunner(application(folder, access, **options))
    await runner.setup()
    await web.TCPSite(runner, "127.0.0.1", port).start()
    try:
        yield f"http://127.0.0.1:{port}"
    finally:
        await runner.cleanup()


def test_loopback_is_this_computer_only():
    local = {"127.0.0.1": True, "localhost": True, "::1": True, "[::1]": True, "0.0.0.0": False, "motor.example": False}
    assert {host: loopback(host) for host in local} == local


def test_a_token_is_made_where_none_is_given_and_a_short_one_is_refused():
    assert len(token_for(None)) >= 32
    assert token_for(None) != token_for(None)
    assert token_for(TOKEN) == TOKEN
    for short in ("", "short"):
        with pytest.raises(InputError, match="at least 16"):
            token_for(short)


def test_files_outside_the_served_folders_do_not_exist(tmp_path):
    inside, outside = tmp_path / "www", tmp_path / "secret.txt"
    inside.mkdir()
    (inside / "index.html").write_text("page")
    outside.write_text("secret")
    (inside / "link").symlink_to(outside)
    folders = {"": inside, "lib": inside}
    assert served(folders, "index.html") == inside / "index.html"
    assert served(folders, "lib/index.html") == inside / "index.html"
    for name in ("../secret.txt", "lib/../../secret.txt", str(outside), "link", "lib/../secret.txt", "", "lib/"):
        assert served(folders, name) is None, name


@pytest.mark.parametrize("host", ["0.0.0.0", "127.0.0.1", "localhost"])
def test_without_the_token_nothing_is_shown(folder, host):
    """On this computer neither: other users and programs share its ports."""

    async def questions(address, session):
        paths = ("/", "/tab/x/index.html", "/tab/x/ws", "/tab/x/report.html", "/?token=wrong")
        seen = [await status(session, address + path) for path in paths]
        async with session.get(f"{address}/?token={TOKEN}", allow_redirects=False) as answer:
            seen.append(answer.status)
            kept = answer.headers["Set-Cookie"]
        async with session.get(address + "/", allow_redirects=True) as answer:
            page = await answer.text()
        return seen, kept, page

    seen, kept, page = asked(folder, AccessControl(host, TOKEN), questions)
    assert seen == [401] * 5 + [302]
    assert "HttpOnly" in kept
    assert "SameSite=Strict" in kept
    assert "<title>" in page


async def status(session, url, method="GET", **options):
    async with session.request(method, url, allow_redirects=False, **options) as answer:
        return answer.status


FOREIGN = ({"Host": "evil.example"}, {"Origin": "http://evil.example"}, {"Origin": "null"}, {})


def test_other_names_and_other_pages_are_refused(folder):
    """A web page elsewhere must not reach a server on loopback, by its own name or from its own origin."""

    async def questions(address, session):
        return [await status(session, address + "/", headers=headers) for headers in FOREIGN]

    assert asked(folder, AccessControl("127.0.0.1", ""), questions) == [403, 403, 403, 302]


OUT = ("%2e%2e/%2e%2e/case.toml", "..%2f..%2fcase.toml", "%2fetc%2fpasswd", "report.html", "model.toml", "case.toml")
OUT += ("%00", "a%00b", "x" * 5000, "%ff%fe", "a" * 300)


def test_paths_do_not_lead_out(folder):
    async def questions(address, session):
        async with session.get(address + "/", allow_redirects=False) as answer:
            tab = answer.headers["Location"].removesuffix("index.html")
        names = ["index.html", *OUT, f"/{folder.settings.path / 'case.toml'}"]
        seen = {name: await status(session, f"{address}{tab}{name}") for name in names}
        async with session.get(address + "/tab/unknown/index.html", allow_redirects=False) as answer:
            seen["unknown"] = answer.headers["Location"]
        return seen

    seen = asked(folder, AccessControl("127.0.0.1", ""), questions)
    assert seen.pop("index.html") == 200
    assert seen.pop("unknown") == "/"
    assert set(seen.values()) == {404}


ODD = (
    ("GET", "/%00"),
    ("GET", "/%2e%2e/%00"),
    ("GET", "/tab/%00/index.html"),
    ("GET", "/tab/%00/%00"),
    ("GET", "/tab//x"),
    ("GET", "/tab/{tab}/%00/%00"),
    ("GET", "/tab/{tab}/..%00/case.toml"),
    ("GET", "/tab/{tab}/report.html%00"),
    ("GET", "/tab/{tab}/" + "%61/" * 1000),
    ("GET", "/tab/{tab}/%ed%a0%80"),
    ("GET", "/tab/{tab}/CON"),
    ("GET", "/tab/{tab}/ws"),
    ("POST", "/tab/%00/paraview/"),
    ("POST", "/tab/unknown/paraview/"),
    ("POST", "/"),
    ("PUT", "/tab/{tab}/index.html"),
    ("DELETE", "/tab/{tab}/index.html"),
    ("OPTIONS", "/"),
    ("TRACE", "/"),
    ("GET", "/?token=%00"),
    ("GET", "/?token=" + "x" * 5000),
    ("GET", "/?token=%ff"),
    ("GET", "//evil.example/%00"),
)


def test_no_request_breaks_the_server(folder):
    """Whatever is asked is answered, never with an error of the server's own, and the page still opens after it."""

    async def questions(address, session):
        async with session.get(f"{address}/?token={TOKEN}") as answer:
            tab = str(answer.url).split("/tab/")[1].partition("/")[0]
        seen = {}
        for method, path in ODD:
            url = URL(address + path.format(tab=tab), encoded=True)
            seen[method, path[:40]] = await status(session, url, method)
        return seen, await status(session, f"{address}/tab/{tab}/index.html")

    seen, after = asked(folder, AccessControl("127.0.0.1", TOKEN), questions)
    assert {request: status for request, status in seen.items() if status >= 500} == {}
    assert after == 200


def test_serve_always_asks_for_a_token(folder, monkeypatch):
    """The command makes one on loopback too, and prints it with the address."""
    controls = []
    monkeypatch.delenv("THERMOSCOPE_TOKEN", raising=False)
    monkeypatch.setattr("extras.workbench.serve.application", lambda folder, access: controls.append(access))
    monkeypatch.setattr("extras.workbench.serve.serve_until_stopped", lambda *given: None)
    for host in ("127.0.0.1", "localhost", "::1", "0.0.0.0"):
        assert serve(str(folder.settings.path), host, 0) == 0
    assert all(len(access.token) >= 32 for access in controls)
    assert len({access.token for access in controls}) == len(controls) == 4


def test_a_duplicated_tab_gets_a_session_of_its_own(folder, servers):
    """The copy asks with the address of a tab that is still connected; once that one has left, its session is free."""

    async def questions(address, session):
        async def asked_for(tab):
            async with session.post(f"{address}{tab}paraview/") as answer:
                return (await answer.json())["sessionURL"]

        async with session.get(address + "/", allow_redirects=False) as answer:
            tab = answer.headers["Location"].removesuffix("index.html")
        first = await asked_for(tab)
        async with session.ws_connect(first):
            await looked_at(servers[0], 1)
            copy = await asked_for(tab)
            async with session.ws_connect(copy):
                await looked_at(servers[0], 2)
        await looked_at(servers[0], 0)
        return tab, first, copy, await asked_for(tab)

    tab, first, copy, again = asked(folder, AccessControl("127.0.0.1", ""), questions)
    assert first == again
    assert tab in first
    assert tab not in copy


def test_pages_run_their_own_scripts_only(folder):
    """The one script inside the page is named by its hash; nothing comes from another server."""
    (folder.settings.out).mkdir(exist_ok=True)
    (folder.settings.out / "report.html").write_text("<title>report</title>")

    async def questions(address, session):
        async with session.get(address + "/") as answer:
            tab, page, policy = str(answer.url), await answer.text(), answer.headers["Content-Security-Policy"]
        async with session.get(tab.replace("index.html", "report.html")) as answer:
            return page, policy, answer.headers["Content-Security-Policy"]

    page, policy, report = asked(folder, AccessControl("127.0.0.1", ""), questions)
    rules = {rule.split()[0]: rule.split()[1:] for rule in policy.split("; ")}
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.S)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert rules["default-src"] == ["'none'"]
    assert rules["script-src"] == ["'self'", "'unsafe-eval'", f"'sha256-{digest}'"]
    assert rules["object-src"] == rules["frame-ancestors"] == ["'none'"]
    only = base64.b64encode(hashlib.sha256(viewer_script().encode()).digest()).decode()
    assert f"script-src 'sha256-{only}'; " in report
    assert report.startswith("default-src 'none'")


def test_a_ninth_tab_has_to_wait(folder, servers):
    """Eight tabs that are looked at stay; the ninth is told, and gets in once one of them is closed."""

    async def questions(address, session):
        async def tab():
            async with session.get(address + "/", allow_redirects=False) as answer:
                return answer.status, answer.headers.get("Location", "").removesuffix("index.html")

        sockets = []
        for _ in range(MOST):
            _, where = await tab()
            sockets.append(await session.ws_connect(f"{address}{where}ws"))
        await looked_at(servers[0], MOST)
        full, _ = await tab()
        await sockets.pop().close()
        await looked_at(servers[0], MOST - 1)
        free, _ = await tab()
        for socket_ in sockets:
            await socket_.close()
        return full, free

    assert asked(folder, AccessControl("127.0.0.1", ""), questions) == (503, 302)


def test_addresses_that_are_none(folder):
    async def questions(address, session):
        seen = []
        cookie = f"thermoscope-{URL(address).port}=\udcff"
        for headers in ({"Host": "[::1"}, {"Origin": "http://[::1"}, {"Cookie": cookie}):
            async with session.get(address + "/", headers=headers, allow_redirects=False) as answer:
                seen.append((answer.status, answer.headers.get("X-Frame-Options")))
        return seen

    assert asked(folder, AccessControl("127.0.0.1", TOKEN), questions) == [(403, "DENY"), (403, "DENY"), (401, "DENY")]
