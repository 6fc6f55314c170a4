"""The page for the office and the telephone: one desk, and those beside it. It shows; it takes no orders.

A WSGI application: ``/`` the page, ``/now`` what of it changes, ``status.json``, ``part.png``, ``alarm.svg``.
"""

from __future__ import annotations

import hmac
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from html import escape
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from string import Template
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs

from app.desk.formats import duration
from app.shopfloor.status_file import Status
from resources import status_page_file

if TYPE_CHECKING:
    from _typeshed.wsgi import StartResponse, WSGIEnvironment

COOKIE = "turndesk"
_NO_ORDERS = b"this page takes no orders\n"
_NO_TOKEN = b"open this page with ?token= and the token of the machine file\n"
_GOOD = frozenset({"RUNNING", "WAITING", "READY", "JOG", "HOMING"})
_BAD = frozenset({"ALARM", "E-STOP", "CONTROL SILENT", "NO ANSWER"})
Headers = list[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class OtherDesk:
    """Another desk as it was last heard; ``status`` None: it does not answer, ``trouble`` says why."""

    address: str
    status: Mapping[str, Any] | None = None
    trouble: str = ""


@dataclass(frozen=True, slots=True)
class StatusPage:
    """``picture``: the loaded part as PNG, ``alarm``: the scope's last alarm as SVG; empty: there is none."""

    machine: str
    token: str
    status: Callable[[], Status]
    others: Callable[[], Sequence[OtherDesk]]
    picture: Callable[[], bytes]
    alarm: Callable[[], bytes]

    def __call__(self, environ: WSGIEnvironment, start: StartResponse) -> Iterable[bytes]:
        """Answer one request, as WSGI wants it."""
        status, headers, body = self._answer(environ)
        size = ("Content-Length", str(len(body)))
        start(f"{status.value} {status.phrase}", [*headers, *_ALWAYS, size])
        return [] if environ["REQUEST_METHOD"] == "HEAD" else [body]

    def _answer(self, environ: WSGIEnvironment) -> tuple[HTTPStatus, Headers, bytes]:
        if environ["REQUEST_METHOD"] not in {"GET", "HEAD"}:
            return HTTPStatus.METHOD_NOT_ALLOWED, [("Allow", "GET, HEAD"), _TEXT], _NO_ORDERS
        given = _given(environ)
        if self.token and not hmac.compare_digest(given.encode(), self.token.encode()):
            return HTTPStatus.FORBIDDEN, [_TEXT], _NO_TOKEN
        make = _PAGES.get(environ.get("PATH_INFO", "/"))
        if make is None:
            return HTTPStatus.NOT_FOUND, [_TEXT], b"there is no such page; / shows the machine\n"
        kind, body = make(self)
        if not body:
            return HTTPStatus.NOT_FOUND, [_TEXT], b"there is none now\n"
        kept = [("Set-Cookie", f"{COOKIE}={given}; HttpOnly; SameSite=Strict; Path=/")] if given else []
        return HTTPStatus.OK, [("Content-Type", kind), *kept], body

    def page(self) -> tuple[str, bytes]:
        """The whole page."""
        frame = Template(status_page_file("page.html").decode())
        page = frame.substitute(title=escape(self.machine), now=self._now())
        return "text/html; charset=utf-8", page.encode()

    def now(self) -> tuple[str, bytes]:
        """What of the page changes."""
        return "text/html; charset=utf-8", self._now().encode()

    def style(self) -> tuple[str, bytes]:
        """How it looks."""
        return "text/css; charset=utf-8", status_page_file("page.css")

    def script(self) -> tuple[str, bytes]:
        """What looks again, and says when nobody answers any more."""
        return "text/javascript; charset=utf-8", status_page_file("page.js")

    def json(self) -> tuple[str, bytes]:
        """The same for other desks and for scripts."""
        return "application/json", (json.dumps(self.status(), indent=1) + "\n").encode()

    def png(self) -> tuple[str, bytes]:
        """The part of the program on the desk."""
        return "image/png", self.picture()

    def svg(self) -> tuple[str, bytes]:
        """Following errors in the seconds before the last alarm."""
        return "image/svg+xml", self.alarm()

    def _now(self) -> str:
        others = "".join(_other(each) for each in self.others())
        return _desk(self.status()) + (f'<section class="others">{others}</section>' if others else "")


_PAGES: dict[str, Callable[[StatusPage], tuple[str, bytes]]] = {
    "/": StatusPage.page,
    "/now": StatusPage.now,
    "/page.css": StatusPage.style,
    "/page.js": StatusPage.script,
    "/status.json": StatusPage.json,
    "/part.png": StatusPage.png,
    "/alarm.svg": StatusPage.svg,
}


def _given(environ: WSGIEnvironment) -> str:
    """The token that a browser brings: in the address, as a bearer, or in the cookie of before."""
    query = parse_qs(environ.get("QUERY_STRING", "")).get("token", [""])[0]
    bearer = environ.get("HTTP_AUTHORIZATION", "").removeprefix("Bearer ")
    try:
        cookie = SimpleCookie(environ.get("HTTP_COOKIE", "")).get(COOKIE)
    except CookieError:
        cookie = None
    return query or bearer or (cookie.value if cookie is not None else "")


# --- HTML ---------------------------------------------------------------------------------------------


def _look(state: str) -> str:
    return "good" if state in _GOOD else "bad" if state in _BAD else "doubt"


def _desk(status: Status) -> str:
    state, alarms = str(status["state"]), status["alarms"]
    why = str(status["stop"] or status["waiting_for"] or "")
    rows = "".join(
        f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in _figures(status) if text
    )
    told = "".join(
        f'<p class="alarm">{escape(str(each["number"] or each["code"]))} {escape(each["text"])}'
        f"<br>{escape(each['remedy'])}</p>"
        for each in (alarms if isinstance(alarms, list) else [])
    )
    return (
        f'<p class="state {_look(state)}">{escape(state)}</p><p class="why">{escape(why)}</p>{told}'
        f'<table>{rows}</table>{_stops(status)}<p class="made">{escape(_local(status["updated"]))}</p>'
    )


def _local(at: object) -> str:
    """A moment in ISO 8601 as the clock of this desk shows it; what is none stays as it is."""
    try:
        return f"{datetime.fromisoformat(str(at)).astimezone():%Y-%m-%d %H:%M:%S}"
    except ValueError:
        return str(at)


def _figures(status: Mapping[str, Any]) -> list[tuple[str, str]]:
    left, last = status.get("time_left"), status.get("last_cycle")
    made, line, load = status.get("made"), status.get("line"), status.get("spindle_load")
    return [
        ("Program", str(status.get("program") or "")),
        ("Line", str(line) if line else ""),
        ("Parts", str(made) if made is not None else ""),
        ("Time left", duration(left) if left is not None else ""),
        ("Last cycle", duration(last) if last else ""),
        ("Spindle load", f"{load} %" if load is not None else ""),
    ]


def _stops(status: Status) -> str:
    stops = status["stops"]
    if not isinstance(stops, list) or not stops:
        return ""
    rows = "".join(
        f"<tr><td>{escape(_local(each['at']))}</td><td>{escape(each['reason'])}</td>"
        f"<td>{duration(each['seconds'])}</td></tr>"
        for each in stops
    )
    return f"<h2>Last stops</h2><table>{rows}</table>"


def _other(desk: OtherDesk) -> str:
    found = desk.status
    name = str(found.get("machine") or desk.address) if found is not None else desk.address
    state = str(found.get("state") or found.get("execution") or "?") if found is not None else "NO ANSWER"
    rows = "".join(
        f"<tr><th>{escape(title)}</th><td>{escape(text)}</td></tr>"
        for title, text in (_figures(found) if found is not None else [])
        if text
    )
    why = f'<p class="why">{escape(desk.trouble)}</p>' if desk.trouble else ""
    head = f'<h2>{escape(name)}</h2><p class="state {_look(state)}">{escape(state)}</p>'
    return f"<article>{head}{why}<table>{rows}</table></article>"


_TEXT = ("Content-Type", "text/plain; charset=utf-8")
_ALWAYS: Headers = [
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("X-Frame-Options", "DENY"),
    ("Referrer-Policy", "no-referrer"),
    (
        "Content-Security-Policy",
        "default-src 'none'; style-src 'self'; script-src 'self'; img-src 'self'; connect-src 'self'",
    ),
]
