"""The page for the office and the telephone: one desk, and those beside it. It shows; it takes no orders.

A WSGI application: ``/`` the page, ``/now`` what of it changes, ``status.json``, ``part.png``, ``alarm.svg``.
People read it in the language of the screen; ``status.json``, which programs read, has one language.
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
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs
from zlib import crc32

from app.desk.status.formats import duration
from app.desk.translation import spoken, tr
from app.shopfloor.status_file import Status

if TYPE_CHECKING:
    from _typeshed.wsgi import StartResponse, WSGIEnvironment

_FILES = Path(__file__).with_name("page")
COOKIE = "turndesk-"  # and the port: a browser keeps one name for all ports of a computer
_NO_ORDERS = b"this page takes no orders\n"
_NO_TOKEN = b"open this page with ?token= and the token of the machine file\n"
_GOOD = frozenset({"RUNNING", "WAITING", "READY", "JOG", "HOMING"})
_BAD = frozenset({"ALARM", "E-STOP", "CONTROL SILENT", "NO ANSWER"})
NOT_YET = "…"  # nobody has asked it yet
Headers = list[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class OtherDesk:
    """Another desk as it was last heard; ``status`` None: nothing is known of it, ``trouble`` says why."""

    address: str
    status: Mapping[str, Any] | None = None
    trouble: str = ""
    state: str = "NO ANSWER"  # where nothing is known of it


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
        if not (given.isascii() and given.isprintable()):
            return HTTPStatus.BAD_REQUEST, [_TEXT], b"a token has letters, figures, - and _ only\n"
        if self.token and not hmac.compare_digest(given.encode(), self.token.encode()):
            return HTTPStatus.FORBIDDEN, [_TEXT], _NO_TOKEN
        make = _PAGES.get(environ.get("PATH_INFO", "/"))
        if make is None:
            return HTTPStatus.NOT_FOUND, [_TEXT], b"there is no such page; / shows the machine\n"
        kind, body = make(self)
        if not body:
            return HTTPStatus.NOT_FOUND, [_TEXT], b"there is none now\n"
        cookie = f"{_cookie(environ)}={self.token}; HttpOnly; SameSite=Strict; Path=/"
        kept = [("Set-Cookie", cookie)] if self.token else []
        return HTTPStatus.OK, [("Content-Type", kind), *kept], body

    def page(self) -> tuple[str, bytes]:
        """The whole page."""
        frame = Template((_FILES / "page.html").read_text("utf-8"))
        page = frame.substitute(
            title=escape(self.machine),
            language=spoken(),
            lost=escape(tr("NO RESPONSE: the values below are out of date")),
            now=self._now(),
            part=_picture("part", "part.png", self.picture(), tr("The part made by the loaded program")),
            alarm=_picture(
                "alarm", "alarm.svg", self.alarm(), tr("Following errors recorded before the last alarm")
            ),
        )
        return "text/html; charset=utf-8", page.encode()

    def now(self) -> tuple[str, bytes]:
        """What of the page changes."""
        return "text/html; charset=utf-8", self._now().encode()

    def style(self) -> tuple[str, bytes]:
        """How it looks."""
        return "text/css; charset=utf-8", (_FILES / "page.css").read_bytes()

    def script(self) -> tuple[str, bytes]:
        """What looks again, and says when nobody answers any more."""
        return "text/javascript; charset=utf-8", (_FILES / "page.js").read_bytes()

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
        drawn = f'<i id="drawn" data-part="{_mark(self.picture())}" data-alarm="{_mark(self.alarm())}"></i>'
        beside = f'<section class="others">{others}</section>' if others else ""
        return f"{_desk(self.status())}{drawn}{beside}"


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
        cookie = SimpleCookie(environ.get("HTTP_COOKIE", "")).get(_cookie(environ))
    except CookieError:
        cookie = None
    return query or bearer or (cookie.value if cookie is not None else "")


def _cookie(environ: WSGIEnvironment) -> str:
    return f"{COOKIE}{environ.get('SERVER_PORT', '')}"


# --- HTML ---------------------------------------------------------------------------------------------


def _look(state: str) -> str:
    return "good" if state in _GOOD else "bad" if state in _BAD else "doubt"


def _mark(picture: bytes) -> str:
    """By which a browser sees that it is another one than before; empty: there is none."""
    return f"{crc32(picture):x}" if picture else ""


def _picture(name: str, address: str, picture: bytes, words: str) -> str:
    """The drawing with its words below; hidden while there is none."""
    mark = _mark(picture)
    source = f'src="{address}?{mark}"' if mark else ""
    hidden = "" if mark else " hidden"
    image = f'<img {source} alt="{escape(words)}">'
    return f'<figure id="{name}"{hidden}>{image}<figcaption>{escape(words)}</figcaption></figure>'


def _desk(status: Status) -> str:
    alarms = found if isinstance(found := status["alarms"], list) else []
    told = "".join(map(_alarm, alarms))
    if any(each["text"] == status["stop"] for each in alarms):
        status = {**status, "stop": ""}  # the alarm says it, and what to do
    made = f'<p class="made">{escape(_local(status["updated"]))}</p>'
    return f"{_head(status)}{told}{_table(_figures(status))}{_stops(status)}{made}"


def _alarm(alarm: Mapping[str, Any]) -> str:
    number, text, remedy = alarm["number"] or alarm["code"], alarm["text"], alarm["remedy"]
    words = f"{escape(str(number))} {escape(tr(text))}"
    words += f"<br>{escape(tr(remedy))}" if remedy else ""
    return f'<p class="alarm">{words}</p>'


def _head(status: Mapping[str, Any], trouble: str = "") -> str:
    """The state, and why."""
    state = str(status.get("state") or status.get("execution") or "?")
    why = trouble or str(status.get("stop") or status.get("waiting_for") or "")
    said = f'<p class="why">{escape(tr(why))}</p>' if why else ""
    return f'<p class="state {_look(state)}">{escape(tr(state))}</p>{said}'


def _local(at: object, *, short: bool = False) -> str:
    """A moment in ISO 8601 as the clock of this desk shows it; what is none stays as it is.

    ``short``: without the date where that is today's, without seconds where it is not.
    """
    try:
        here = datetime.fromisoformat(str(at)).astimezone()
    except ValueError:
        return str(at)
    if not short:
        return f"{here:%Y-%m-%d %H:%M:%S}"
    return f"{here:%H:%M:%S}" if here.date() == datetime.now().date() else f"{here:%Y-%m-%d %H:%M}"


def _figures(status: Mapping[str, Any]) -> list[tuple[str, str]]:
    left, last = status.get("time_left"), status.get("last_cycle")
    made, line, load = status.get("made"), status.get("line"), status.get("spindle_load")
    return [
        (tr("Program"), str(status.get("program") or "")),
        (tr("Line"), str(line) if line else ""),
        (tr("Parts"), str(made) if made is not None else ""),
        (tr("Time remaining"), duration(left) if left is not None else ""),
        (tr("Last cycle"), duration(last) if last else ""),
        (tr("Spindle load"), f"{load} %" if load is not None else ""),
    ]


def _table(rows: list[tuple[str, str]]) -> str:
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in rows if text)
    return f"<table>{cells}</table>" if cells else ""


def _stops(status: Status) -> str:
    stops = status["stops"]
    if not isinstance(stops, list) or not stops:
        return ""
    rows = "".join(map(_stop, stops))
    return f"<h2>{escape(tr('Last stops'))}</h2><table>{rows}</table>"


def _stop(stop: Mapping[str, Any]) -> str:
    at, reason, lasted = _local(stop["at"], short=True), stop["reason"], duration(stop["seconds"])
    since, stood = (f'<td class="time">{escape(each)}</td>' for each in (at, lasted))
    return f"<tr>{since}<td>{escape(tr(reason))}</td>{stood}</tr>"


def _other(desk: OtherDesk) -> str:
    found = desk.status if desk.status is not None else {"state": desk.state}
    name = str(found.get("machine") or desk.address)
    return f"<article><h2>{escape(name)}</h2>{_head(found, desk.trouble)}{_table(_figures(found))}</article>"


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
