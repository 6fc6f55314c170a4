"""A builder of HAL files: loaded components, calls, parameters, nets and the wiring table."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import NamedTuple

from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import FileFinding
from drivers.hal.boards.board_table import BoardTable

TURNDESK_COMMENT = "#turndesk"
C_AXIS = "C"
_WIDTH = 110


@dataclass(frozen=True, slots=True)
class LatheAxis:
    """One axis that HAL moves.

    Units are mm or degrees, and seconds. ``travel_per_count`` is the travel per count or step.
    """

    name: str
    travel_per_count: float
    max_velocity: float
    max_acceleration: float

    @property
    def position_unit(self) -> str:
        """Return the unit of the positions as text."""
        return "degree" if self.name == C_AXIS else "mm"


@dataclass(frozen=True, slots=True)
class LatheData:
    """The data of a machine on which its HAL file depends.

    ``terminal_names`` contains the pins and signals of the machine file by their keys, in the order of the
    file. ``servo_period_s`` is the period of the servo thread in seconds.
    """

    machine_name: str
    machine_file_path: str
    board_table: BoardTable
    servo_thread: str
    servo_period_s: float
    axes: tuple[LatheAxis, ...]
    max_rpm: float
    acceleration_rpm_per_s: float
    encoder_pulses_per_rev: int
    terminal_names: Mapping[str, str]
    is_spindle_c_axis: bool = False  # C is the spindle drive.

    @property
    def c_axis(self) -> LatheAxis | None:
        """Return the C axis if it is the spindle drive, otherwise None."""
        return next((axis for axis in self.axes if axis.name == C_AXIS and self.is_spindle_c_axis), None)

    @property
    def driven_axes(self) -> tuple[LatheAxis, ...]:
        """Return the axes that have their own drive."""
        return tuple(axis for axis in self.axes if axis is not self.c_axis)


class BoardTerminal(NamedTuple):
    """A terminal of a board.

    ``is_output`` is True for an output, and ``label`` is the printed label.
    """

    is_output: bool
    printed_label: str


class WiringRow(NamedTuple):
    """A row of the wiring table.

    ``names`` are keys of the machine file.
    """

    place: str
    pin: str
    signal: str
    names: tuple[str, ...]


class HalFileSection(NamedTuple):
    """A group of lines with a title."""

    title: str
    lines: list[str]


_READ_FUNCTIONS = re.compile(
    r"hal\.link_fault|io\.in\..*|io\.analog\..*|hal\.axes\.\w+\.(feedback|fault|home|limit_low|limit_high|index_enable)"
    r"|hal\.spindle\.(position|velocity|at_speed|fault|load|in_position_mode|index_enable)"
)


@dataclass(slots=True)
class HalFile:
    """HAL file that is being built.

    ``find_terminal`` returns the terminal of a board pin, or None if the pin has no terminal.
    """

    lathe: LatheData
    title: str
    find_terminal: Callable[[str], BoardTerminal | None]
    terminal_hint: str = ""  # Names of the board's terminals.
    pre_motion_checks: list[str] = field(default_factory=list)  # Checks before the first motion.
    component_load_lines: list[str] = field(default_factory=list)
    base_thread_calls: list[str] = field(default_factory=list)  # Called in the base thread.
    first_function_calls: list[str] = field(default_factory=list)  # Called before the setpoints are read.
    last_function_calls: list[str] = field(default_factory=list)
    sections: list[HalFileSection] = field(default_factory=list)
    wiring_rows: list[WiringRow] = field(default_factory=list)
    findings: list[FileFinding] = field(default_factory=list)
    extra_files: dict[str, str] = field(default_factory=dict)  # Additional files by name.
    _done: set[str] = field(default_factory=set)
    _claimed: dict[str, str] = field(default_factory=dict)

    def add_load_line(self, line: str, comment: str = "") -> None:
        """Add a line that loads a component, with an optional comment."""
        self.component_load_lines += [f"# {comment}", line] if comment else [line]

    def add_component_instance(self, component: str, name: str) -> None:
        """Add an instance of a component.

        The component is loaded once with all its instances.
        """
        for index, line in enumerate(self.component_load_lines):
            if line.startswith(f"loadrt {component} names="):
                self.component_load_lines[index] = f"{line},{name}"
                return
        self.add_load_line(f"loadrt {component} names={name}")

    def start_section(self, title: str) -> None:
        """Start a section with the given title."""
        self.sections.append(HalFileSection(title, []))

    def add_comment(self, comment: str) -> None:
        """Add a comment to the current section."""
        self.sections[-1].lines.append(f"# {comment}")

    def set_pin(self, pin: str, value: float, comment: str = "") -> None:
        """Set a pin or parameter to a number."""
        line = f"setp {pin} {value:.10g}"
        self.sections[-1].lines.append(f"{line:<58} # {comment}" if comment else line)

    def connect_pins(self, signal: str, *pins: str) -> None:
        """Connect pins to a signal, with the source pin first."""
        self.sections[-1].lines.append(f"net {signal} {' '.join(pins)}")

    def connect_key_pins(
        self, key: str, signal: str, *pins: str, label: str = "", is_required: bool = False
    ) -> str:
        """Connect the pins that belong to a key of the machine file, and return their signal.

        The value of the key may be the name of the signal, of one of the pins, or of a terminal of the
        board. A terminal is connected to the pins.
        """
        self._done.add(key)
        name = self.lathe.terminal_names.get(key, "")
        drives = not _READ_FUNCTIONS.fullmatch(key)
        if not name:
            if is_required:
                why = Message("missing; expected a signal ({signal}) or a pin", signal=signal)
                self.findings.append(FileFinding(key, "", why))
            return signal
        if "." not in name:
            return self._on_signal(key, name, pins, label)
        on = pins
        if name not in pins:
            found = self.find_terminal(name)
            if found is None or found.is_output is not drives:
                self.findings.append(FileFinding(key, format_toml_value(name), self._expected(pins, found)))
                return signal
            label = label or found.printed_label
            if drives:
                self.claim_terminal(name, key)
            on = (*pins, name) if drives else (name, *pins)
        self._add_wiring_row(key, signal, on, label, name)
        return signal

    def connect_position_pins(
        self, axis: str, command: Iterable[str], feedback: Iterable[str], label: str = ""
    ) -> None:
        """Connect the pins of the commanded and the measured position of an axis."""
        path, name = f"hal.axes.{axis}", axis.lower()
        self.connect_key_pins(f"{path}.command", f"{name}-pos-cmd", *command, label=label, is_required=True)
        self.connect_key_pins(f"{path}.feedback", f"{name}-pos-fb", *feedback, label=label, is_required=True)

    def connect_terminal(
        self, path: str, signal: str, name: str, pin: str, *, is_output: bool = True
    ) -> None:
        """Connect a terminal that the table [board] specifies to one pin."""
        found = self.find_terminal(name)
        if found is None or found.is_output is not is_output:
            self.findings.append(FileFinding(path, format_toml_value(name), self._expected((), found)))
            return
        if is_output:
            self.claim_terminal(name, path)
        self.connect_pins(signal, *((pin, name) if is_output else (name, pin)))
        self.wiring_rows.append(WiringRow(found.printed_label, name, signal, (path,)))

    def add_unconnected_signal(self, path: str, name: str) -> None:
        """Create a signal without a pin, which the user sets manually."""
        self._done.add(path)
        self.sections[-1].lines.append(f"newsig {name} bit")
        self.wiring_rows.append(WiringRow("", "-", name, (path,)))

    def connect_enable_pins(self, *pins: str) -> None:
        """Connect the pins of the board and of the machine file that enable the drives.

        All of these pins use one signal, because all drives are enabled together.
        """
        paths = {f"hal.axes.{axis.name}.enable": axis.name for axis in self.lathe.axes}
        named = [path for path in paths if path in self.lathe.terminal_names]
        for path in named:
            self._done.add(path)
            name = self.lathe.terminal_names[path]
            found = self.find_terminal(name)
            if name not in pins and found is not None and found.is_output:
                self.claim_terminal(name, path)
                pins = (*pins, name)
            elif name not in pins:
                why = Message(
                    "expected {terminals}; or remove this key: hal.machine_on then enables every axis",
                    terminals=self.terminal_hint,
                )
                self.findings.append(FileFinding(path, format_toml_value(name), why))
                continue
            self.wiring_rows.append(
                WiringRow(found.printed_label if found else "", name, "machine-on", (path,))
            )
        if named and "hal.machine_on" not in self.lathe.terminal_names:
            self.connect_pins("machine-on", *pins)
        else:
            self.connect_key_pins("hal.machine_on", "machine-on", *pins, is_required=True)

    def connect_link_fault(self, gate_kind: str, *pins: str, extra_pins: tuple[str, ...] = ()) -> None:
        """Connect hal.link_fault to the output of a gate.

        The gate is "or" for pins that report a fault, and "nand" for pins that report correct operation.
        ``extra_pins`` are further pins on the same signal.
        """
        personality = {"or": 0x200, "nand": 0x800}[gate_kind] + len(pins)
        self.add_load_line(
            f"loadrt logic names=board-link personality={personality:#x}",
            "inputs retain their last value while the board does not respond; this component "
            "then opens the E-stop chain",
        )
        self.first_function_calls.append("board-link")
        self.start_section("Board connection: a connection fault opens the E-stop chain")
        for number, pin in enumerate(pins):
            self.connect_pins(f"board-link-{number}", pin, f"board-link.in-{number:02d}")
        self.connect_key_pins(
            "hal.link_fault", "link-fault", f"board-link.{gate_kind}", *extra_pins, is_required=True
        )

    def claim_terminal(self, pin: str, path: str) -> None:
        """Reserve a terminal that the file drives; add a finding if it is already in use."""
        first = self._claimed.setdefault(pin, path)
        if first != path:
            why = Message("expected an unused pin; {first} already uses this pin", first=first)
            self.findings.append(FileFinding(path, format_toml_value(pin), why))

    def connect_remaining_terminals(self) -> None:
        """Connect the machine-file keys that have not been connected yet to their terminals."""
        self.start_section("Inputs and outputs")
        for path in self.lathe.terminal_names:
            if path not in self._done:
                self.connect_key_pins(path, get_signal_name(path))

    def _on_signal(self, path: str, name: str, pins: tuple[str, ...], place: str) -> str:
        if pins:
            self._add_wiring_row(path, name, pins, place, pins[0])
        else:
            why = Message(
                "this signal is not connected to a pin; expected {terminals}", terminals=self.terminal_hint
            )
            self.findings.append(FileFinding(path, format_toml_value(name), why))
        return name

    def _add_wiring_row(self, path: str, signal: str, pins: tuple[str, ...], label: str, pin: str) -> None:
        """Add one net to the file and to the wiring table.

        If the signal already exists, as for a combined switch, only the wiring table is extended.
        """
        for index, wire in enumerate(self.wiring_rows):
            if wire.pin == pin:
                self.wiring_rows[index] = wire._replace(names=(*wire.names, path))
                return
        self.connect_pins(signal, *pins)
        self.wiring_rows.append(WiringRow(label, pin, signal, (path,)))

    def _expected(self, pins: tuple[str, ...], found: BoardTerminal | None) -> str:
        if found is not None:
            if found.is_output:
                return "this terminal is an output; expected an input"
            return "this terminal is an input; expected an output"
        if not pins:
            return Message(
                "the board does not have this pin; expected {terminals}", terminals=self.terminal_hint
            )
        return Message(
            "the board does not have this pin; expected {pins}, the name of a signal, or {terminals}",
            pins=", ".join(pins),
            terminals=self.terminal_hint,
        )


def get_signal_name(path: str) -> str:
    """Return the signal name for a key.

    For example, the key io.in.guard has the signal in-guard, and hal.axes.X.limit_low has x-limit-low.
    """
    word = path.removeprefix("io.").removeprefix("hal.axes.").removeprefix("hal.").removesuffix(".at")
    return re.sub(r"[^a-z0-9]+", "-", word.lower())


# --- Output as text.


def render_hal_file(file: HalFile) -> str:
    """Return the text of the complete file.

    The same machine file always gives the same text.
    """
    return "\n".join((*_head(file), *_body(file), ""))


def _head(file: HalFile) -> Iterator[str]:
    lathe = file.lathe
    yield f"# {lathe.machine_name}: {file.title}."
    source = PurePath(lathe.machine_file_path).name
    yield (f"# Generated by: turndesk machine hal {source}   Run this command again when that file changes.")
    yield (
        "# Positions are in mm (X as a radius) or degrees (rotary axes). E-stop, guard and "
        "overtravel are hardwired."
    )
    yield "# Hardwired safety: see docs/integrator/choose-hardware.md."
    yield "# From power-off to the first part: see docs/integrator/wiring.md."
    if file.pre_motion_checks:
        yield "#"
        yield "# Check and measure on the real machine before the first part:"
        for note in file.pre_motion_checks:
            lines = textwrap.wrap(note, _WIDTH - 5)
            yield from (f"#  {'-' if n == 0 else ' '} {line}" for n, line in enumerate(lines))
    yield "#"
    yield "# Wiring table:"
    yield from (f"#  {line}".rstrip() for line in format_wiring_table(file.wiring_rows))


def _body(file: HalFile) -> Iterator[str]:
    thread = file.lathe.servo_thread
    yield from ("", *file.component_load_lines, "")
    if file.base_thread_calls:
        yield "# Step generation and encoder counting run in the fast thread."
        yield from (f"addf {call} base-thread" for call in file.base_thread_calls)
        yield ""
    yield "# 1. Functions that read from the machine run first in the thread."
    yield from (f"addf {call} {thread}" for call in file.first_function_calls)
    yield from (
        "",
        "# 2. Setpoints, gear, E-stop chain: TurnDesk replaces the next line with its own functions.",
    )
    yield from (TURNDESK_COMMENT, "", "# 3. Functions that drive the machine run last.")
    yield from (f"addf {call} {thread}" for call in file.last_function_calls)
    for section in file.sections:
        if section.lines:
            yield from ("", f"# --- {section.title}", *section.lines)


def format_wiring_table(wires: Iterable[WiringRow]) -> Iterator[str]:
    """Yield the lines of the wiring table.

    The columns are the terminal, the pin, the signal, and the keys of the machine file.
    """
    rows = [("terminal", "HAL pin", "signal", "machine file")]
    rows += [(wire.place or "-", wire.pin, wire.signal, ", ".join(wire.names)) for wire in wires]
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    for *cells, last in rows:
        yield "".join(f"{cell:<{width}}  " for cell, width in zip(cells, widths, strict=True)) + last
