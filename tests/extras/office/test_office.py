"""The page for the office: who may look, what it shows, the desks beside; no drawing while it runs."""

from __future__ import annotations

import json
import socket
import struct
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from PySide6.QtGui import QImage

from app.compose.backends.machine_check import check_machine
from app.compose.machine.machine_files import load_machine, parse_machine
from app.extras.office import other_machines
from app.extras.office.office_pictures import HIGH, encode_png, make_alarm_svg
from app.extras.office.office_setup import MAX_LISTED_STOPS, AlarmChart, PartPicture, StatusSource
from app.extras.office.other_machines import OtherMachines, make_status_address, read_turndesk_status
from app.extras.office.page_connections import MAX_CONNECTIONS, MAX_CONNECTIONS_PER_HOST, REQUEST_DEADLINE_S
from app.extras.office.page_server import StatusPageServer, open_listening_socket
from app.extras.office.status_page import OtherMachine, StatusPage
from app.programs.program_rows import Thumbnail
from app.screen.screen_theme import set_language
from app.shopfloor.machine_reading import MachineReader
from app.shopfloor.status_file import StatusDocument
from core.executor.snapshot import MachineState, Snapshot
from core.extras.office.shop_network_tables import StatusPageTable, parse_broker_address
from core.ports import DriverError
from core.records.record import ScopeRecord, list_machine_channels
from core.store.production.part_cycles import ProductionStopRow
from core.table_schema import MachineFileError
from resources import read_machine_file
from tests.coded import raises_code
from tests.texts import text, text_in_spanish

LATHE = load_machine(None)
TOKEN = "gt75-word-of-ours"
STATUS: StatusDocument = {
    "updated": "2026-11-23T09:00:00+00:00",
    "machine": "GT-75",
    "available": True,
    "program": "<b>pin</b>.nc",
    "state": "RUNNING",
    "waiting_for": "",
    "line": 12,
    "made": 7,
    "time_left": 65.0,
    "last_cycle": 130.0,
    "spindle_load": 40,
    "stop": "",
    "stops": [{"at": "2026-11-23T08:00:00Z", "reason": "<i>hold</i>", "seconds": 61}],
    "alarms": [{"number": 102, "code": "102", "text": "<u>X</u>", "remedy": "look & see"}],
}


def page(
    token: str = "", status: StatusDocument = STATUS, others: tuple[OtherMachine, ...] = ()
) -> StatusPage:
    return StatusPage("GT-75", token, lambda: status, lambda: others, lambda: b"", lambda: b"<svg/>")


def get(
    wsgi: StatusPage, path: str = "/", method: str = "GET", **more: str
) -> tuple[str, dict[str, str], str]:
    answer: list[Any] = []
    environ = {"REQUEST_METHOD": method, "PATH_INFO": path, "SERVER_PORT": "8317", **more}

    def begin(
        status: str, headers: list[tuple[str, str]], _error: object = None, /
    ) -> Callable[[bytes], object]:
        answer.extend((status, dict(headers)))
        return lambda _written: None

    body = b"".join(wsgi(environ, begin))
    return answer[0], answer[1], body.decode()


@pytest.mark.skipif(not hasattr(time, "tzset"), reason="no change of the time zone here")
def test_times_are_shown_in_local_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three hours behind UTC."""
    monkeypatch.setenv("TZ", "<-03>3")
    time.tzset()
    try:
        body = get(page())[2]
    finally:
        monkeypatch.undo()
        time.tzset()
    assert ">2026-11-23 06:00:00<" in body  # made at 09:00 UTC
    assert ">2026-11-23 05:00</td>" in body


# --- who may look -----------------------------------------------------------------------------------


def test_page_without_the_token_shows_nothing() -> None:
    status, _, body = get(page(TOKEN))
    assert status.startswith("403")
    assert "pin" not in body


def test_a_wrong_token_is_refused_everywhere() -> None:
    for path in ("/", "/now", "/status.json", "/part.png", "/alarm.svg", "/page.js"):
        assert get(page(TOKEN), path, QUERY_STRING="token=gt75-word-of-Ours")[0].startswith("403")


@pytest.mark.parametrize(
    "brought",
    [
        {"QUERY_STRING": f"token={TOKEN}"},
        {"HTTP_AUTHORIZATION": f"Bearer {TOKEN}"},
        {"HTTP_COOKIE": f"other=1; turndesk-8317={TOKEN}"},
    ],
)
def test_correct_token_opens_the_page(brought: dict[str, str]) -> None:
    status, headers, body = get(page(TOKEN), **brought)
    assert status == "200 OK"
    assert "RUNNING" in body
    assert "HttpOnly" in headers["Set-Cookie"]


def test_two_pages_on_one_computer_use_separate_cookies() -> None:
    """To a browser the port is no part of where a cookie belongs."""
    kept = get(page(TOKEN), QUERY_STRING=f"token={TOKEN}")[1]["Set-Cookie"].partition("=")[0]
    other = get(page("another-desk-1"), QUERY_STRING="token=another-desk-1", SERVER_PORT="8318")[1]
    assert (kept, other["Set-Cookie"].partition("=")[0]) == ("turndesk-8317", "turndesk-8318")


def test_page_without_a_configured_token_sets_no_cookie() -> None:
    status, headers, _ = get(page(), QUERY_STRING="token=any;Domain=x")
    assert status == "200 OK"
    assert "Set-Cookie" not in headers


@pytest.mark.parametrize("token", ["", TOKEN])
@pytest.mark.parametrize(
    "brought",
    [
        {"QUERY_STRING": "token=%ff"},
        {"QUERY_STRING": "token=%0d%0aX:1"},
        {"HTTP_AUTHORIZATION": "Bearer \xff"},
        {"HTTP_COOKIE": 'turndesk-8317="\\012"'},
    ],
)
def test_token_with_invalid_bytes_is_a_bad_request(brought: dict[str, str], token: str) -> None:
    assert get(page(token), **brought)[0].startswith("400")


def test_malformed_cookie_is_rejected() -> None:
    assert get(page(TOKEN), HTTP_COOKIE="turndesk=\x01;;=")[0].startswith("403")


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS"])
def test_page_rejects_other_methods(method: str) -> None:
    status, headers, _ = get(page(), method=method)
    assert status.startswith("405")
    assert headers["Allow"] == "GET, HEAD"


def test_unknown_paths_are_not_found() -> None:
    assert get(page(), "/../pyproject.toml")[0].startswith("404")
    assert get(page(), "/part.png")[0].startswith("404")  # no part is drawn
    assert get(page(), "/alarm.svg")[0] == "200 OK"


def test_head_request_returns_an_empty_body() -> None:
    status, headers, body = get(page(), method="HEAD")
    assert (status, body) == ("200 OK", "")
    assert int(headers["Content-Length"]) > 500


def test_page_on_a_network_address_requires_a_token() -> None:
    text = read_machine_file("gt75.toml")
    with pytest.raises(MachineFileError, match=r"status_page\.token: .*0\.0\.0\.0"):
        parse_machine(text + '[status_page]\nbind = "0.0.0.0"\ntoken = "short"\n', "m.toml")
    with pytest.raises(MachineFileError, match=r"status_page\.token: "):
        parse_machine(text + '[status_page]\ntoken = "with a blank and more"\n', "m.toml")
    with pytest.raises(MachineFileError, match=r"status_page\.desks = "):
        parse_machine(text + '[status_page]\ndesks = ["lathe2:8317"]\n', "m.toml")
    table = parse_machine(
        text + f'[status_page]\nbind = "0.0.0.0"\ntoken = "{TOKEN}"\n', "m.toml"
    ).hardware.find_driver_table(StatusPageTable)
    assert table is not None
    assert not table.enabled


@pytest.mark.parametrize(
    ("line", "path"),
    [
        ('mqtt = "shop:broker"', "announce.mqtt"),
        ('mqtt = ":1883"', "announce.mqtt"),
        ('hook = "ftp://x"', "announce.hook"),
        ('topic = "shop/#"', "announce.topic"),
    ],
)
def test_invalid_announcement_address_is_rejected(line: str, path: str) -> None:
    with pytest.raises(MachineFileError) as told:
        parse_machine(f"{read_machine_file('gt75.toml')}[announce]\n{line}\n", "m.toml")
    assert [finding.path for finding in told.value.findings] == [path]


def test_broker_address_has_the_default_port() -> None:
    assert parse_broker_address("shop-pc") == ("shop-pc", 1883)
    assert parse_broker_address("shop-pc:18") == ("shop-pc", 18)


# --- what it shows ----------------------------------------------------------------------------------


def test_program_name_is_escaped_as_text() -> None:
    _, headers, body = get(page())
    for harm in ("<b>", "<i>", "<u>"):
        assert harm not in body
    assert "&lt;b&gt;pin" in body
    assert "look &amp; see" in body
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert "1:05" in body  # 65 s left
    assert "2:10" in body  # 130 s the last cycle


def test_picture_address_changes_with_the_picture() -> None:
    """Else that of the program before would stand beside another name for as long as it is not asked for."""
    pictures = [b""]
    shown = StatusPage("GT-75", "", lambda: STATUS, lambda: (), lambda: pictures[0], lambda: b"")
    assert '<figure id="part" hidden>' in get(shown)[2]
    assert 'data-part=""' in get(shown, "/now")[2]
    marks = []
    for pictures[0] in (b"a pin", b"a nut", b"a pin"):
        marks.append(get(shown, "/now")[2].partition('data-part="')[2].partition('"')[0])
        assert f'src="part.png?{marks[-1]}"' in get(shown)[2]
    assert marks[0] == marks[2] != marks[1]


def test_events_of_today_are_shown_without_a_date() -> None:
    now = datetime.now().astimezone()
    told: StatusDocument = {**STATUS, "stops": [{"at": now.isoformat(), "reason": "FEED HOLD", "seconds": 5}]}
    assert f'<td class="time">{now:%H:%M:%S}</td>' in get(page(status=told))[2]


def test_page_uses_the_screen_language() -> None:
    set_language("es")
    try:
        body, told = get(page(status={**STATUS, "stop": "GUARD OPEN"}))[2], get(page(), "/status.json")[2]
    finally:
        set_language("en")
    assert '<html lang="es">' in body
    assert ">EN MARCHA<" in body
    assert f">{text_in_spanish('shopfloor.time-remaining')}<" in body
    assert ">RUNNING<" not in body
    assert json.loads(told) == STATUS  # which programs read


def test_alarm_is_shown_once_without_an_empty_line() -> None:
    text = "AXIS SENT, ITS ENCODER DOES NOT COUNT: X"
    alarm = {"number": 117, "code": "117", "text": text, "remedy": "look where the slide stands"}
    bare = {"number": None, "code": "interrupted", "text": "pin.nc line 52", "remedy": ""}
    body = get(page(status={**STATUS, "state": "ALARM", "stop": text, "alarms": [alarm, bare]}))[2]
    assert body.count(text) == 1
    assert "<br>look where the slide stands" in body
    assert '<p class="alarm">interrupted pin.nc line 52</p>' in body
    held = get(page(status={**STATUS, "state": "FEED HOLD", "stop": "GUARD OPEN"}))[2]
    assert '<p class="why">GUARD OPEN</p>' in held


def test_status_json_equals_the_status() -> None:
    assert json.loads(get(page(), "/status.json")[2]) == STATUS


def looking(**snapshot: Any) -> StatusDocument:
    reader = MachineReader(LATHE, lambda: 0.0)
    stops = [
        ProductionStopRow(str(i), "", "pin.nc", f"2026-11-23T08:0{i}:00Z", 10.0 + i, "H") for i in range(9)
    ]
    now = datetime(2026, 11, 23, 9, tzinfo=UTC)
    shot = Snapshot(**snapshot)
    return StatusSource(
        "GT-75", reader, lambda: shot, lambda _: 42.04, lambda: stops, lambda: now
    ).read_status()


def test_a_running_part_has_its_time_left_and_the_newest_stops() -> None:
    told = looking(state=MachineState.RUN, program="/p/pin.nc", counts=True, made=3, line=9)
    assert (told["state"], told["program"], told["made"], told["line"]) == ("RUNNING", "pin.nc", 3, 9)
    assert told["time_left"] == 42.0
    stops = told["stops"]
    assert isinstance(stops, list)
    assert [each["seconds"] for each in stops] == [18, 17, 16, 15, 14, 13][:MAX_LISTED_STOPS]


def test_idle_machine_has_no_time_left() -> None:
    assert looking(state=MachineState.IDLE)["time_left"] is None


def test_operator_message_is_shown_as_the_stop_reason() -> None:
    told = looking(state=MachineState.PROGRAM_STOP, message="TURN THE PART ROUND")
    assert told["stop"] == "TURN THE PART ROUND"


def test_silent_control_shows_only_its_state() -> None:
    seconds = iter((0.0, 10.0, 20.0, 30.0))
    reader = MachineReader(LATHE, lambda: next(seconds))
    look = StatusSource("GT-75", reader, Snapshot, lambda _: 1.0, lambda: (), lambda: datetime.now(UTC))
    look.read_status()
    told = look.read_status()
    assert (told["state"], told["available"], told["made"]) == (text("shopfloor.control-silent"), False, None)


# --- the desks beside -------------------------------------------------------------------------------


@contextmanager
def served(wsgi: StatusPage, clock: Callable[[], float] = time.monotonic) -> Iterator[str]:
    """A page on a real socket."""
    listening = open_listening_socket("127.0.0.1", 0)
    server = StatusPageServer(wsgi, listening, lambda: None, clock)
    server.start()
    try:
        yield f"http://127.0.0.1:{listening.getsockname()[1]}/"
    finally:
        server.close()


def connected(address: str, source: str = "127.0.0.1") -> socket.socket:
    host = urlsplit(address)
    return socket.create_connection((host.hostname, host.port), 60, source_address=(source, 0))


def test_incomplete_requests_do_not_block_other_clients() -> None:
    """More than there may be, of one address; without a token, as anybody in the network could."""
    with served(page()) as address, ExitStack() as half:
        for _ in range(150):
            half.enter_context(connected(address)).sendall(b"GET /?tok")
        assert read_turndesk_status(address).error_text == ""


@pytest.mark.skipif(sys.platform != "linux", reason="one loopback address only")
def test_total_connections_are_limited() -> None:
    with served(page()) as address, ExitStack() as half:
        askers = [
            half.enter_context(connected(address, f"127.0.0.{2 + n // 10}"))
            for n in range(MAX_CONNECTIONS + 1)
        ]
        assert askers[0].recv(1) == b""
        assert read_turndesk_status(address).error_text == ""


def test_connections_per_address_are_limited_and_the_oldest_is_closed() -> None:
    with served(page()) as address, ExitStack() as half:
        askers = [half.enter_context(connected(address)) for _ in range(MAX_CONNECTIONS_PER_HOST + 1)]
        assert askers[0].recv(1) == b""
        askers[1].sendall(b"GET /status.json HTTP/1.0\r\n\r\n")
        assert askers[1].recv(12) == b"HTTP/1.0 200"


def test_browser_that_is_killed_is_forgotten() -> None:
    """The kernel of a killed browser resets its connections, here in the middle of a request."""
    with served(page()) as address:
        for request in (b"GET /?tok", b"GET /status.json HTTP/1.0\r\n\r\n") * MAX_CONNECTIONS_PER_HOST:
            browser = connected(address)
            browser.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            browser.sendall(request)
            browser.close()
        assert read_turndesk_status(address).error_text == ""
        with connected(address) as next_browser:
            next_browser.sendall(b"GET /status.json HTTP/1.0\r\n\r\n")
            assert next_browser.recv(12) == b"HTTP/1.0 200"


def test_request_has_an_overall_deadline() -> None:
    """Bytes that go on coming do not put it off."""
    now = [100.0]
    with served(page(), lambda: now[0]) as address, connected(address) as drips:
        drips.sendall(b"GET /?tok")
        assert read_turndesk_status(address).error_text == ""
        now[0] += REQUEST_DEADLINE_S - 1.0
        drips.sendall(b"e")
        assert read_turndesk_status(address).error_text == ""
        now[0] += 2.0
        assert drips.recv(1) == b""


@pytest.mark.parametrize(
    "request_bytes",
    [b"GET http://[ HTTP/1.1\r\n\r\n", b"GET / HTTP/1.1\r\nContent-Length: %s\r\n\r\n" % (b"1" * 5000)],
)
def test_invalid_request_bytes_get_a_bad_request_response(
    request_bytes: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    with served(page()) as address, connected(address) as odd:
        odd.sendall(request_bytes)
        assert odd.recv(12) == b"HTTP/1.0 400"
    assert caplog.records == []


def test_a_request_without_end_is_refused() -> None:
    with served(page()) as address, connected(address) as odd:
        odd.sendall(b"GET /?" + b"a" * 20_000)
        assert odd.recv(12) == b"HTTP/1.0 431"


def test_concurrent_requests_are_not_logged(caplog: pytest.LogCaptureFixture) -> None:
    go_on, under_way = threading.Event(), threading.Semaphore(0)

    def slow() -> StatusDocument:
        under_way.release()
        go_on.wait(60)
        return STATUS

    waits = StatusPage("GT-75", "", slow, lambda: (), lambda: b"", lambda: b"")
    with served(waits) as address, ExitStack() as open_ones:
        host = urlsplit(address)
        for _ in range(6):
            asking = open_ones.enter_context(socket.create_connection((host.hostname, host.port)))
            asking.sendall(b"GET /status.json HTTP/1.0\r\n\r\n")
        for _ in range(3):
            assert under_way.acquire(timeout=60)
        go_on.set()
        for _ in range(3):
            assert under_way.acquire(timeout=60)
    assert caplog.records == []


def test_page_shows_another_machine() -> None:
    with served(page(TOKEN)) as address:
        heard = read_turndesk_status(f"{address}?token={TOKEN}")
    assert heard.error_text == ""
    assert heard.status_document is not None
    assert heard.status_document["program"] == "<b>pin</b>.nc"
    shown = get(page(others=(heard,)))[2]
    assert shown.count("&lt;b&gt;pin") == 2
    assert TOKEN not in shown


def test_wrong_token_of_another_machine_is_reported() -> None:
    with served(page(TOKEN)) as address:
        assert read_turndesk_status(address).error_text == text("shopfloor.other-token")


def test_machine_that_is_off_is_shown_as_not_responding() -> None:
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        heard = read_turndesk_status(f"http://127.0.0.1:{nobody.getsockname()[1]}")
    assert heard.status_document is None
    assert "refused" in heard.error_text
    assert text("shopfloor.no-answer-shown") in get(page(others=(heard,)))[2]


def test_status_from_another_machine_is_validated() -> None:
    odd: StatusDocument = {**STATUS, "time_left": "soon", "program": ["x"], "line": {"a": 1}, "state": "<hr>"}
    with served(page(status=odd)) as address:
        heard = read_turndesk_status(address)
    shown = get(page(others=(heard,)))[2]
    assert "soon" not in shown
    assert "<hr>" not in shown


@pytest.mark.parametrize("odd", [float("inf"), float("nan"), -float("inf"), 10**400, True])
def test_invalid_number_from_another_machine_is_omitted(odd: float) -> None:
    with served(page(status={**STATUS, "time_left": odd, "last_cycle": odd})) as address:
        heard = read_turndesk_status(address)
    assert heard.status_document is not None
    assert heard.status_document.keys() & {"time_left", "last_cycle"} == set()
    assert "RUNNING" in get(page(others=(heard,)))[2]


def test_status_address_is_derived_from_the_page_address() -> None:
    assert make_status_address("http://a:1/?token=x") == "http://a:1/status.json?token=x"
    assert make_status_address("http://a:1/desk") == "http://a:1/desk/status.json"


def test_other_machines_are_polled_only_while_the_page_is_viewed() -> None:
    heard = OtherMachine("lathe2", {"state": "READY"})
    asking = OtherMachines(("http://lathe2:8317",), lambda _address: heard)
    assert (asking.read_machine_states()[0].state, asking.read_machine_states()[0].error_text) == ("…", "")
    asking.start()
    while asking.read_machine_states()[0].status_document != heard.status_document:
        pass
    asking.close()


def test_older_turndesk_shows_its_data_and_a_dead_one_is_marked() -> None:
    """Side by side: one that knows no counts and times yet, one that was killed, one as new as this."""
    older: StatusDocument = {key: STATUS[key] for key in ("machine", "state", "program", "line")}
    with served(page(status=older)) as old, served(page(status=STATUS)) as new, socket.socket() as dead:
        dead.bind(("127.0.0.1", 0))
        heard = [
            read_turndesk_status(each) for each in (old, f"http://127.0.0.1:{dead.getsockname()[1]}", new)
        ]
    assert [each.status_document is not None for each in heard] == [True, False, True]
    shown = get(page(others=tuple(heard)))[2]
    cards = shown[shown.index('class="others"') :].split("<article>")[1:]
    assert [(text("shopfloor.no-answer-shown") in card, ">PARTS<" in card.upper()) for card in cards] == [
        (False, False),
        (True, False),
        (False, True),
    ]


def test_hung_machine_does_not_delay_the_others() -> None:
    hangs, healthy = threading.Event(), OtherMachine("lathe3", {"state": "READY"})

    def ask(address: str) -> OtherMachine:
        if "lathe2" in address:
            hangs.wait()
        return healthy

    asking = OtherMachines(("http://lathe2:8317", "http://lathe3:8317"), ask)
    asking.read_machine_states()
    asking.start()
    try:
        while asking.read_machine_states()[1].status_document is not healthy.status_document:
            pass
        assert asking.read_machine_states()[0].state == "…"
    finally:
        hangs.set()
        asking.close()


def test_outdated_status_is_not_shown_as_current() -> None:
    now = [0.0]
    asking = OtherMachines(("http://lathe2:8317",), lambda _address: OtherMachine("lathe2"), lambda: now[0])
    asking.read_machine_states()
    asking._heard["http://lathe2:8317"] = 0.0, OtherMachine("lathe2", {"state": "RUNNING"})
    now[0] = 10.0
    assert asking.read_machine_states()[0].status_document == {"state": "RUNNING"}
    now[0] = 10.5
    assert (asking.read_machine_states()[0].status_document, asking.read_machine_states()[0].error_text) == (
        None,
        text("shopfloor.silent-for", age=10),
    )


def test_machine_that_never_responds_is_reported_after_a_delay() -> None:
    now = [100.0]
    asking = OtherMachines(("http://lathe2:8317",), lambda _address: OtherMachine("lathe2"), lambda: now[0])
    assert asking.read_machine_states()[0].state == "…"
    now[0] = 110.5
    assert (asking.read_machine_states()[0].state, asking.read_machine_states()[0].error_text) == (
        text("shopfloor.no-answer-shown"),
        text("shopfloor.silent-for", age=10),
    )


def test_machine_that_dies_retains_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_machines, "READ_INTERVAL_S", 0.001)
    dies, answers = (
        threading.Event(),
        iter([OtherMachine("lathe2", {"machine": "LATHE 2", "state": "READY"})]),
    )

    def ask(_address: str) -> OtherMachine:
        if (heard := next(answers, None)) is not None:
            return heard
        dies.wait()
        return OtherMachine("lathe2", error_text="Connection refused")

    asking = OtherMachines(("http://lathe2:8317",), ask)
    asking.read_machine_states()
    asking.start()
    while asking.read_machine_states()[0].status_document is None:
        pass
    dies.set()
    while asking.read_machine_states()[0].status_document is not None:
        pass
    asking.close()
    shown = get(page(others=tuple(asking.read_machine_states())))[2]
    assert "<h2>LATHE 2 (lathe2:8317)</h2>" in shown
    assert "Connection refused" in shown


def test_machines_are_not_reported_dead_after_a_polling_pause() -> None:
    now = [0.0]
    asking = OtherMachines(("http://lathe2:8317",), lambda _address: OtherMachine("lathe2"), lambda: now[0])
    asking.read_machine_states()
    asking._heard["http://lathe2:8317"] = 0.0, OtherMachine("lathe2", {"state": "RUNNING"})
    now[0] = 30_000.0
    assert (asking.read_machine_states()[0].status_document, asking.read_machine_states()[0].state) == (
        None,
        "…",
    )


def test_port_in_use_is_reported() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with raises_code(DriverError, "driver", f"[status_page] 127.0.0.1:{port}: "):
            open_listening_socket("127.0.0.1", port)
    with raises_code(DriverError, "driver", "[status_page] 192.0.2.1:8317: "):
        open_listening_socket("192.0.2.1", 8317)


def test_machine_check_has_a_row_for_the_page_and_for_the_broker() -> None:
    with socket.create_server(("127.0.0.1", 0)) as there, socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        taken, away = there.getsockname()[1], free.getsockname()[1]
        tables = (
            f'[status_page]\nenabled = true\nport = {taken}\n[announce]\nmqtt = "127.0.0.1:{taken}"\n',
            f'[status_page]\nenabled = true\nport = {taken + 1}\n[announce]\nmqtt = "127.0.0.1:{away}"\n',
        )
        told = [
            check_machine(parse_machine(read_machine_file("gt75.toml") + each, "m.toml")).rows
            for each in tables
        ]
    states = [{row.name: row.state for row in rows} for rows in told]
    assert (states[0]["status_page"], states[0]["announce"]) == ("fault", "ok")
    assert states[1]["announce"] == text("shopfloor.no-answer")


# --- pictures ---------------------------------------------------------------------------------------


def test_part_picture_is_not_drawn_while_a_part_is_made() -> None:
    runs, drawn = [True], []
    job: Any = SimpleNamespace(digest="a")

    def draw(_job: object, _watch: object) -> Thumbnail:
        drawn.append(1)
        return Thumbnail(b"\xff" * 16, 2, 2)

    picture = PartPicture(lambda: job, lambda: not runs[0], draw)
    picture.update()
    assert (picture.get_part_png(), drawn) == (b"", [])
    runs[0] = False
    picture.update()
    picture.update()
    assert picture.get_part_png().startswith(b"\x89PNG")
    assert drawn == [1]
    job.digest = "b"
    assert picture.get_part_png() == b""  # of another program


def test_encoded_png_can_be_read_by_qt() -> None:
    colours = [0xFF102030, 0x80FFFFFF, 0x00000000, 0xFF00FF00, 0xFFFF0000, 0xFF0000FF]
    image = QImage.fromData(encode_png(np.array(colours, dtype=np.uint32).tobytes(), 3, 2))
    assert [image.pixel(x, y) for y in range(2) for x in range(3)] == colours


def record_of(error: Any) -> ScopeRecord:
    channels = list_machine_channels({"X": False, "C": True}, (), ())
    times = np.arange(len(error)) / 1000.0 + 50.0
    columns = {each.name: np.full(len(error), np.nan) for each in channels}
    columns |= {"X following error": np.asarray(error), "C following error": np.ones(len(error))}
    about = {"alarm": "102 FOLLOWING ERROR: <X>", "alarm time": "52.5"}
    return ScopeRecord(channels, times, columns, 0.0, 1000.0, about)


def test_alarm_drawing_shows_the_peak() -> None:
    error = np.zeros(5000)
    error[2500] = 0.25  # one sample of 5 000, at the alarm
    svg = make_alarm_svg(record_of(error)).decode()
    assert "±0.2500 mm" in svg
    assert "&lt;X&gt;" in svg
    assert svg.count("<polyline") == 1  # C is no slide
    points = [tuple(map(float, each.split(","))) for each in svg.split('points="')[1].split('"')[0].split()]
    peak = min(points, key=lambda point: point[1])
    assert peak[1] == pytest.approx(24.0)  # the top of the drawing's room
    assert peak[0] == pytest.approx(8 + 2500 / 4999 * 624, abs=0.1)
    assert max(y for _, y in points) < HIGH


def test_a_record_without_samples_is_not_drawn() -> None:
    assert make_alarm_svg(record_of(np.array([]))) == b""
    assert make_alarm_svg(record_of(np.full(10, np.nan))) == b""
    assert make_alarm_svg(replace(record_of(np.zeros(10)), about={})) == b""


def test_a_record_that_is_damaged_is_not_drawn(tmp_path: Path) -> None:
    (tmp_path / "20261123-alarm102.scope").write_bytes(b"PK damaged")
    drawing = AlarmChart(tmp_path, lambda: True)
    drawing.update()
    assert drawing.get_alarm_svg() == b""
