"""Builder of a HAL file: loaded components, calls, parameters, nets and the wiring table."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import NamedTuple

from core.message import Message
from core.table_schema import Finding, written
from drivers.hal.boards.board_table import BoardTable

MARK = "#turndesk"
C = "C"
_WIDTH = 110


@dataclass(frozen=True, slots=True)
class LatheAxis:
    """One axis that HAL moves, in mm or degrees, and seconds; ``count`` is the travel per count or step."""

    name: str
    count: float
    vmax: float
    amax: float

    @property
    def unit(self) -> str:
        """The unit of the positions as text."""
        return "degree" if self.name == C else "mm"


@dataclass(frozen=True, slots=True)
class Lathe:
    """Data of a machine that its HAL file depends on.

    ``names`` are the pins and signals of the machine file by their keys, in its order. ``period`` is that of
    the servo thread in seconds.
    """

    name: str
    source: str
    board: BoardTable
    thread: str
    period: float
    axes: tuple[LatheAxis, ...]
    rpm_max: float
    rpm_accel: float
    encoder_lines: int
    names: Mapping[str, str]
    spindle_is_c: bool = False  # C is the spindle drive.

    @property
    def c(self) -> LatheAxis | None:
        """The C axis if it is the spindle drive, otherwise None."""
        return next((axis for axis in self.axes if axis.name == C and self.spindle_is_c), None)

    @property
    def driven(self) -> tuple[LatheAxis, ...]:
        """The axes that have their own drive."""
        return tuple(axis for axis in self.axes if axis is not self.c)


class Terminal(NamedTuple):
    """Terminal of a board: ``drives`` is True for an output, ``place`` is the printed label."""

    drives: bool
    place: str


class Wire(NamedTuple):
    """Row of the wiring table; ``names`` are keys of the machine file."""

    place: str
    pin: str
    signal: str
    names: tuple[str, ...]


class Section(NamedTuple):
    """Group of lines with a title."""

    title: str
    lines: list[str]


_READS = re.compile(
    r"hal\.link_fault|io\.in\..*|io\.analog\..*|hal\.axes\.\w+\.(feedback|fault|home|limit_low|limit_high|index_enable)"
    r"|hal\.spindle\.(position|velocity|at_speed|fault|load|in_position_mode|index_enable)"
)


@dataclass(slots=True)
class HalFile:
    """HAL file that is being built; ``terminal`` returns the terminal of a board pin, or None."""

    lathe: Lathe
    title: str
    terminal: Callable[[str], Terminal | None]
    hint: str = ""  # Names of the board's terminals.
    notes: list[str] = field(default_factory=list)  # Checks before the first motion.
    loads: list[str] = field(default_factory=list)
    base: list[str] = field(default_factory=list)  # Called in the base thread.
    first: list[str] = field(default_factory=list)  # Called before the setpoints are read.
    last: list[str] = field(default_factory=list)
    sections: list[Section] = field(default_factory=list)
    wires: list[Wire] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    beside: dict[str, str] = field(default_factory=dict)  # Additional files by name.
    _done: set[str] = field(default_factory=set)
    _claimed: dict[str, str] = field(default_factory=dict)

    def load(self, line: str, why: str = "") -> None:
        """Add a line that loads a component."""
        self.loads += [f"# {why}", line] if why else [line]

    def instance(self, component: str, name: str) -> None:
        """Add an instance of a component, which is loaded once with all its instances."""
        for index, line in enumerate(self.loads):
            if line.startswith(f"loadrt {component} names="):
                self.loads[index] = f"{line},{name}"
                return
        self.load(f"loadrt {component} names={name}")

    def section(self, title: str) -> None:
        """Start a section with this title."""
        self.sections.append(Section(title, []))

    def say(self, why: str) -> None:
        """Add a comment to the present section."""
        self.sections[-1].lines.append(f"# {why}")

    def setp(self, pin: str, value: float, why: str = "") -> None:
        """Set a pin or parameter to a number."""
        line = f"setp {pin} {value:.10g}"
        self.sections[-1].lines.append(f"{line:<58} # {why}" if why else line)

    def net(self, signal: str, *pins: str) -> None:
        """Connect pins to a signal, with the source first."""
        self.sections[-1].lines.append(f"net {signal} {' '.join(pins)}")

    def role(self, path: str, signal: str, *pins: str, place: str = "", needed: bool = False) -> str:
        """Connect the pins of the key ``path`` and return their signal.

        The machine file may name the signal, one of the pins, or a terminal of the board. A terminal is
        connected to the pins.
        """
        self._done.add(path)
        name = self.lathe.names.get(path, "")
        drives = not _READS.fullmatch(path)
        if not name:
            if needed:
                why = Message("missing; expected a signal ({signal}) or a pin", signal=signal)
                self.findings.append(Finding(path, "", why))
            return signal
        if "." not in name:
            return self._on_signal(path, name, pins, place)
        on = pins
        if name not in pins:
            found = self.terminal(name)
            if found is None or found.drives is not drives:
                self.findings.append(Finding(path, written(name), self._expected(pins, found)))
                return signal
            place = place or found.place
            if drives:
                self.claim(name, path)
            on = (*pins, name) if drives else (name, *pins)
        self._wire(path, signal, on, place, name)
        return signal

    def positions(self, axis: str, command: Iterable[str], feedback: Iterable[str], place: str = "") -> None:
        """Connect the pins of commanded and measured position of an axis."""
        path, name = f"hal.axes.{axis}", axis.lower()
        self.role(f"{path}.command", f"{name}-pos-cmd", *command, place=place, needed=True)
        self.role(f"{path}.feedback", f"{name}-pos-fb", *feedback, place=place, needed=True)

    def at_terminal(self, path: str, signal: str, name: str, pin: str, *, drives: bool = True) -> None:
        """Connect a terminal that [board] names to one pin."""
        found = self.terminal(name)
        if found is None or found.drives is not drives:
            self.findings.append(Finding(path, written(name), self._expected((), found)))
            return
        if drives:
            self.claim(name, path)
        self.net(signal, *((pin, name) if drives else (name, pin)))
        self.wires.append(Wire(found.place, name, signal, (path,)))

    def signal(self, path: str, name: str) -> None:
        """Create a signal without a pin, which is set by hand."""
        self._done.add(path)
        self.sections[-1].lines.append(f"newsig {name} bit")
        self.wires.append(Wire("", "-", name, (path,)))

    def enable(self, *pins: str) -> None:
        """Connect the pins of the board and of the machine file that enable the drives.

        All of them use one signal, because they are driven alike.
        """
        paths = {f"hal.axes.{axis.name}.enable": axis.name for axis in self.lathe.axes}
        named = [path for path in paths if path in self.lathe.names]
        for path in named:
            self._done.add(path)
            name = self.lathe.names[path]
            found = self.terminal(name)
            if name not in pins and found is not None and found.drives:
                self.claim(name, path)
                pins = (*pins, name)
            elif name not in pins:
                why = Message(
                    "expected {terminals}; or remove this key: hal.machine_on then enables every axis",
                    terminals=self.hint,
                )
                self.findings.append(Finding(path, written(name), why))
                continue
            self.wires.append(Wire(found.place if found else "", name, "machine-on", (path,)))
        if named and "hal.machine_on" not in self.lathe.names:
            self.net("machine-on", *pins)
        else:
            self.role("hal.machine_on", "machine-on", *pins, needed=True)

    def link(self, gate: str, *pins: str, further: tuple[str, ...] = ()) -> None:
        """Put hal.link_fault on a gate: "or" of pins that report a fault, "nand" of pins that report health.

        ``further`` pins of the file are on the same signal.
        """
        personality = {"or": 0x200, "nand": 0x800}[gate] + len(pins)
        self.load(
            f"loadrt logic names=board-link personality={personality:#x}",
            "inputs retain their last value while the board does not respond; this component "
            "then opens the E-stop chain",
        )
        self.first.append("board-link")
        self.section("Board connection: a connection fault opens the E-stop chain")
        for number, pin in enumerate(pins):
            self.net(f"board-link-{number}", pin, f"board-link.in-{number:02d}")
        self.role("hal.link_fault", "link-fault", f"board-link.{gate}", *further, needed=True)

    def claim(self, pin: str, path: str) -> None:
        """Reserve a driven terminal; a second use adds a finding."""
        first = self._claimed.setdefault(pin, path)
        if first != path:
            why = Message("expected an unused pin; {first} already uses this pin", first=first)
            self.findings.append(Finding(path, written(pin), why))

    def rest(self) -> None:
        """Connect every name of the machine file that is not yet connected to its terminal."""
        self.section("Inputs and outputs")
        for path in self.lathe.names:
            if path not in self._done:
                self.role(path, signal_of(path))

    def _on_signal(self, path: str, name: str, pins: tuple[str, ...], place: str) -> str:
        if pins:
            self._wire(path, name, pins, place, pins[0])
        else:
            why = Message("this signal is not connected to a pin; expected {terminals}", terminals=self.hint)
            self.findings.append(Finding(path, written(name), why))
        return name

    def _wire(self, path: str, signal: str, pins: tuple[str, ...], place: str, pin: str) -> None:
        """Add one net; for a signal that exists already, such as a combined switch, only extend the table."""
        for index, wire in enumerate(self.wires):
            if wire.pin == pin:
                self.wires[index] = wire._replace(names=(*wire.names, path))
                return
        self.net(signal, *pins)
        self.wires.append(Wire(place, pin, signal, (path,)))

    def _expected(self, pins: tuple[str, ...], found: Terminal | None) -> str:
        if found is not None:
            if found.drives:
                return "this terminal is an output; expected an input"
            return "this terminal is an input; expected an output"
        if not pins:
            return Message("the board does not have this pin; expected {terminals}", terminals=self.hint)
        return Message(
            "the board does not have this pin; expected {pins}, the name of a signal, or {terminals}",
            pins=", ".join(pins),
            terminals=self.hint,
        )


def signal_of(path: str) -> str:
    """Return the signal name for a key: io.in.guard is in-guard, hal.axes.X.limit_low is x-limit-low."""
    word = path.removeprefix("io.").removeprefix("hal.axes.").removeprefix("hal.").removesuffix(".at")
    return re.sub(r"[^a-z0-9]+", "-", word.lower())


# --- Output as text.


def text_of(file: HalFile) -> str:
    """Return the complete file; the same machine file always gives the same text."""
    return "\n".join((*_head(file), *_body(file), ""))


def _head(file: HalFile) -> Iterator[str]:
    lathe = file.lathe
    yield f"# {lathe.name}: {file.title}."
    source = PurePath(lathe.source).name
    yield (f"# Generated by: turndesk machine hal {source}   Run this command again when that file changes.")
    yield (
        "# Positions are in mm (X as a radius) or degrees (rotary axes). E-stop, guard and "
        "overtravel are hardwired."
    )
    yield "# Hardwired safety: see docs/integrator/choose-hardware.md."
    yield "# From power-off to the first part: see docs/integrator/wiring.md."
    if file.notes:
        yield "#"
        yield "# Check and measure on the real machine before the first part:"
        for note in file.notes:
            lines = textwrap.wrap(note, _WIDTH - 5)
            yield from (f"#  {'-' if n == 0 else ' '} {line}" for n, line in enumerate(lines))
    yield "#"
    yield "# Wiring table:"
    yield from (f"#  {line}".rstrip() for line in table_lines(file.wires))


def _body(file: HalFile) -> Iterator[str]:
    thread = file.lathe.thread
    yield from ("", *file.loads, "")
    if file.base:
        yield "# Step generation and encoder counting run in the fast thread."
        yield from (f"addf {call} base-thread" for call in file.base)
        yield ""
    yield "# 1. Functions that read from the machine run first in the thread."
    yield from (f"addf {call} {thread}" for call in file.first)
    yield from (
        "",
        "# 2. Setpoints, gear, E-stop chain: TurnDesk replaces the next line with its own functions.",
    )
    yield from (MARK, "", "# 3. Functions that drive the machine run last.")
    yield from (f"addf {call} {thread}" for call in file.last)
    for section in file.sections:
        if section.lines:
            yield from ("", f"# --- {section.title}", *section.lines)


def table_lines(wires: Iterable[Wire]) -> Iterator[str]:
    """Yield the lines of the wiring table: terminal, pin, signal, and keys of the machine file."""
    rows = [("terminal", "HAL pin", "signal", "machine file")]
    rows += [(wire.place or "-", wire.pin, wire.signal, ", ".join(wire.names)) for wire in wires]
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    for *cells, last in rows:
        yield "".join(f"{cell:<{width}}  " for cell, width in zip(cells, widths, strict=True)) + last
