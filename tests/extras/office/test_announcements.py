"""Who is told of ends and stops: what is told, in which order, and what happens where nobody answers."""

from __future__ import annotations

import errno
import json
import logging
import os
import shutil
import signal
import socket
import ssl
import subprocess
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from http.client import HTTPException, InvalidURL
from http.server import BaseHTTPRequestHandler, HTTPServer
from itertools import count
from pathlib import Path
from queue import SimpleQueue
from urllib.error import URLError

import paho.mqtt.client as mqtt
import pytest
from paho.mqtt.enums import CallbackAPIVersion

from app.extras.office import mqtt_broker
from app.extras.office.announcements import MAX_QUEUED, Announcement, Announcer, find_events
from app.extras.office.mqtt_broker import MqttReceiver
from app.extras.office.other_machines import read_turndesk_status
from app.extras.office.timed_http import DeliveryErrorLog, describe_connection_error
from app.extras.office.web_hook import WebhookReceiver, post_json
from app.shopfloor.status_file import StatusDocument
from core.extras.office.shop_network_tables import AnnounceTable
from tests.free_port import free_port
from tests.texts import text

READY: StatusDocument = {
    "state": "READY", "program": "pin.nc", "made": 3, "parts": 2, "stop": "", "waiting_for": ""
}  # fmt: skip
RUNNING: StatusDocument = {**READY, "state": "RUNNING"}


def told(before: StatusDocument, now: StatusDocument) -> list[tuple[str, str]]:
    return [(each.event_kind, each.text) for each in find_events(before, now)]


# --- what has happened ------------------------------------------------------------------------------


def test_first_status_announces_nothing() -> None:
    assert told({}, {**READY, "state": "ALARM"}) == []


def test_completed_part_is_announced() -> None:
    assert told(RUNNING, {**RUNNING, "made": 4, "parts": 3}) == [
        ("part", text("shopfloor.part-done", number=4, program="pin.nc"))
    ]


@pytest.mark.parametrize("now", [{"program": "nut.nc", "made": 90}, {"made": 4}])
def test_loaded_or_typed_count_is_not_announced_as_a_part(now: StatusDocument) -> None:
    """Of another program; of the same one, told behind its loading: so after each start of the desk."""
    assert told(READY, {**READY, **now}) == []


def test_count_reset_is_not_announced_as_a_part() -> None:
    assert told(READY, {**READY, "made": 0, "parts": 0}) == []


def test_stop_and_alarm_announcements_include_the_reason() -> None:
    hold: StatusDocument = {**RUNNING, "state": "FEED HOLD", "stop": "GUARD OPEN"}
    alarm: StatusDocument = {**RUNNING, "state": "ALARM", "stop": "FOLLOWING ERROR: X"}
    assert told(RUNNING, hold) == [("stop", "FEED HOLD: GUARD OPEN")]
    assert told(RUNNING, alarm) == [("alarm", "ALARM: FOLLOWING ERROR: X")]


def test_waiting_for_the_spindle_is_not_announced_as_a_stop() -> None:
    waits: StatusDocument = {**RUNNING, "state": "WAITING", "waiting_for": "AT SPEED"}
    assert told(RUNNING, waits) == []
    assert told(waits, RUNNING) == []


def test_expired_tool_life_is_announced_once() -> None:
    worn: StatusDocument = {**RUNNING, "next_barred": "T3 HAS CUT 400 PARTS"}
    assert told(RUNNING, worn) == [("tool-life", "T3 HAS CUT 400 PARTS")]
    assert told(worn, worn) == []


def values_of(record: logging.LogRecord) -> tuple[str, ...]:
    """Return who is not told and why, as the log has them beside its wording."""
    assert isinstance(record.args, tuple)
    return tuple(str(each) for each in record.args)


class Heard:
    """Somebody who is told."""

    def __init__(self) -> None:
        self.states: list[str] = []
        self.events: list[str] = []

    def send_status(self, status: StatusDocument) -> None:
        self.states.append(str(status["state"]))

    def send_announcement(self, announcement: Announcement) -> None:
        self.events.append(announcement.event_kind)

    def close(self) -> None:
        self.events.append("closed")


def test_state_is_sent_on_change_and_not_every_second() -> None:
    looks = iter(
        [READY, {**RUNNING, "time_left": 9.0}, {**RUNNING, "time_left": 8.0}, {**RUNNING, "parts": 3}]
    )
    heard = Heard()
    announcer = Announcer(lambda: next(looks), [heard])
    for _ in range(4):
        announcer.poll()
    announcer.close()
    assert heard.states == ["READY", "RUNNING", "RUNNING"]
    assert heard.events == ["runs", "part", "closed"]


def test_part_made_while_the_control_is_silent_is_announced_afterward() -> None:
    silent: StatusDocument = {**RUNNING, "state": "CONTROL SILENT", "made": None, "parts": None}
    looks = iter([RUNNING, silent, silent, {**RUNNING, "made": 4, "parts": 3}, {**RUNNING, "parts": 3}])
    heard = Heard()
    announcer = Announcer(lambda: next(looks), [heard])
    for _ in range(5):
        announcer.poll()
    announcer.close()
    assert heard.events == ["alarm", "part", "runs", "closed"]


# --- a web hook -------------------------------------------------------------------------------------


AT_ONCE = 0.001  # s until the next try


@pytest.fixture
def posts() -> Iterator[tuple[str, SimpleQueue[dict[str, object]]]]:
    """A server that takes what is posted, and its address; other paths answer with their number."""
    heard: SimpleQueue[dict[str, object]] = SimpleQueue()

    class Taker(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            said = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            number = self.path.removeprefix("/hook")
            if number == "garbage":
                self.wfile.write(b"\x1b[2J garbage\r\n\r\n")
            else:
                self.send_response(int(number or 204))
                self.send_header("Location", "https://office/hook")
                self.end_headers()
            heard.put(said)

        def do_GET(self) -> None:
            heard.put({"text": "asked by GET"})

        def log_message(self, *_words: object) -> None:
            pass

    server = HTTPServer(("127.0.0.1", 0), Taker)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}/hook", heard
    server.shutdown()
    thread.join()
    server.server_close()


def test_webhook_receives_announcements_in_order(posts: tuple[str, SimpleQueue[dict[str, object]]]) -> None:
    address, heard = posts
    hook = WebhookReceiver(address, AT_ONCE)
    for number in range(5):
        hook.send_announcement(Announcement("part", f"part {number}", READY))
    assert [heard.get(timeout=60)["text"] for _ in range(5)] == [f"part {n}" for n in range(5)]
    hook.close()


@pytest.mark.parametrize(
    ("path", "values"),
    [
        ("301", ["301 Moved Permanently", "https://office;", "[announce] hook"]),
        ("307", ["307 Temporary Redirect", "https://office;", "[announce] hook"]),
        ("404", ["404 Not Found"]),
    ],
)
def test_announcement_rejected_by_a_webhook_is_dropped_and_logged_once(
    posts: tuple[str, SimpleQueue[dict[str, object]]],
    path: str,
    values: list[str],
    caplog: pytest.LogCaptureFixture,
) -> None:
    address, heard = posts
    hook = WebhookReceiver(address + path, AT_ONCE)
    for number in range(3):
        hook.send_announcement(Announcement("part", f"part {number}", READY))
    assert [heard.get(timeout=60)["text"] for _ in range(3)] == [f"part {n}" for n in range(3)]
    hook.close()
    ((who, why),) = [values_of(each) for each in caplog.records]
    assert who == address.removesuffix("/hook")
    assert all(value in why for value in values)


@pytest.mark.parametrize(("path", "values"), [("503", ["503 Service Unavailable"]), ("garbage", ["HTTP"])])
def test_host_with_an_error_is_retried_and_logged_once(
    posts: tuple[str, SimpleQueue[dict[str, object]]],
    path: str,
    values: list[str],
    caplog: pytest.LogCaptureFixture,
) -> None:
    address, heard = posts
    hook = WebhookReceiver(address + path, AT_ONCE)
    hook.send_announcement(Announcement("alarm", "ALARM", READY))
    assert [heard.get(timeout=60)["text"] for _ in range(3)] == ["ALARM"] * 3
    hook.close()
    ((who, why),) = [values_of(each) for each in caplog.records]
    assert who == address.removesuffix("/hook")
    assert all(value in why for value in values)


def test_webhook_that_was_offline_receives_everything_in_order(caplog: pytest.LogCaptureFixture) -> None:
    asked: SimpleQueue[str] = SimpleQueue()
    away = iter([True, True, True])

    def post(_address: str, body: bytes) -> None:
        asked.put(json.loads(body)["text"])
        if next(away, False):
            raise URLError(OSError(111, "Connection refused"))

    hook = WebhookReceiver("http://shop/hook", AT_ONCE, post)
    for word in ("first", "second"):
        hook.send_announcement(Announcement("stop", word, READY))
    assert [asked.get(timeout=60) for _ in range(5)] == ["first"] * 4 + ["second"]
    hook.close()
    (said,) = [values_of(each) for each in caplog.records]
    assert said == ("http://shop", text("shopfloor.refused"))


def test_each_cause_is_logged_once_until_a_delivery_succeeds(caplog: pytest.LogCaptureFixture) -> None:
    asked: SimpleQueue[str] = SimpleQueue()
    answers = iter(["refused", "refused", "no route", "refused", "", "refused", ""])

    def post(_address: str, body: bytes) -> None:
        if why := next(answers):
            raise OSError(1, why)
        asked.put(json.loads(body)["text"])

    hook = WebhookReceiver("http://shop/hook", AT_ONCE, post)
    for word in ("first", "second"):
        hook.send_announcement(Announcement("stop", word, READY))
        assert asked.get(timeout=60) == word
    hook.close()
    assert [values_of(each)[1] for each in caplog.records] == [
        "refused", "no route", "refused"
    ]  # fmt: skip


def test_changing_error_texts_do_not_fill_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    trouble = DeliveryErrorLog(logging.getLogger("hook"), "http://shop/hook")
    for number in range(100):
        trouble.log_cause(str(number))
    assert len(caplog.records) == 10


def test_newest_hundred_are_queued_for_an_unreachable_webhook() -> None:
    asked: SimpleQueue[int] = SimpleQueue()
    dead, queued = threading.Event(), threading.Event()

    def post(_address: str, body: bytes) -> None:
        asked.put(int(json.loads(body)["text"]))
        assert queued.wait(60)
        if not dead.is_set():
            dead.set()
            raise OSError(113, "No route to host")

    hook = WebhookReceiver("http://shop/hook", AT_ONCE, post)
    hook.send_announcement(Announcement("part", "0", READY))
    assert asked.get(timeout=60) == 0
    for number in range(1, MAX_QUEUED + 31):
        hook.send_announcement(Announcement("part", str(number), READY))
    queued.set()
    assert [asked.get(timeout=60) for _ in range(MAX_QUEUED)] == list(range(31, MAX_QUEUED + 31))
    hook.close()


class Far:
    """The other end of one connection after the other, played by ``play`` on a thread."""

    def __init__(self, play: Callable[[socket.socket], object]) -> None:
        self._play, self._listening = play, socket.create_server(("127.0.0.1", 0))
        self.port = self._listening.getsockname()[1]
        self.ended: SimpleQueue[None] = SimpleQueue()  # a connection
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def _serve(self) -> None:
        with suppress(OSError):
            while True:
                with self._listening.accept()[0] as connection, suppress(OSError):
                    connection.recv(1000)
                    self._play(connection)
                    connection.shutdown(socket.SHUT_WR)
                    while connection.recv(4096):  # closing with unread bytes would reset it
                        pass
                self.ended.put(None)

    def __enter__(self) -> Far:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._listening.shutdown(socket.SHUT_RDWR)
        self._listening.close()
        self._thread.join()


def test_slow_response_has_an_overall_deadline() -> None:
    """Two seconds pass before each byte; a byte comes when the one before was read."""
    times, reads = count(0.0, 2.0), threading.Semaphore(0)

    def clock() -> float:
        reads.release()
        return next(times)

    def drip(connection: socket.socket) -> None:
        assert reads.acquire(timeout=60)  # of the connection itself
        for byte in b"HTTP/1.1 204 No Content\r\n\r\n":
            assert reads.acquire(timeout=60)
            connection.sendall(bytes([byte]))

    with Far(drip) as far:
        with pytest.raises(TimeoutError):
            post_json(f"http://127.0.0.1:{far.port}/", b"{}", clock)
        reads.release(100)


def test_response_in_time_is_accepted() -> None:
    with Far(lambda connection: connection.sendall(b"HTTP/1.1 204 No Content\r\n\r\n")) as far:
        post_json(f"http://127.0.0.1:{far.port}/", b"{}", lambda: 0.0)


def not_trusted() -> ssl.SSLCertVerificationError:
    error = ssl.SSLCertVerificationError(1, "[SSL: CERTIFICATE_VERIFY_FAILED] (_ssl.c:1)")
    error.verify_message = "self-signed certificate"
    return error


@pytest.mark.parametrize(
    ("answer", "scheme", "why"),
    [
        (b"", "http", "shopfloor.no-word"),
        (b"\x15\x03\x01\x00\x02\x02\x46", "http", "shopfloor.tls-only"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", "https", "shopfloor.no-tls"),
        (b"SSH-2.0-OpenSSH_9.2\r\n", "http", "shopfloor.no-http"),
    ],
)
def test_invalid_host_response_is_reported_as_the_cause(answer: bytes, scheme: str, why: str) -> None:
    with Far(lambda connection: connection.sendall(answer)) as far:
        with pytest.raises((OSError, HTTPException)) as raised:
            post_json(f"{scheme}://127.0.0.1:{far.port}/", b"{}")
        assert read_turndesk_status(f"{scheme}://127.0.0.1:{far.port}/").error_text == text(why)
    assert describe_connection_error(raised.value) == text(why)


def test_invalid_certificate_is_reported_as_the_cause() -> None:
    assert describe_connection_error(URLError(not_trusted())) == text(
        "shopfloor.bad-certificate", why="self-signed certificate"
    )


@pytest.mark.parametrize(
    "address", ["https://hooks.shop/services/secret", "http://me:secret@shop:81/?t=secret"]
)
def test_log_contains_no_token_from_an_address(address: str, caplog: pytest.LogCaptureFixture) -> None:
    tried = threading.Event()

    def post(address: str, _body: bytes) -> None:
        tried.set()
        raise InvalidURL(f"URL can't contain control characters. {address!r}")

    hook = WebhookReceiver(address, 60.0, post)
    hook.send_announcement(Announcement("part", "part 1", READY))
    assert tried.wait(60)
    hook.close()
    hook._thread.join(60)
    assert len(caplog.records) == 1
    assert "secret" not in caplog.text


# --- an MQTT broker ---------------------------------------------------------------------------------


def table(port: int) -> AnnounceTable:
    return AnnounceTable(f"127.0.0.1:{port}", "shop/gt75", "", "", "", 1.0)


def test_unreachable_broker_does_not_block_the_caller() -> None:
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        broker = MqttReceiver(table(nobody.getsockname()[1]))
        broker.send_status(READY)
        for _ in range(300):
            broker.send_announcement(Announcement("part", "", READY))
        broker.close()


class Logged(logging.Handler):
    """What the broker's side says, as it comes."""

    def __init__(self) -> None:
        super().__init__()
        self._said: SimpleQueue[tuple[str, ...]] = SimpleQueue()

    def emit(self, record: logging.LogRecord) -> None:
        self._said.put(values_of(record))

    def empty(self) -> bool:
        return self._said.empty()

    def why(self, port: int) -> str:
        """Why the broker at this port is not told; one of another test may say its last word yet."""
        while not (said := self._said.get(timeout=60))[0].endswith(f" 127.0.0.1:{port}"):
            pass
        return said[1]


@pytest.fixture
def logged() -> Iterator[Logged]:
    heard = Logged()
    logger = logging.getLogger("app.extras.office.mqtt_broker")
    logger.addHandler(heard)
    yield heard
    logger.removeHandler(heard)


def test_refused_broker_connection_is_logged(logged: Logged) -> None:
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        port = nobody.getsockname()[1]
        broker = MqttReceiver(table(port))
        assert logged.why(port) == text("shopfloor.refused")
        broker.close()


@pytest.mark.parametrize(
    ("connack", "why"),
    [
        (b"\x20\x02\x00\x05", "shopfloor.mqtt-not-authorized"),
        (b"\x20\x02\x00\x04", "shopfloor.mqtt-password"),
        (b"", "shopfloor.mqtt-no-word"),
        (b"\x15\x03\x03\x00\x02\x02\x46", "shopfloor.mqtt-no-word"),
    ],
)
def test_broker_rejection_is_the_only_logged_cause(connack: bytes, why: str, logged: Logged) -> None:
    with Far(lambda connection: connection.sendall(connack)) as far:
        broker = MqttReceiver(table(far.port))
        assert logged.why(far.port) == text(why)
        for _ in range(2):
            far.ended.get(timeout=60)
        broker.close()
    assert logged.empty()


@pytest.mark.parametrize(
    ("cause", "why"),
    [
        (socket.gaierror(socket.EAI_NONAME, "Name or service not known"), "Name or service not known"),
        (OSError(errno.EHOSTUNREACH, "No route to host"), "No route to host"),
        (TimeoutError("timed out"), text("shopfloor.no-answer")),
        (UnicodeError("label empty or too long"), "label empty or too long"),
    ],
)
def test_reason_for_an_unreachable_broker_is_logged(
    cause: Exception, why: str, logged: Logged, monkeypatch: pytest.MonkeyPatch
) -> None:
    tries: SimpleQueue[None] = SimpleQueue()

    def refuse(_address: object, *_more: object, **_words: object) -> socket.socket:
        tries.put(None)
        raise cause

    monkeypatch.setattr(socket, "create_connection", refuse)
    broker = MqttReceiver(table(1883))
    assert logged.why(1883) == why
    tries.get(timeout=60)
    if isinstance(cause, ValueError):
        tries.get(timeout=60)  # paho's thread goes on, though it knows no such error
    broker.close()


def test_silent_server_is_logged_as_not_responding(logged: Logged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mqtt_broker, "KEEP_ALIVE_S", 1)
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        broker = MqttReceiver(table(port))
        assert logged.why(port) == text("shopfloor.no-answer")
        broker.close()


def test_close_does_not_wait_for_a_silent_broker(monkeypatch: pytest.MonkeyPatch) -> None:
    """A host that swallows everything keeps paho's thread waiting, not the desk."""
    connecting, over = threading.Event(), threading.Event()

    def swallowed(_address: object, *_more: object, **_words: object) -> socket.socket:
        connecting.set()
        over.wait()
        raise TimeoutError("timed out")

    monkeypatch.setattr(socket, "create_connection", swallowed)
    broker = MqttReceiver(table(1883))
    assert connecting.wait(60)
    broker.close()
    assert not over.is_set()
    over.set()


MOSQUITTO = shutil.which("mosquitto") or shutil.which("mosquitto", path="/usr/sbin")


@pytest.fixture
def mosquitto(tmp_path: Path) -> Iterator[tuple[int, int]]:
    """Eclipse's broker, by its port and its process."""
    if MOSQUITTO is None:
        pytest.skip("mosquitto is not installed: no MQTT broker that is not ours")
    port = free_port()
    config = tmp_path / "mosquitto.conf"
    config.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
    with subprocess.Popen([MOSQUITTO, "-c", str(config)], stderr=subprocess.PIPE) as running:
        assert running.stderr is not None
        while b"running" not in running.stderr.readline():
            assert running.poll() is None
        yield port, running.pid
        running.terminate()


class Office:
    """Somebody at the broker who hears all of it."""

    def __init__(self, port: int) -> None:
        self._heard: SimpleQueue[tuple[str, bytes, bool]] = SimpleQueue()
        self.client = mqtt.Client(CallbackAPIVersion.VERSION2)
        self.client.on_message = lambda _c, _d, message: self._heard.put(
            (message.topic, bytes(message.payload), message.retain)
        )
        self.client.on_subscribe = lambda *_all: self._heard.put(("subscribed", b"", False))
        self.client.connect("127.0.0.1", port)
        self.client.subscribe("shop/#", 1)
        self.client.loop_start()
        assert self.next()[0] == "subscribed"

    def next(self) -> tuple[str, bytes, bool]:
        """Topic, what is said, whether it was retained."""
        return self._heard.get(timeout=60)

    def close(self) -> None:
        self.client.disconnect()
        self.client.loop_stop()


@pytest.fixture
def office(mosquitto: tuple[int, int]) -> Iterator[Office]:
    office = Office(mosquitto[0])
    yield office
    office.close()


def test_broker_receives_state_events_and_the_end(mosquitto: tuple[int, int], office: Office) -> None:
    broker = MqttReceiver(table(mosquitto[0]))
    assert office.next() == ("shop/gt75/available", b"online", False)
    broker.send_status(RUNNING)
    topic, payload, _ = office.next()
    assert (topic, json.loads(payload)) == ("shop/gt75/state", RUNNING)
    broker.send_announcement(Announcement("part", "part 4 of pin.nc is done", RUNNING))
    topic, payload, _ = office.next()
    assert topic == "shop/gt75/event"
    assert json.loads(payload)["text"] == "part 4 of pin.nc is done"
    broker.close()
    assert office.next() == ("shop/gt75/available", b"offline", False)
    office.client.unsubscribe("shop/#")
    office.client.subscribe("shop/gt75/state", 1)  # who comes later sees the last state
    while not (late := office.next())[2]:
        pass
    assert json.loads(late[1]) == RUNNING


def test_reconnected_broker_receives_state_and_the_newest_hundred(
    mosquitto: tuple[int, int], office: Office, monkeypatch: pytest.MonkeyPatch
) -> None:
    away: list[mqtt.Client] = []

    def begins_later(client: mqtt.Client) -> None:
        away.append(client)

    with monkeypatch.context() as cable_out:
        cable_out.setattr(mqtt.Client, "loop_start", begins_later)
        broker = MqttReceiver(table(mosquitto[0]))
        broker.send_status(READY)
        for number in range(MAX_QUEUED + 30):
            broker.send_announcement(Announcement("part", str(number), READY))
    away[0].loop_start()
    assert office.next() == ("shop/gt75/available", b"online", False)
    assert office.next()[0] == "shop/gt75/state"
    assert [json.loads(office.next()[1])["text"] for _ in range(MAX_QUEUED)] == [
        str(number) for number in range(30, MAX_QUEUED + 30)
    ]
    broker.close()


def test_frozen_broker_is_logged(
    mosquitto: tuple[int, int], office: Office, logged: Logged, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its computer takes each new connection, and nobody there says a word."""
    monkeypatch.setattr(mqtt_broker, "KEEP_ALIVE_S", 1)
    port, process = mosquitto
    broker = MqttReceiver(table(port))
    assert office.next()[1] == b"online"
    os.kill(process, signal.SIGSTOP)
    try:
        assert logged.why(port) == text("shopfloor.no-answer")
    finally:
        os.kill(process, signal.SIGCONT)
    broker.close()


def test_close_does_not_wait_for_a_frozen_broker(mosquitto: tuple[int, int], office: Office) -> None:
    port, process = mosquitto
    broker = MqttReceiver(table(port))
    assert office.next()[1] == b"online"
    os.kill(process, signal.SIGSTOP)
    try:
        for number in range(MAX_QUEUED + 30):
            broker.send_announcement(Announcement("part", str(number), READY))
        broker.close()  # raises nothing, though what waits cannot go out
    finally:
        os.kill(process, signal.SIGCONT)
    assert office.next()[0] == "shop/gt75/event"  # not offline: that is its last will's
    broker.close()
