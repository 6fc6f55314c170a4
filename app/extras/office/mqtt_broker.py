"""MQTT client that publishes the status and the announcements to a broker.

TOPIC is the topic in the table [announce]. The client publishes to TOPIC/state, TOPIC/event and
TOPIC/available. The last will sets TOPIC/available to offline.
"""

from __future__ import annotations

import json
import logging
import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import paho.mqtt.client as mqtt
from paho.mqtt.enums import CallbackAPIVersion, MQTTErrorCode

from app.extras.office.announcements import MAX_QUEUED, Announcement
from app.extras.office.timed_http import NO_RESPONSE_TEXT, DeliveryErrorLog, describe_connection_error
from app.shopfloor.status_file import StatusDocument
from core.extras.office.shop_network_tables import AnnounceTable, parse_broker_address
from core.message import Message

if TYPE_CHECKING:
    from paho.mqtt.properties import Properties
    from paho.mqtt.reasoncodes import ReasonCode

ONLINE, OFFLINE = "online", "offline"
_SURE = 1  # quality of service: at least once
KEEP_ALIVE_S = 15  # seconds; after 1.5 times this time without data, the broker publishes the last will
_SILENT = "Keep alive timeout"  # name used by paho
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
    """Paho MQTT client that reports why a connection has failed."""

    on_connection_failed: Callable[[Exception], None]

    def reconnect(self) -> MQTTErrorCode:
        """Reconnect to the broker, and report the reason if this fails.

        Paho's thread calls this method. The thread continues only if the error is an OSError.
        """
        try:
            return super().reconnect()
        except (OSError, ValueError) as error:  # ValueError: an invalid name
            self.on_connection_failed(error)
            raise OSError(str(error)) from error


class MqttReceiver:
    """Receiver that publishes the status and the announcements to an MQTT broker.

    Paho's thread reconnects when the broker is available again.
    """

    def __init__(self, table: AnnounceTable) -> None:
        self._topic = table.topic.rstrip("/")
        self._state = b""
        self._answered = self._refused = False  # for the present connection; used by paho's thread only
        self._waiting: deque[Announcement] = deque(maxlen=MAX_QUEUED)
        # preserves the order, because both the announcer's and paho's thread publish
        self._handing = threading.Lock()
        self._client = client = _Client(CallbackAPIVersion.VERSION2)
        if table.user:
            client.username_pw_set(table.user, table.password or None)
        client.will_set(f"{self._topic}/available", OFFLINE, _SURE, retain=True)
        client.reconnect_delay_set(1, max(1, round(table.again)))
        client.on_connect = self._connected
        client.on_disconnect = self._disconnected
        host, port = parse_broker_address(table.mqtt)
        self._trouble = DeliveryErrorLog(_log, Message("the MQTT broker {host}:{port}", host=host, port=port))
        client.on_connection_failed = lambda error: self._trouble.log_cause(describe_connection_error(error))
        client.connect_async(host, port, KEEP_ALIVE_S)
        client.loop_start()

    def send_status(self, status: StatusDocument) -> None:
        """Publish the status as a retained message.

        While the broker is unavailable, the latest status is stored and sent later.
        """
        self._state = json.dumps(status).encode()
        if self._client.is_connected():
            self._client.publish(f"{self._topic}/state", self._state, _SURE, retain=True)

    def send_announcement(self, announcement: Announcement) -> None:
        """Publish an announcement as a message that the broker does not retain.

        While the broker is unavailable, the latest 100 announcements are stored and sent later.
        """
        self._waiting.append(announcement)
        self._publish_waiting()

    def close(self) -> None:
        """Publish the offline status and disconnect.

        The broker sends the last will only after a broken connection, so the offline status must be
        published here. If the broker does not respond, the connection remains open until this process ends.
        The thread of paho then also ends, and the broker publishes the last will.
        """
        if not self._client.is_connected():
            self._client.disconnect()
        elif self._said_offline():
            self._client.disconnect()
            self._client.loop_stop()

    def _said_offline(self) -> bool:
        message_info = self._client.publish(f"{self._topic}/available", OFFLINE, _SURE, retain=True)
        try:
            message_info.wait_for_publish(1.0)
            return message_info.is_published()
        except RuntimeError:  # the connection was lost in the meantime
            return True

    def _publish_waiting(self) -> None:
        """Publish waiting announcements while the client is connected.

        They do not wait in the queue of paho, because a full queue rejects the latest announcement.
        """
        with self._handing:
            while self._waiting and self._client.is_connected():
                event = self._waiting.popleft().make_json()
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
            self._trouble.log_cause(_REFUSALS.get(reason.getName(), str(reason)))
            return
        self._trouble.clear_causes()
        client.publish(f"{self._topic}/available", ONLINE, _SURE, retain=True)
        if self._state:
            client.publish(f"{self._topic}/state", self._state, _SURE, retain=True)
        self._publish_waiting()

    def _disconnected(
        self,
        _client: mqtt.Client,
        _data: Any,
        _flags: mqtt.DisconnectFlags,
        reason: ReasonCode,
        _more: Properties | None,
    ) -> None:
        """Report a lost connection, or a host that accepts connections but never responds."""
        answered, refused = self._answered, self._refused
        self._answered = self._refused = False
        if refused or not reason.is_failure:  # the rejection has already reported the cause
            return
        if str(reason) == _SILENT:
            self._trouble.log_cause(NO_RESPONSE_TEXT)
        else:
            self._trouble.log_cause("the connection was lost" if answered else _NO_WORD)
