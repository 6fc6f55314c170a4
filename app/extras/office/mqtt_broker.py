"""An MQTT broker is told: TOPIC/available (offline by its last will), TOPIC/state, TOPIC/event."""

from __future__ import annotations

import json
import logging
import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import paho.mqtt.client as mqtt
from paho.mqtt.enums import CallbackAPIVersion, MQTTErrorCode

from app.extras.office.announcements import HELD, Announcement
from app.extras.office.timed_http import NO_ANSWER, Trouble, cause_of
from app.shopfloor.status_file import Status
from core.extras.office.shop_network_tables import AnnounceTable, broker_of
from core.message import Message

if TYPE_CHECKING:
    from paho.mqtt.properties import Properties
    from paho.mqtt.reasoncodes import ReasonCode

ONLINE, OFFLINE = "online", "offline"
_SURE = 1  # quality of service: at least once
KEEP_ALIVE = 15  # s; half as much again without a sign of us, and the broker tells our last will
_SILENT = "Keep alive timeout"  # as paho calls it
_NO_WORD = (
    "the server closed the connection without an MQTT response; check whether the server "
    "uses this port without TLS"
)
_REFUSALS = {
    "Not authorized": ("the server rejects the user name or the password of [announce] (Not authorized)"),
    "Bad user name or password": "the server rejects the user name or the password of [announce]",
}
_log = logging.getLogger(__name__)


class _Client(mqtt.Client):
    """Paho's client, which keeps to itself why it could not connect."""

    failed: Callable[[Exception], None]

    def reconnect(self) -> MQTTErrorCode:
        """Called by paho's thread, which goes on behind an OSError and ends with any other."""
        try:
            return super().reconnect()
        except (OSError, ValueError) as error:  # ValueError: a name that can be none
            self.failed(error)
            raise OSError(str(error)) from error


class MqttBroker:
    """Connected by a thread of paho's own, and again whenever the broker was away."""

    def __init__(self, table: AnnounceTable) -> None:
        self._topic = table.topic.rstrip("/")
        self._state = b""
        self._answered = self._refused = False  # by the connection that there is; paho's thread alone
        self._waiting: deque[Announcement] = deque(maxlen=HELD)
        self._handing = threading.Lock()  # the announcer's thread and paho's both hand over, in order
        self._client = client = _Client(CallbackAPIVersion.VERSION2)
        if table.user:
            client.username_pw_set(table.user, table.password or None)
        client.will_set(f"{self._topic}/available", OFFLINE, _SURE, retain=True)
        client.reconnect_delay_set(1, max(1, round(table.again)))
        client.on_connect = self._connected
        client.on_disconnect = self._disconnected
        host, port = broker_of(table.mqtt)
        self._trouble = Trouble(_log, Message("the MQTT broker {host}:{port}", host=host, port=port))
        client.failed = lambda error: self._trouble.say(cause_of(error))
        client.connect_async(host, port, KEEP_ALIVE)
        client.loop_start()

    def state(self, status: Status) -> None:
        """Retained: whoever comes later sees it too. While the broker is away the newest waits."""
        self._state = json.dumps(status).encode()
        if self._client.is_connected():
            self._client.publish(f"{self._topic}/state", self._state, _SURE, retain=True)

    def tell(self, announcement: Announcement) -> None:
        """Not retained; the newest hundred wait for a broker that is away."""
        self._waiting.append(announcement)
        self._hand_over()

    def close(self) -> None:
        """Offline by our own word: a last will is told only where a connection breaks.

        To a broker that takes no word we say no good-bye either: it tells our last will when this process
        has ended. Paho's thread, which may wait for a broker that is away, ends with the process.
        """
        if not self._client.is_connected():
            self._client.disconnect()
        elif self._said_offline():
            self._client.disconnect()
            self._client.loop_stop()

    def _said_offline(self) -> bool:
        told = self._client.publish(f"{self._topic}/available", OFFLINE, _SURE, retain=True)
        try:
            told.wait_for_publish(1.0)
            return told.is_published()
        except RuntimeError:  # the connection was lost since we asked
            return True

    def _hand_over(self) -> None:
        """Give paho what waits, once there is a broker: a full queue of paho's refuses what is newest."""
        with self._handing:
            while self._waiting and self._client.is_connected():
                event = self._waiting.popleft().json()
                self._client.publish(f"{self._topic}/event", event, _SURE)

    def _connected(
        self,
        client: mqtt.Client,
        _data: Any,
        _flags: mqtt.ConnectFlags,
        reason: ReasonCode,
        _more: Properties | None,
    ) -> None:
        self._answered = True
        if reason.is_failure:
            self._refused = True
            self._trouble.say(_REFUSALS.get(reason.getName(), str(reason)))
            return
        self._trouble.over()
        client.publish(f"{self._topic}/available", ONLINE, _SURE, retain=True)
        if self._state:
            client.publish(f"{self._topic}/state", self._state, _SURE, retain=True)
        self._hand_over()

    def _disconnected(
        self,
        _client: mqtt.Client,
        _data: Any,
        _flags: mqtt.DisconnectFlags,
        reason: ReasonCode,
        _more: Properties | None,
    ) -> None:
        """Also where a host takes the connection and says no word: paho gives it up behind the keep-alive."""
        answered, refused = self._answered, self._refused
        self._answered = self._refused = False
        if refused or not reason.is_failure:  # the refusal has said the cause
            return
        if str(reason) == _SILENT:
            self._trouble.say(NO_ANSWER)
        else:
            self._trouble.say("the connection was lost" if answered else _NO_WORD)
