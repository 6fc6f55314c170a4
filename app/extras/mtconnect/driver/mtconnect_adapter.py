"""MTConnect adapter, and the device model (``Devices.xml``) that describes its data items.

Each agent receives the complete state first, and then the changes. Values are in millimeters. The device
model has no ``nativeUnits``, so the agent does not convert the values.
"""

from __future__ import annotations

import logging
import re
import selectors
import socket
import threading
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from app.extras.mtconnect.driver.agent_links import (
    AgentDisconnectedError,
    AgentLink,
    AgentLostError,
    MachineReport,
    SentMachineState,
    accept_connection,
    format_utc_time,
    open_listening_socket,
)
from app.extras.mtconnect.driver.mtconnect_items import Component, DataItem
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from core.ports import Clock, DriverError

REPORT_INTERVAL_S = 0.1  # seconds between two reports
MAX_AGENTS = 8  # agents at a time
_AT_DOOR = 4  # agents that can wait for a connection without PING
CLOSE_TIMEOUT_S = 2.0  # seconds that closing waits for the thread
_log = logging.getLogger(__name__)


@dataclass(slots=True)
class ConnectionCounts:
    """Numbers of connections and ignored lines since the adapter was opened."""

    accepted_count: int = 0
    rejected_count: int = 0  # connections beyond the limit
    lost_count: int = 0
    ignored_line_count: int = 0  # lines other than PING from agents that are gone


def get_utc_now() -> datetime:
    """Return the current time in UTC."""
    return datetime.now(UTC)


class MtconnectAdapter:
    """Adapter that reports the machine state to MTConnect agents.

    The owner calls ``run_once`` repeatedly. ``read_report`` is a function that returns the current state of
    the machine.
    """

    def __init__(
        self,
        settings: MtconnectTable,
        items: tuple[DataItem, ...],
        read_report: Callable[[], MachineReport],
        clock: Clock,
        get_utc: Callable[[], datetime] = get_utc_now,
    ) -> None:
        self._settings, self._report, self._clock, self._utc = settings, read_report, clock, get_utc
        self._sent = SentMachineState(items)
        self._door: socket.socket | None = None
        self._selector = selectors.DefaultSelector()
        self._links: list[AgentLink] = []
        self._next_look = 0.0
        self.counts = ConnectionCounts()

    @property
    def address(self) -> tuple[str, int]:
        """Return the address and port of the listening socket."""
        assert self._door is not None
        host, port = self._door.getsockname()[:2]
        return host, port

    @property
    def agent_count(self) -> int:
        """Return the number of agents that receive data."""
        return len(self._served())

    def _served(self) -> list[AgentLink]:
        return [link for link in self._links if link.waiting_since is None]

    def open(self) -> None:
        """Start listening for agents.

        Raises DriverError if the port cannot be opened.
        """
        try:
            self._door = open_listening_socket(self._settings.bind, self._settings.port)
        except DriverError:
            self._selector.close()
            raise
        self._selector.register(self._door, selectors.EVENT_READ)
        self.send_changes()

    def run_once(self, timeout_s: float = 0.0) -> None:
        """Process pending network events, and send a report when it is due.

        The method waits for data until the next report is due, but at most ``timeout_s`` seconds.
        """
        left = max(self._next_look - self._clock.now(), 0.0)
        for key, _ in self._selector.select(min(timeout_s, left)):
            if key.data is None:
                self._welcome()
            else:
                self._serve(key.data)
        if self._clock.now() >= self._next_look:
            self.send_changes()

    def close(self) -> None:
        """Disconnect all agents, which then report all values as unavailable."""
        for link in self._links.copy():
            self._forget(link)
        if self._door is not None:
            self._selector.unregister(self._door)
            self._door.close()
            self._door = None
        self._selector.close()

    def send_changes(self) -> None:
        """Send the changes of the machine state to all agents."""
        self._next_look = self._clock.now() + REPORT_INTERVAL_S
        changes = self._sent.make_change_lines(self._report(), format_utc_time(self._utc())).encode("utf-8")
        for link in self._links.copy():
            self._tell(link, changes)

    def _tell(self, link: AgentLink, data: bytes) -> None:
        try:
            link.check_timeout(self._clock.now())
            if link.waiting_since is None:
                link.queue_data(data)
                link.flush()
        except AgentLostError as lost:
            self._lose(link, lost)

    def _welcome(self) -> None:
        assert self._door is not None
        try:
            wire = accept_connection(self._door)
        except OSError:  # the peer has gone or no file is free; the next turn tries again
            return
        if len(self._links) >= MAX_AGENTS + _AT_DOOR:
            self.counts.rejected_count += 1
            wire.close()
            return
        full = len(self._served()) >= MAX_AGENTS
        link = AgentLink(wire, self._settings.heartbeat, self._clock.now() if full else None)
        self._links.append(link)
        self._selector.register(wire, selectors.EVENT_READ, link)
        if not full:
            self._admit(link)

    def _admit(self, link: AgentLink) -> None:
        link.waiting_since = None
        self.counts.accepted_count += 1
        self._tell(link, self._sent.make_complete_state_lines(format_utc_time(self._utc())).encode("utf-8"))

    def _make_room(self, link: AgentLink) -> None:
        """Start sending data to a waiting agent, or disconnect it if no connection can be freed.

        If all connections are in use, the first one whose agent has never sent a PING is closed.
        """
        served = self._served()
        silent = next((other for other in served if not other.has_pinged), None)
        if len(served) >= MAX_AGENTS and silent is None:
            self.counts.rejected_count += 1
            self._forget(link)
            return
        if len(served) >= MAX_AGENTS and silent is not None:
            self._lose(
                silent,
                AgentDisconnectedError("the agent never sent a PING, and another agent needs the connection"),
            )
        self._admit(link)

    def _serve(self, link: AgentLink) -> None:
        try:
            link.read_data(self._clock.now())
            if link.waiting_since is not None and link.has_pinged:
                self._make_room(link)
            else:
                link.flush()
        except AgentLostError as lost:
            self._lose(link, lost)

    def _lose(self, link: AgentLink, why: AgentLostError) -> None:
        self.counts.lost_count += 1
        level = logging.INFO if isinstance(why, AgentDisconnectedError) else logging.WARNING
        _log.log(
            level,
            "an MTConnect agent is no longer served: %s; %d lines ignored",
            why,
            link.ignored_line_count,
        )
        self._forget(link)

    def _forget(self, link: AgentLink) -> None:
        self.counts.ignored_line_count += link.ignored_line_count
        self._links.remove(link)
        self._selector.unregister(link.agent_socket)
        link.agent_socket.close()


# --- Thread of the adapter. ---------------


_BREATH = 0.005  # seconds between two turns, which limits the load by a flooding agent


class AdapterThread:
    """Thread that runs the MTConnect adapter until the adapter is closed or fails.

    If the adapter fails, all agents are disconnected.
    """

    def __init__(self, adapter: MtconnectAdapter) -> None:
        self._adapter = adapter
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._keep, name="mtconnect", daemon=True)

    @property
    def is_alive(self) -> bool:
        """Return whether the thread is running."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Open the port and start the thread.

        Raises DriverError, without starting it, if the port cannot be opened.
        """
        self._adapter.open()
        self._thread.start()

    def close(self) -> None:
        """Disconnect the agents and stop the thread, waiting at most ``CLOSE_TIMEOUT_S`` seconds."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(CLOSE_TIMEOUT_S)

    def _keep(self) -> None:
        try:
            while not self._closing.wait(_BREATH):
                self._adapter.run_once(REPORT_INTERVAL_S)
            self._adapter.send_changes()  # reports the final state
        finally:
            if not self._closing.is_set():
                _log.error("there is no shop-floor data any more: a mistake of the control", exc_info=True)
            self._adapter.close()


# --- Device model for the reference agent. ---


SCHEMA_VERSION = "2.2"
SCHEMA_NAMESPACE = f"urn:mtconnect.org:MTConnectDevices:{SCHEMA_VERSION}"
_SCHEMA = f"{SCHEMA_NAMESPACE} http://schemas.mtconnect.org/schemas/MTConnectDevices_{SCHEMA_VERSION}.xsd"
_XSI = "http://www.w3.org/2001/XMLSchema-instance"
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_.-]*")


def make_devices_xml(device: Component, description_text: str, creation_time: datetime) -> str:
    """Return the device model as an XML document.

    ``description_text`` is for human readers. The uuid depends only on the device name. Raises DriverError
    if agents do not accept the device name.
    """
    if not _NAME.fullmatch(device.name):
        raise DriverError(
            "[mtconnect] device = {device}: use only letters, digits, ., - and _, and begin with a letter",
            device=f"{device.name!r}",
        )
    root = Element(
        "MTConnectDevices", {"xmlns": SCHEMA_NAMESPACE, "xmlns:xsi": _XSI, "xsi:schemaLocation": _SCHEMA}
    )
    root.append(_header(creation_time))
    inner = _element(device, device.name, SubElement(root, "Devices"))
    inner.set("uuid", str(uuid.uuid5(uuid.NAMESPACE_URL, f"urn:turndesk:{device.name}")))
    description = Element("Description")
    description.text = description_text
    inner.insert(0, description)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _header(time: datetime) -> Element:
    """Return the header element that the MTConnect schema requires.

    An agent replaces the values in the header with its own.
    """
    return Element(
        "Header",
        {
            "creationTime": format_utc_time(time),
            "sender": "turndesk",
            "instanceId": "1",
            "version": f"{SCHEMA_VERSION}.0.0",
            "assetBufferSize": "1024",
            "assetCount": "0",
            "bufferSize": "131072",
            "deviceModelChangeTime": format_utc_time(time),
        },
    )


def _element(component: Component, device: str, parent: Element) -> Element:
    """Return the XML element of a component with its items and sub-components, in schema order.

    Identifiers begin with the device name, so they are unique in an agent with several devices.
    """
    named = {"id": f"{device}_{component.component_type}_{component.name}", "name": component.name}
    element = SubElement(parent, component.component_type, named)
    if component.items:
        items = SubElement(element, "DataItems")
        for item in component.items:
            SubElement(items, "DataItem", _attributes(item, device))
    if component.sub_components:
        parts = SubElement(element, "Components")
        for part in component.sub_components:
            _element(part, device, parts)
    return element


def _attributes(item: DataItem, device: str) -> dict[str, str]:
    attributes = {
        "category": item.category.value,
        "id": f"{device}_{item.key}",
        "name": item.key,
        "type": item.item_type,
        "subType": item.sub_type,
        "units": item.units,
        "coordinateSystem": item.coordinate_system,
    }
    return {name: text for name, text in attributes.items() if text}
