"""Status page of TurnDesk and other machines for an office computer or a phone.

The page only displays values, in the language of the screen. It is a WSGI application with these addresses:
``/`` (the page), ``/now`` (the part of the page that changes), ``status.json``, ``part.png`` and
``alarm.svg``. ``status.json`` is the same in every language.
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

from app.desk.status.formats import format_duration
from app.desk.translation import get_language, tr
from app.shopfloor.status_file import StatusDocument

if TYPE_CHECKING:
    from _typeshed.wsgi import StartResponse, WSGIEnvironment

_FILES = Path(__file__).with_name("page")
COOKIE_PREFIX = (
    "turndesk-"  # followed by the port, because browsers share cookies between all ports of a computer
)
_NO_ORDERS = b"this page takes no orders\n"
_NO_TOKEN = b"open this page with ?token= and the token of the machine file\n"
_GOOD = frozenset({"RUNNING", "WAITING", "READY", "JOG", "HOMING"})
_BAD = frozenset({"ALARM", "E-STOP", "CONTROL SILENT", "NO ANSWER"})
LOADING_TEXT = "…"  # not read yet
HeaderList = list[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class OtherMachine:
    """Latest state of another machine.

    ``status_document`` is None if the status is not known, and ``error_text`` is then the reason.
    """

    address: str
    status_document: Mapping[str, Any] | None = None
    error_text: str = ""
    state: str = "NO ANSWER"  # state if the status is not known


@dataclass(frozen=True, slots=True)
class StatusPage:
    """Status page as a WSGI application.

    ``read_part_png`` returns a PNG image of the part, and ``read_alarm_svg`` returns an SVG chart of the
    last alarm. Both return empty bytes if there is no picture.
    """

    machine_name: str
    access_token: str
    read_status: Callable[[], StatusDocument]
    read_other_machines: Callable[[], Sequence[OtherMachine]]
    read_part_png: Callable[[], bytes]
    read_alarm_svg: Callable[[], bytes]

    def __call__(self, environ: WSGIEnvironment, start: StartResponse) -> Iterable[bytes]:
        """Respond to one WSGI request."""
        status, headers, body = self._answer(environ)
        size = ("Content-Length", str(len(body)))
        start(f"{status.value} {status.phrase}", [*headers, *_ALWAYS, size])
        return [] if environ["REQUEST_METHOD"] == "HEAD" else [body]

    def _answer(self, environ: WSGIEnvironment) -> tuple[HTTPStatus, HeaderList, bytes]:
        if environ["REQUEST_METHOD"] not in {"GET", "HEAD"}:
            return HTTPStatus.METHOD_NOT_ALLOWED, [("Allow", "GET, HEAD"), _TEXT], _NO_ORDERS
        given = _find_token(environ)
        if not (given.isascii() and given.isprintable()):
            return HTTPStatus.BAD_REQUEST, [_TEXT], b"a token has letters, figures, - and _ only\n"
        if self.access_token and not hmac.compare_digest(given.encode(), self.access_token.encode()):
            return HTTPStatus.FORBIDDEN, [_TEXT], _NO_TOKEN
        make = _PAGES.get(environ.get("PATH_INFO", "/"))
        if make is None:
            return HTTPStatus.NOT_FOUND, [_TEXT], b"there is no such page; / shows the machine\n"
        kind, body = make(self)
        if not body:
            return HTTPStatus.NOT_FOUND, [_TEXT], b"there is none now\n"
        cookie = f"{_cookie(environ)}={self.access_token}; HttpOnly; SameSite=Strict; Path=/"
        kept = [("Set-Cookie", cookie)] if self.access_token else []
        return HTTPStatus.OK, [("Content-Type", kind), *kept], body

    def make_status_page(self) -> tuple[str, bytes]:
        """Return the content type and the HTML of the whole page."""
        frame = Template((_FILES / "page.html").read_text("utf-8"))
        page = frame.substitute(
            title=escape(self.machine_name),
            language=get_language(),
            lost=escape(tr("NO RESPONSE: the values below are out of date")),
            now=self._now(),
            part=_picture(
                "part", "part.png", self.read_part_png(), tr("The part made by the loaded program")
            ),
            alarm=_picture(
                "alarm",
                "alarm.svg",
                self.read_alarm_svg(),
                tr("Following errors recorded before the last alarm"),
            ),
        )
        return "text/html; charset=utf-8", page.encode()

    def make_live_content(self) -> tuple[str, bytes]:
        """Return the content type and the HTML of the live content, which the script refreshes."""
        return "text/html; charset=utf-8", self._now().encode()

    def get_style_sheet(self) -> tuple[str, bytes]:
        """Return the content type and the content of the style sheet."""
        return "text/css; charset=utf-8", (_FILES / "page.css").read_bytes()

    def get_script(self) -> tuple[str, bytes]:
        """Return the content type and the content of the script.

        The script refreshes the page and reports a lost connection.
        """
        return "text/javascript; charset=utf-8", (_FILES / "page.js").read_bytes()

    def make_status_json(self) -> tuple[str, bytes]:
        """Return the content type and the content of the JSON status for other machines and scripts."""
        return "application/json", (json.dumps(self.read_status(), indent=1) + "\n").encode()

    def get_part_png(self) -> tuple[str, bytes]:
        """Return the content type and the content of the picture of the part."""
        return "image/png", self.read_part_png()

    def get_alarm_svg(self) -> tuple[str, bytes]:
        """Return the content type and the chart of the following errors before the last alarm."""
        return "image/svg+xml", self.read_alarm_svg()

    def _now(self) -> str:
        others = "".join(_other(each) for each in self.read_other_machines())
        drawn = (
            f'<i id="drawn" data-part="{_mark(self.read_part_png())}" '
            f'data-alarm="{_mark(self.read_alarm_svg())}"></i>'
        )
        others_html = f'<section class="others">{others}</section>' if others else ""
        return f"{_desk(self.read_status())}{drawn}{others_html}"


_PAGES: dict[str, Callable[[StatusPage], tuple[str, bytes]]] = {
    "/": StatusPage.make_status_page,
    "/now": StatusPage.make_live_content,
    "/page.css": StatusPage.get_style_sheet,
    "/page.js": StatusPage.get_script,
    "/status.json": StatusPage.make_status_json,
    "/part.png": StatusPage.get_part_png,
    "/alarm.svg": StatusPage.get_alarm_svg,
}


def _find_token(environ: WSGIEnvironment) -> str:
    """Return the access token of a request from its address, its bearer header or its cookie."""
    query = parse_qs(environ.get("QUERY_STRING", "")).get("token", [""])[0]
    bearer = environ.get("HTTP_AUTHORIZATION", "").removeprefix("Bearer ")
    try:
        cookie = SimpleCookie(environ.get("HTTP_COOKIE", "")).get(_cookie(environ))
    except CookieError:
        cookie = None
    return query or bearer or (cookie.value if cookie is not None else "")


def _cookie(environ: WSGIEnvironment) -> str:
    return f"{COOKIE_PREFIX}{environ.get('SERVER_PORT', '')}"


# --- HTML ---------------------------------------------------------------------------------------------


def _look(state: str) -> str:
    return "good" if state in _GOOD else "bad" if state in _BAD else "doubt"


def _mark(picture: bytes) -> str:
    """Return a checksum that identifies the picture, or an empty string if there is no picture."""
    return f"{crc32(picture):x}" if picture else ""


def _picture(name: str, address: str, picture: bytes, words: str) -> str:
    """Return the HTML figure with a picture and its caption.

    The figure is hidden if there is no picture.
    """
    mark = _mark(picture)
    source = f'src="{address}?{mark}"' if mark else ""
    hidden = "" if mark else " hidden"
    image = f'<img {source} alt="{escape(words)}">'
    return f'<figure id="{name}"{hidden}>{image}<figcaption>{escape(words)}</figcaption></figure>'


def _desk(status: StatusDocument) -> str:
    alarms = found if isinstance(found := status["alarms"], list) else []
    alarms_html = "".join(map(_alarm, alarms))
    if any(each["text"] == status["stop"] for each in alarms):
        status = {**status, "stop": ""}  # the alarm contains this text and the remedy
    made = f'<p class="made">{escape(_local(status["updated"]))}</p>'
    return f"{_head(status)}{alarms_html}{_table(_figures(status))}{_stops(status)}{made}"


def _alarm(alarm: Mapping[str, Any]) -> str:
    number, text, remedy = alarm["number"] or alarm["code"], alarm["text"], alarm["remedy"]
    words = f"{escape(str(number))} {escape(tr(text))}"
    words += f"<br>{escape(tr(remedy))}" if remedy else ""
    return f'<p class="alarm">{words}</p>'


def _head(status: Mapping[str, Any], error_text: str = "") -> str:
    """Return the HTML heading with the machine state, and the reason for a stop if there is one."""
    state = str(status.get("state") or status.get("execution") or "?")
    why = error_text or str(status.get("stop") or status.get("waiting_for") or "")
    said = f'<p class="why">{escape(tr(why))}</p>' if why else ""
    return f'<p class="state {_look(state)}">{escape(tr(state))}</p>{said}'


def _local(at: object, *, short: bool = False) -> str:
    """Return an ISO 8601 time as local time, or any other text unchanged.

    If ``short`` is True, a time today is shown without the date, and any other time is shown without
    seconds.
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
        (tr("Time remaining"), format_duration(left) if left is not None else ""),
        (tr("Last cycle"), format_duration(last) if last else ""),
        (tr("Spindle load"), f"{load} %" if load is not None else ""),
    ]


def _table(rows: list[tuple[str, str]]) -> str:
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in rows if text)
    return f"<table>{cells}</table>" if cells else ""


def _stops(status: StatusDocument) -> str:
    stops = status["stops"]
    if not isinstance(stops, list) or not stops:
        return ""
    rows = "".join(map(_stop, stops))
    return f"<h2>{escape(tr('Last stops'))}</h2><table>{rows}</table>"


def _stop(stop: Mapping[str, Any]) -> str:
    at, reason, lasted = _local(stop["at"], short=True), stop["reason"], format_duration(stop["seconds"])
    since, stood = (f'<td class="time">{escape(each)}</td>' for each in (at, lasted))
    return f"<tr>{since}<td>{escape(tr(reason))}</td>{stood}</tr>"


def _other(desk: OtherMachine) -> str:
    found = desk.status_document if desk.status_document is not None else {"state": desk.state}
    name = str(found.get("machine") or desk.address)
    return (
        f"<article><h2>{escape(name)}</h2>{_head(found, desk.error_text)}{_table(_figures(found))}</article>"
    )


_TEXT = ("Content-Type", "text/plain; charset=utf-8")
_ALWAYS: HeaderList = [
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("X-Frame-Options", "DENY"),
    ("Referrer-Policy", "no-referrer"),
    (
        "Content-Security-Policy",
        "default-src 'none'; style-src 'self'; script-src 'self'; img-src 'self'; connect-src 'self'",
    ),
]
