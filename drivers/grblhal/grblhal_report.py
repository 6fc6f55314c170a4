"""Parsers for grblHAL status reports and for the identity of a controller (reply to ``$I``)."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from core.ports import DriverError

_NUMBER = re.compile(r"-?\d+(\.\d+)?")
_STATES = frozenset(("Idle", "Run", "Hold", "Jog", "Home", "Alarm", "Door", "Check", "Sleep", "Tool"))


class StatusReport(NamedTuple):
    """Status report of the controller; fields that it omits are None.

    Positions are in mm. X is a radius or a diameter, as in the controller.
    """

    state: str
    sub: int | None = None
    position: tuple[float, ...] | None = None
    free: int | None = None  # Free blocks of the planner.
    line: int | None = None
    speeds: tuple[float, ...] | None = None  # Feed, commanded rpm, and measured rpm if there is an encoder.
    pins: str = ""
    offset: tuple[float, ...] | None = None
    overrides: tuple[int, ...] | None = None  # Percent: feed, rapid, spindle.
    diameter: bool | None = None
    homed: tuple[int, ...] | None = None
    input: int | None = None  # Result of M66: 1 on, 0 off, -1 none.
    full: bool = False
    # Accessories that are on: S C spindle, F flood, M mist; omitted if all are off.
    accessories: str | None = None

    @property
    def moves(self) -> bool:
        """Return whether the axes may be moving in the reported state."""
        resting = {"Hold": (0,), "Door": (0, 1)}.get(self.state)  # The door is open, or closed again.
        return self.state in {"Run", "Jog", "Home"} if resting is None else self.sub not in resting

    @property
    def measured(self) -> float | None:
        """Return the spindle speed in rpm as measured by an encoder, or None if there is no encoder."""
        return self.speeds[2] if self.speeds is not None and len(self.speeds) > 2 else None


def parse_report(line: str) -> StatusReport | None:
    """Parse a line as a status report, and return the report, or None if the line is damaged."""
    if not (line.startswith("<") and line.endswith(">")):
        return None
    head, *fields = line[1:-1].split("|")
    state, _, sub = head.partition(":")
    if state not in _STATES or (sub and not sub.isdecimal()):
        return None
    values: dict[str, object] = {}
    for field in fields:
        name, colon, text = field.partition(":")
        reader = _FIELD_READERS.get(name)
        if reader is None or not colon:
            continue
        found = reader(text)
        if found is None:
            return None
        values.update(found)
    work = values.pop("work", None)
    if "position" not in values and not work:
        return None
    return StatusReport(state, int(sub) if sub else None, **values)  # type: ignore[arg-type]  # readers name the fields


def _numbers(text: str) -> tuple[float, ...] | None:
    parts = text.split(",")
    if not all(_NUMBER.fullmatch(part) for part in parts):
        return None
    values = tuple(float(part) for part in parts)
    return values if all(math.isfinite(value) for value in values) else None


def _floats(name: str) -> Callable[[str], Mapping[str, object] | None]:
    def parse_float_field(text: str) -> Mapping[str, object] | None:
        values = _numbers(text)
        return None if values is None else {name: values}

    return parse_float_field


def _whole(name: str, index: int | None = None) -> Callable[[str], Mapping[str, object] | None]:
    def parse_integer_field(text: str) -> Mapping[str, object] | None:
        parts = text.split(",")
        if not all(part.isdecimal() for part in parts):
            return None
        values = tuple(int(part) for part in parts)
        return {name: values if index is None else values[index]}

    return parse_integer_field


_FIELD_READERS: dict[str, Callable[[str], Mapping[str, object] | None]] = {
    "MPos": _floats("position"),
    "WPos": lambda text: {"work": True} if _numbers(text) else None,  # Until $10 has the required value.
    "FS": _floats("speeds"),
    "WCO": _floats("offset"),
    "Bf": _whole("free", 0),
    "Ln": _whole("line", 0),
    "Ov": _whole("overrides"),
    "H": _whole("homed"),
    "Pn": lambda text: {"pins": text},
    "In": lambda text: {"input": int(text)} if text in {"-1", "0", "1"} else {},
    "FW": lambda _: {"full": True},
    "A": lambda text: {"accessories": text},
    "D": lambda text: {"diameter": text == "1"} if text in {"0", "1"} else None,
}

# --- Identity of the controller by ``$I``, without assumptions about missing fields.


_MIN_BUFFER_SIZE = 256
# Control inputs: reset, feed hold, cycle start, door, block delete, optional stop, E-stop, probe lost, motor
# fault, motor warning. Other pins (limits by axis, probe) are not in [SIGNALS:…].
_AXES = frozenset("XYZABCUVW")
_CONTROL_INPUTS = "RHSDLTEOFMQ"


class ControllerIdentity(NamedTuple):
    """Identity of a controller, with its axis letters in the order of the reports.

    ``planner_block_count`` is the number of blocks that the planner can store. ``buffer_byte_count`` is the
    size of the line buffer in bytes.
    """

    firmware_version: str
    planner_block_count: int
    buffer_byte_count: int
    axis_letters: str
    option_names: frozenset[str]
    auxiliary_input_count: int  # auxiliary digital inputs
    auxiliary_output_count: int
    build_option_letters: str = ""  # Build options: V variable spindle, M mist.
    control_input_letters: str | None = (
        None  # Control inputs of the board, by their letters in the pins of a report.
    )

    def has_input_pin(self, letter: str) -> bool:
        """Return whether the board has the input with this letter.

        Firmware since 2024 lists the control inputs in [SIGNALS:…]. For older firmware, every control input
        is assumed to exist. A limit switch exists if its axis exists.
        """
        if letter in _AXES:
            return letter in self.axis_letters
        return (
            self.control_input_letters is None
            or letter not in _CONTROL_INPUTS
            or letter in self.control_input_letters
        )

    @property
    def is_in_lathe_mode(self) -> bool:
        """Return whether the controller reports lathe mode."""
        return any(option.startswith("LATHE") for option in self.option_names)


def parse_identity(lines: Iterable[str]) -> ControllerIdentity:
    """Parse the reply to ``$I``.

    Raises DriverError if the device is not grblHAL or its buffer is too small.
    """
    fields: dict[str, str] = {}
    for line in lines:
        found = re.fullmatch(r"\[([A-Z ]+):(.*)\]", line)
        if found:
            fields.setdefault(found[1], found[2])
    letters, *sizes = fields.get("OPT", "").split(",")
    if "VER" not in fields or len(sizes) < 2 or not all(size.isdecimal() for size in sizes[:2]):
        raise DriverError(
            "the connected device is not grblHAL: its response to $I contains neither [VER:…] "
            "nor [OPT:…,blocks,bytes,…]",
            reason="no-grblhal",
        )
    blocks, buffer = int(sizes[0]), int(sizes[1])
    if buffer < _MIN_BUFFER_SIZE:
        raise DriverError(
            "the controller's buffer of {buffer} bytes is too small; {least_buffer} are needed",
            reason="small-buffer",
            buffer=buffer,
            least_buffer=_MIN_BUFFER_SIZE,
        )
    axes = fields.get("AXS", "3:XYZ").partition(":")[2]
    options = frozenset(fields.get("NEWOPT", "").split(",")) - {""}
    ports = [int(port) if port.isdecimal() else 0 for port in fields.get("AUX IO", "0,0").split(",")]
    inputs, outputs = (*ports, 0, 0)[:2]
    signals = fields.get("SIGNALS")
    return ControllerIdentity(fields["VER"], blocks, buffer, axes, options, inputs, outputs, letters, signals)
