"""Who is told of ends and stops: what is told, in which order, and what happens where nobody answers."""

from __future__ import annotations

import json
import shutil
import socket
import subprocess
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from queue import SimpleQueue

import paho.mqtt.client as mqtt
import pytest
from paho.mqtt.enums import CallbackAPIVersion

from app.shopfloor.announcements import Announcement, Announcer, WebHook, happened
from app.shopfloor.mqtt_broker import MqttBroker
from app.shopfloor.status_file import Status
from core.machine.shop_network_tables import AnnounceTable

READY: Status = {"state": "READY", "program": "pin.nc", "made": 3, "stop": "", "waiting_for": ""}
RUNNING: Status = {**READY, "state": "RUNNING"}


def told(before: Status, now: Status) -> list[tuple[str, str]]:
    return [(each.kind, each.text) for each in happened(before, now)]


# --- what has happened ------------------------------------------------------------------------------


def test_the_first_look_tells_nothing() -> None:
    assert told({}, {**READY, "state": "ALARM"}) == []


def test_a_part_is_done() -> None:
    assert told(RUNNING, {**RUNNING, "made": 4}) == [("part", "part 4 of pin.nc is done")]


def test_another_program_with_a_greater_count_is_no_part() -> None:
    assert told(READY, {**READY, "program": "nut.nc", "made": 90}) == []


def test_a_count_put_back_is_no_part() -> None:
    assert told(READY, {**READY, "made": 0}) == []


def test_a_stop_and_an_alarm_say_why() -> None:
    hold: Status = {**RUNNING, "state": "FEED HOLD", "stop": "GUARD OPEN"}
    alarm: Status = {**RUNNING, "state": "ALARM", "stop": "FOLLOWING ERROR: X"}
    assert told(RUNNING, hold) == [("stop", "FEED HOLD: GUARD OPEN")]
    assert told(RUNNING, alarm) == [("alarm", "ALARM: FOLLOWING ERROR: X")]


def test_waiting_for_the_spindle_is_no_stop() -> None:
    waits: Status = {**RUNNING, "state": "WAITING", "waiting_for": "AT SPEED"}
    assert told(RUNNING, waits) == []
    assert told(waits, RUNNING) == []


def test_a_tool_at_the_end_of_its_life() -> None:
    worn: Status = {**RUNNING, "next_barred": "T3 HAS CUT 400 PARTS"}
    assert told(RUNNING, worn) == [("tool-life", "T3 HAS CUT 400 PARTS")]
    assert told(worn, worn) == []


class Heard:
    """Somebody who is told."""

    def __init__(self) -> None:
        self.states: list[str] = []
        self.events: list[str] = []

    def state(self, status: Status) -> None:
        self.states.append(str(status["state"]))

    def tell(self, announcement: Announcement) -> None:
        self.events.append(announcement.kind)

    def close(self) -> None:
        self.events.append("closed")


def test_a_state_is_told_when_it_changes_and_not_with_every_second() -> None:
    looks = iter(
        [READY, {**RUNNING, "time_left": 9.0}, {**RUNNING, "time_left": 8.0}, {**RUNNING, "made": 4}]
    )
    heard = Heard()
    announcer = Announcer(lambda: next(looks), [heard])
    for _ in range(4):
        announcer.once()
    announcer.close()
    assert heard.states == ["READY", "RUNNING", "RUNNING"]
    assert heard.events == ["runs", "part", "closed"]


# --- a web hook -------------------------------------------------------------------------------------


@pytest.fixture
def posts() -> Iterator[tuple[str, SimpleQueue[dict[str, object]]]]:
    """A server that takes what is posted, and its address."""
    heard: SimpleQueue[dict[str, object]] = SimpleQueue()

    class Taker(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            heard.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()

        def log_message(self, *_words: object) -> None:
            pass

    server = HTTPServer(("127.0.0.1", 0), Taker)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}/hook", heard
    server.shutdown()
    thread.join()
    server.server_close()


def test_a_web_hook_hears_in_order(posts: tuple[str, SimpleQueue[dict[str, object]]]) -> None:
    address, heard = posts
    hook = WebHook(address)
    for number in range(5):
        hook.tell(Announcement("part", f"part {number}", READY))
    assert [heard.get(timeout=60)["text"] for _ in range(5)] == [f"part {n}" for n in range(5)]
    hook.close()


def test_a_web_hook_that_is_away_is_told_of_once(caplog: pytest.LogCaptureFixture) -> None:
    asked: SimpleQueue[str] = SimpleQueue()

    def away(address: str, _body: bytes) -> None:
        asked.put(address)
        raise OSError(111, "Connection refused")

    hook = WebHook("http://shop/hook", away)
    for _ in range(3):
        hook.tell(Announcement("stop", "FEED HOLD", READY))
        asked.get(timeout=60)
    hook.tell(Announcement("stop", "FEED HOLD", READY))
    asked.get(timeout=60)  # the three before are worked off
    hook.close()
    assert [each.getMessage() for each in caplog.records] == [
        "http://shop/hook cannot be told: [Errno 111] Connection refused"
    ]


# --- an MQTT broker ---------------------------------------------------------------------------------


def table(port: int) -> AnnounceTable:
    return AnnounceTable(f"127.0.0.1:{port}", "shop/gt75", "", "", "", 1.0)


def test_a_broker_that_is_away_keeps_nobody_waiting() -> None:
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))
        broker = MqttBroker(table(nobody.getsockname()[1]))
        broker.state(READY)
        for _ in range(300):
            broker.tell(Announcement("part", "", READY))
        broker.close()


MOSQUITTO = shutil.which("mosquitto") or shutil.which("mosquitto", path="/usr/sbin")


@pytest.fixture
def mosquitto(tmp_path: Path) -> Iterator[int]:
    """Eclipse's broker, by its port."""
    if MOSQUITTO is None:
        pytest.skip("mosquitto is not installed: no MQTT broker that is not ours")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    config = tmp_path / "mosquitto.conf"
    config.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\n")
    with subprocess.Popen([MOSQUITTO, "-c", str(config)], stderr=subprocess.PIPE) as running:
        assert running.stderr is not None
        while b"running" not in running.stderr.readline():
            assert running.poll() is None
        yield port
        running.terminate()


def test_a_broker_hears_state_events_and_the_end(mosquitto: int) -> None:
    heard: SimpleQueue[tuple[str, bytes, bool]] = SimpleQueue()
    office = mqtt.Client(CallbackAPIVersion.VERSION2)
    office.on_message = lambda _c, _d, message: heard.put(
        (message.topic, bytes(message.payload), message.retain)
    )
    office.on_subscribe = lambda *_all: heard.put(("subscribed", b"", False))
    office.connect("127.0.0.1", mosquitto)
    office.subscribe("shop/#", 1)
    office.loop_start()
    assert heard.get(timeout=60)[0] == "subscribed"
    broker = MqttBroker(table(mosquitto))
    assert heard.get(timeout=60) == ("shop/gt75/available", b"online", False)
    broker.state(RUNNING)
    topic, payload, _ = heard.get(timeout=60)
    assert (topic, json.loads(payload)) == ("shop/gt75/state", RUNNING)
    broker.tell(Announcement("part", "part 4 of pin.nc is done", RUNNING))
    topic, payload, _ = heard.get(timeout=60)
    assert topic == "shop/gt75/event"
    assert json.loads(payload)["text"] == "part 4 of pin.nc is done"
    broker.close()
    assert heard.get(timeout=60) == ("shop/gt75/available", b"offline", False)
    office.unsubscribe("shop/#")
    office.subscribe("shop/gt75/state", 1)  # who comes later sees the last state
    while not (late := heard.get(timeout=60))[2]:
        pass
    assert json.loads(late[1]) == RUNNING
    office.disconnect()
    office.loop_stop()
