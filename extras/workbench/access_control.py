"""Who may come in, and what they may fetch: this case's pages, and nothing else of this computer."""

import hmac
from collections.abc import Mapping
from dataclasses import dataclass
from ipaddress import ip_address
from pathlib import Path
from urllib.parse import SplitResult, urlsplit

from aiohttp import web
from aiohttp.typedefs import Handler, Middleware

COOKIE = "thermoscope"
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
}


def loopback(host: str) -> bool:
    """Does this name mean this computer only?"""
    try:
        return ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


@dataclass(frozen=True)
class AccessControl:
    """host : what the server listens on;  token : what a browser must show, on this computer too"""

    host: str
    token: str

    @property
    def middleware(self) -> Middleware:
        @web.middleware
        async def checked(request: web.Request, handler: Handler) -> web.StreamResponse:
            try:
                self.check(request)
                if "token" in request.query:
                    raise self._let_in(request)
                response = await handler(request)
            except web.HTTPException as answer:
                answer.headers.update(HEADERS)
                raise
            if not response.prepared:
                response.headers.update(HEADERS)
            return response

        return checked

    def check(self, request: web.Request) -> None:
        """HTTP 403 for a foreign page or name, 401 without the token."""
        name = _split(f"//{request.host}").hostname or ""
        if loopback(self.host) and not loopback(name):
            raise web.HTTPForbidden(text=f"this server is for this computer only, not for '{name}'")
        origin = request.headers.get("Origin")
        if origin is not None and _split(origin).netloc != request.host:
            raise web.HTTPForbidden(text="requests from other pages are refused")
        token = request.query.get("token") or request.cookies.get(cookie_of(request), "")
        if self.token and not hmac.compare_digest(token.encode("utf-8", "surrogateescape"), self.token.encode()):
            raise web.HTTPUnauthorized(text="open the address that thermoscope show serve printed, with its token")

    def _let_in(self, request: web.Request) -> web.HTTPFound:
        """The same address without the token, which a cookie carries from now on."""
        redirect = web.HTTPFound(request.path)
        if self.token:
            redirect.set_cookie(cookie_of(request), self.token, httponly=True, samesite="Strict", secure=request.secure)
        return redirect


def cookie_of(request: web.Request) -> str:
    """Its name: browsers keep one jar for all ports of a computer, and every workbench has a token of its own."""
    return f"{COOKIE}-{request.url.port}"


def _split(address: str) -> SplitResult:
    """An address taken apart; HTTP 403 for one that is none."""
    try:
        return urlsplit(address)
    except ValueError:
        raise web.HTTPForbidden(text="the host or the origin of the request is not an address") from None


def served(folders: Mapping[str, Path], name: str) -> Path | None:
    """The file of that name in one of the folders ("" is the root); None for anything outside or missing."""
    for prefix, folder in sorted(folders.items(), key=lambda item: -len(item[0])):
        if prefix and not name.startswith(f"{prefix}/"):
            continue
        root = folder.resolve()
        try:
            path = (root / name[len(prefix) + 1 if prefix else 0 :]).resolve()
            return path if path.is_relative_to(root) and path.is_file() else None
        except (OSError, ValueError):  # a name that no file can have
            return None
    return None
