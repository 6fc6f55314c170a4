"""A machine beside this desk as an MTConnect agent tells it: of any builder, read from ``/current``."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.parse import urlsplit, urlunsplit
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from app.desk.translation import tr
from app.extras.office.other_desks import Answer, answered
from app.extras.office.status_page import OtherDesk

_MOST = 1_000_000  # bytes
_UNAVAILABLE = "UNAVAILABLE"
_WORDS = {
    "ACTIVE": "RUNNING",
    "WAIT": "WAITING",
    "PROGRAM_STOPPED": "PROGRAM STOP",
    "PROGRAM_COMPLETED": "READY",
}
_LONGEST = 15  # figures of a number


def current_address(address: str) -> str:
    """Where the agent says how the machine is now, which ``address`` names behind the agent's own."""
    parts = urlsplit(address)
    return urlunsplit(parts._replace(path=parts.path.rstrip("/") + "/current", fragment=""))


def asked_agent(address: str) -> OtherDesk:
    """One machine, asked now; waits for two seconds at most."""
    return answered(address, current_address(address), _MOST, streams_answer)


def streams_answer(data: bytes) -> Answer:
    """What of an MTConnectStreams document the page shows, and why the machine stands. Raises ValueError."""
    if b"<!DOCTYPE" in data:  # an agent sends none, and entities can grow without end
        raise ValueError(data[:40])
    try:
        device = next(_named(ElementTree.fromstring(data), "DeviceStream"), None)
    except ElementTree.ParseError as error:
        raise ValueError(str(error)) from error
    if device is None:
        raise ValueError("no DeviceStream")
    machine = {"machine": device.get("name") or ""}
    if next(_values(device, "Availability"), "AVAILABLE") == _UNAVAILABLE:
        return Answer(None, tr("the MTConnect agent reports that the machine is unavailable"))
    faults = ". ".join(
        filter(None, (" ".join((each.text or "").split()) for each in _named(device, "Fault")))
    )
    faulty = next(_named(device, "Fault"), None) is not None
    return Answer({**machine, "state": _state(device, faulty=faulty), **_figures(device)}, faults)


def _state(device: Element, *, faulty: bool) -> str:
    """In the words of our own desks, where they have one."""
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
    """Whatever the version of the standard, which stands in the name space."""
    return (each for each in inside.iter() if each.tag.rpartition("}")[2] == name)


def _values(device: Element, name: str) -> Iterator[str]:
    return ((each.text or "").strip() for each in _named(device, name))


def _known(device: Element, name: str) -> Iterator[str]:
    return (value for value in _values(device, name) if value and value != _UNAVAILABLE)
