"""Pins and signals of HAL, and their comparison with the machine file."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

_KINDS = frozenset(("float", "bit", "s32", "u32"))
_IN, _OUT, _BOTH = "IN", "OUT", "I/O"


@dataclass(frozen=True, slots=True)
class Wanted:
    """Pin or signal that the machine file names, with its key ``path`` and TurnDesk's signal ``ours``."""

    path: str
    pin: str
    kind: str
    drives: bool
    ours: str


@dataclass(frozen=True, slots=True)
class Pin:
    """Pin of HAL with the value that halcmd shows; ``signal`` is empty if it is not connected."""

    kind: str
    way: str
    signal: str = ""
    value: str = ""


@dataclass(frozen=True, slots=True)
class Signal:
    """Signal of HAL with the value that halcmd shows, and whether a pin drives it."""

    kind: str
    driven: bool
    value: str = ""


def halcmd(*words: str) -> str:
    """Run halcmd and return its output. Raises RuntimeError with its error text."""
    done = subprocess.run(["halcmd", *words], capture_output=True, text=True, timeout=20, check=False)
    if done.returncode:
        raise RuntimeError((done.stderr or done.stdout).strip() or "halcmd has failed")
    return done.stdout


def pins_of(shown: str) -> dict[str, Pin]:
    """Parse ``halcmd -s show pin``: owner, type, direction, value, name, and the arrow to a signal."""
    found = {}
    for line in shown.splitlines():
        words = line.split()
        if len(words) >= 5:
            found[words[4]] = Pin(words[1], words[2], words[6] if len(words) > 6 else "", words[3])
    return found


def signals_of(pins: Mapping[str, Pin], shown: str) -> dict[str, Signal]:
    """Parse ``halcmd -s show sig``: type, value, name, and the connected pins."""
    driven = {pin.signal for pin in pins.values() if pin.way == _OUT}
    found = {}
    for line in shown.splitlines():
        words = line.split()
        if len(words) >= 3 and words[0] in _KINDS:
            found[words[2]] = Signal(words[0], words[2] in driven, words[1])
    return found


def trouble(wanted: Wanted, pins: Mapping[str, Pin], signals: Mapping[str, Signal]) -> str:
    """Return the error of a named pin or signal, or an empty text if it is correct."""
    pin, signal = pins.get(wanted.pin), signals.get(wanted.pin)
    if pin is None and signal is None:
        return (
            "HAL does not have this pin or signal; check its spelling, and check that its component is loaded"
        )
    kind = pin.kind if pin is not None else signal.kind if signal is not None else ""
    if kind != wanted.kind:
        return f"this pin or signal is of type {kind}; expected type {wanted.kind}"
    if pin is not None and _wrong_way(wanted, pin, signals):
        expected = (
            ("an input pin that TurnDesk drives") if wanted.drives else ("an output pin that TurnDesk reads")
        )
        return f"this pin is an {'output' if pin.way == _OUT else 'input'}; expected {expected}"
    if wanted.drives and pin is not None and pin.signal and signals.get(pin.signal, Signal("", False)).driven:
        return (
            f"another source already drives this pin through the signal {pin.signal}; remove that "
            "net from the HAL file"
        )
    if wanted.drives and signal is not None and signal.driven:
        return "another source already drives this signal; remove the net of that source from the HAL file"
    return ""


def is_on(name: str, pins: Mapping[str, Pin], signals: Mapping[str, Signal]) -> bool:
    """Return whether a pin or signal is on."""
    found = signals[name] if name in signals else pins[name]
    return found.value == "TRUE"


def _wrong_way(wanted: Wanted, pin: Pin, signals: Mapping[str, Signal]) -> bool:
    """Return whether the direction of a pin is wrong; a driven input may also be read."""
    if wanted.drives:
        return pin.way == _OUT
    return pin.way == _IN and not signals.get(pin.signal, Signal("", False)).driven


def nets(
    wanted: Iterable[Wanted],
    own: Mapping[str, Sequence[str]],
    pins: Mapping[str, Pin],
    signals: Mapping[str, Signal],
) -> list[str]:
    """Return the halcmd lines that connect the machine and the bridge's own pins to TurnDesk's signals.

    A pin that is already on a signal of the machine stays there, and TurnDesk's pins are moved to that
    signal. Raises RuntimeError if TurnDesk's signal would have to be on two signals of the machine.
    """
    theirs, loose, kept = dict[str, str](), [], list[str]()
    for each in wanted:
        signal = pins[each.pin].signal if each.pin in pins else each.pin
        if not signal:
            loose.append(each)
        elif theirs.setdefault(each.ours, signal) != signal:
            raise RuntimeError(
                f"{each.path}: {signal} and {theirs[each.ours]} are driven alike; make them one"
            )
        if not each.drives and signal in signals and not signals[signal].driven:
            # The first pin would otherwise set its own value.
            kept.append(f"sets {signal} {signals[signal].value}")
    lines = []
    for name, pin in pins.items():
        if pin.signal in theirs:
            lines += [f"unlinkp {name}", f"net {theirs[pin.signal]} {name}"]
    lines += [f"net {theirs.get(each.ours, each.ours)} {each.pin}" for each in loose]
    lines += [f"net {theirs.get(signal, signal)} {' '.join(names)}" for signal, names in own.items()]
    return [*lines, *kept]
