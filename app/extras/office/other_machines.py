"""Status of other machines for the status page. These machines run TurnDesk or an MTConnect agent.

The status is read only while a browser views the page.
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from http import HTTPStatus
from http.client import HTTPException
from typing import NamedTuple
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit, urlunsplit
from urllib.request import ProxyHandler
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from app.desk.translation import tr
from app.extras.office.status_page import LOADING_TEXT, OtherMachine
from app.extras.office.timed_http import describe_connection_error, make_single_line, make_url_opener
from core.message import Message

READ_INTERVAL_S = 3.0  # seconds
VIEW_TIMEOUT_S = 15.0  # seconds after which the page counts as not viewed
STALE_AFTER_S = 10.0  # seconds after which a status is outdated
_PATIENCE = 2.0  # seconds
_LARGEST = 1e9  # largest value; Python's JSON reader accepts Infinity and NaN
_MOST = 100_000  # bytes
_ASK = make_url_opener(ProxyHandler({}))  # machines of one shop are accessed without a proxy


def make_status_address(address: str) -> str:
    """Return the address of ``status.json`` for the address of a TurnDesk status page.

    The token remains in the query of the address.
    """
    parts = urlsplit(address)
    return urlunsplit(parts._replace(path=parts.path.rstrip("/") + "/status.json", fragment=""))


class MachineResponse(NamedTuple):
    """Data from the response of another machine, for display on the status page.

    ``error_text`` is the reason why the machine is stopped or why no status is available.
    """

    status_document: Mapping[str, object] | None
    error_text: str = ""


def read_turndesk_status(address: str) -> OtherMachine:
    """Read the status of a TurnDesk system, with a timeout of 2 s."""
    return request_machine_status(address, make_status_address(address), _MOST, _desk_answer)


def _desk_answer(data: bytes) -> MachineResponse:
    match json.loads(data):
        case dict() as found:
            return MachineResponse(found)
        case other:
            raise ValueError(other)


def request_machine_status(
    address: str, request_address: str, max_bytes: int, convert_response: Callable[[bytes], MachineResponse]
) -> OtherMachine:
    """Send a request to another machine and return its status.

    ``address`` identifies the machine, and ``request_address`` is the address of the request.
    ``convert_response`` converts the response and raises ValueError for invalid data. At most ``max_bytes``
    bytes are read. An error is returned as ``error_text`` of the result.
    """
    name = _name(address)
    try:
        with _ASK.open(request_address, timeout=_PATIENCE) as answer:
            status, error_text = convert_response(answer.read(max_bytes))
    except HTTPError as error:
        return OtherMachine(name, error_text=_refused(error))
    except (URLError, HTTPException, OSError) as error:
        return OtherMachine(name, error_text=describe_connection_error(error))
    except (ValueError, RecursionError):
        return OtherMachine(name, error_text=tr("the server at this address is not a TurnDesk server"))
    shown = {key: value for key, value in status.items() if _fits(key, value)} if status is not None else None
    return OtherMachine(name, shown, make_single_line(error_text))


def _refused(error: HTTPError) -> str:
    if error.code in {HTTPStatus.FORBIDDEN, HTTPStatus.UNAUTHORIZED}:
        return tr("access token rejected")
    return make_single_line(
        tr(Message("the server returns HTTP status {answer}", answer=f"{error.code} {error.reason}"))
    )


_TEXTS = frozenset({"machine", "state", "execution", "program", "stop", "waiting_for"})
_FIGURES = frozenset({"line", "made", "time_left", "last_cycle", "spindle_load"})


def _fits(key: str, value: object) -> bool:
    """Return whether a received value has a valid type and size for the status page.

    The value is checked because data from another system are not trusted.
    """
    figure = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _LARGEST
    return (key in _TEXTS and isinstance(value, str)) or (key in _FIGURES and figure)


class OtherMachines:
    """Reader of the status of other machines, with one thread for each machine.

    The threads read only as long as ``read_machine_states`` is called. A machine that responds slowly or
    not at all does not delay the others. An outdated status is not shown.
    """

    def __init__(
        self,
        addresses: Sequence[str],
        read_status: Callable[[str], OtherMachine] = read_turndesk_status,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._ask, self._clock = read_status, clock
        # including the name of the machine, once it is known
        self._names = {each: _name(each) for each in addresses}
        self._heard = {each: self._not_yet(each, clock()) for each in addresses}
        self._looked = threading.Event()
        self._closing = threading.Event()
        self._last = -VIEW_TIMEOUT_S
        self._threads = [
            threading.Thread(target=self._keep, args=(each,), name="other-desks", daemon=True)
            for each in addresses
        ]

    def start(self) -> None:
        """Start the threads.

        This method may be called only once.
        """
        for thread in self._threads:
            thread.start()

    def read_machine_states(self) -> Sequence[OtherMachine]:
        """Return the latest status of each machine."""
        now = self._clock()
        # no requests were made in the meantime, so the machines are not silent
        if now - self._last > VIEW_TIMEOUT_S:
            self._heard.update({each: self._not_yet(each, now) for each in self._heard})
        self._last = now
        self._looked.set()
        return tuple(_if_fresh(desk, now - at) for at, desk in self._heard.values())

    def close(self) -> None:
        """Tell the threads to stop after their pending requests, without waiting until they stop."""
        self._closing.set()
        self._looked.set()

    def _not_yet(self, address: str, now: float) -> tuple[float, OtherMachine]:
        return now, OtherMachine(self._names[address], state=LOADING_TEXT)

    def _keep(self, address: str) -> None:
        while not self._closing.is_set():
            self._looked.wait()
            answer = self._ask(address)
            if answer.status_document is not None and (machine := answer.status_document.get("machine")):
                self._names[address] = f"{machine} ({_name(address)})"
            self._heard[address] = self._clock(), replace(answer, address=self._names[address])
            if self._clock() - self._last > VIEW_TIMEOUT_S:
                self._looked.clear()
            self._closing.wait(READ_INTERVAL_S)


def _name(address: str) -> str:
    """Return an address without user name, password and token, for display."""
    parts = urlsplit(address)
    return parts.netloc.rpartition("@")[2] + parts.path.rstrip("/")


def _if_fresh(desk: OtherMachine, age: float) -> OtherMachine:
    """Return the status, or a status with an error text if it is older than ``STALE_AFTER_S``."""
    if age <= STALE_AFTER_S:
        return desk
    return OtherMachine(desk.address, error_text=tr(Message("no response for {age} s", age=round(age))))


_MOST_OF_AGENT = 1_000_000  # bytes
_UNAVAILABLE = "UNAVAILABLE"
_WORDS = {
    "ACTIVE": "RUNNING",
    "WAIT": "WAITING",
    "PROGRAM_STOPPED": "PROGRAM STOP",
    "PROGRAM_COMPLETED": "READY",
}
_LONGEST = 15  # digits of a number


def make_current_state_address(address: str) -> str:
    """Return the address at which an MTConnect agent provides the current state of a device.

    ``address`` includes the path of the device.
    """
    parts = urlsplit(address)
    return urlunsplit(parts._replace(path=parts.path.rstrip("/") + "/current", fragment=""))


def read_agent_status(address: str) -> OtherMachine:
    """Read the status of a machine from its MTConnect agent, with a timeout of 2 s."""
    return request_machine_status(
        address, make_current_state_address(address), _MOST_OF_AGENT, parse_mtconnect_streams
    )


def parse_mtconnect_streams(data: bytes) -> MachineResponse:
    """Return the status and the faults in an MTConnectStreams document.

    Raises ValueError if the document is invalid or contains no device.
    """
    if b"<!DOCTYPE" in data:  # agents do not send a DOCTYPE, and entities could grow without limit
        raise ValueError(data[:40])
    try:
        device = next(_named(ElementTree.fromstring(data), "DeviceStream"), None)
    except ElementTree.ParseError as error:
        raise ValueError(str(error)) from error
    if device is None:
        raise ValueError("no DeviceStream")
    machine = {"machine": device.get("name") or ""}
    if next(_values(device, "Availability"), "AVAILABLE") == _UNAVAILABLE:
        return MachineResponse(None, tr("the MTConnect agent reports that the machine is unavailable"))
    faults = ". ".join(
        filter(None, (" ".join((each.text or "").split()) for each in _named(device, "Fault")))
    )
    faulty = next(_named(device, "Fault"), None) is not None
    return MachineResponse({**machine, "state": _state(device, faulty=faulty), **_figures(device)}, faults)


def _state(device: Element, *, faulty: bool) -> str:
    """Return the state of a device, such as E-STOP or ALARM.

    If TurnDesk has no name for the state, the MTConnect term is returned.
    """
    if "TRIGGERED" in _values(device, "EmergencyStop"):
        return "E-STOP"
    if faulty:
        return "ALARM"
    execution = next(_known(device, "Execution"), _UNAVAILABLE)
    return _WORDS.get(execution, execution.replace("_", " "))


def _figures(device: Element) -> dict[str, object]:
    counts = (each.text for each in _named(device, "PartCount") if each.get("subType") in {None, "ALL"})
    found: dict[str, object] = {
        "program": next(_known(device, "Program"), None),
        "line": _whole(next(_known(device, "Line"), next(_known(device, "LineNumber"), None))),
        "made": _whole(next(counts, None)),
    }
    return {key: value for key, value in found.items() if value is not None}


def _whole(text: str | None) -> int | None:
    text = (text or "").strip()
    return int(text) if text.isascii() and text.isdigit() and len(text) <= _LONGEST else None


def _named(inside: Element, name: str) -> Iterator[Element]:
    """Yield the XML elements with a given name, in any version of the namespace."""
    return (each for each in inside.iter() if each.tag.rpartition("}")[2] == name)


def _values(device: Element, name: str) -> Iterator[str]:
    return ((each.text or "").strip() for each in _named(device, name))


def _known(device: Element, name: str) -> Iterator[str]:
    return (value for value in _values(device, name) if value and value != _UNAVAILABLE)
