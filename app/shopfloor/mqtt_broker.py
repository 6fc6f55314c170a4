"""An MQTT broker is told: TOPIC/available (offline by its last will), TOPIC/state, TOPIC/event."""

from __future__ import annotations

import json
import logging
import threading
from collections import deque
from typing import TYPE_CHECKING, Any

import paho.mqtt.client as mqtt
from paho.mqtt.enums import CallbackAPIVersion

from app.shopfloor.announcements import HELD, Announcement
from app.shopfloor.status_file import Status
from core.machine.shop_network_tables import AnnounceTable, broker_of

if TYPE_CHECKING:
    from paho.mqtt.properties import Properties
    from paho.mqtt.reasoncodes import ReasonCode

ONLINE, OFFLINE = "online", "offline"
_SURE = 1  # quality of service: at least once
_KEEP_ALIVE = 15  # s; half as much again without a sign of us, and the broker tells our last will
_log = logging.getLogger(__name__)


class MqttBroker:
    """Connected by a thread of paho's own, and again whenever the broker was away."""

    def __init__(self, table: AnnounceTable) -> None:
        self._topic = table.topic.rstrip("/")
        self._state = b""
        self._failed = False
        self._waiting: deque[Announcement] = deque(maxlen=HELD)
        self._handing = threading.Lock()  # the announcer's thread and paho's both hand over, in order
        self._client = mqtt.Client(CallbackAPIVersion.VERSION2)
        client = self._client
        if table.user:
            client.username_pw_set(table.user, table.password or None)
        client.will_set(f"{self._topic}/available", OFFLINE, _SURE, retain=True)
        client.reconnect_delay_set(1, max(1, round(table.again)))
        client.on_connect = self._connected
        client.on_connect_fail = self._not_connected
        host, port = broker_of(table.mqtt)
        self._at = f"{host}:{port}"
        client.connect_async(host, port, _KEEP_ALIVE)
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
        has ended, and paho's thread, which would wait for it, ends with the process.
        """
        if self._client.is_connected() and not self._said_offline():
            return
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
        if reason.is_failure:
            self._tell_trouble(str(reason))
            return
        self._failed = False
        client.publish(f"{self._topic}/available", ONLINE, _SURE, retain=True)
        if self._state:
            client.publish(f"{self._topic}/state", self._state, _SURE, retain=True)
        self._hand_over()

    def _not_connected(self, _client: mqtt.Client, _data: Any) -> None:
        self._tell_trouble("no answer")

    def _tell_trouble(self, why: str) -> None:
        if not self._failed:
            _log.warning("the broker %s cannot be told: %s", self._at, why)
        self._failed = True
