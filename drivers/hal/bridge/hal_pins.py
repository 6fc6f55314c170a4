"""The pins and signals of HAL, and their comparison with the machine file."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

_HAL_TYPES = frozenset(("float", "bit", "s32", "u32"))
_IN, _OUT, _BOTH = "IN", "OUT", "I/O"
_HALCMD_TIMEOUT_S = 10.0  # Less than the driver waits for HAL, so that the driver receives this cause.


@dataclass(frozen=True, slots=True)
class ExpectedPin:
    """A pin or signal that the machine file specifies.

    ``machine_file_key`` is its key, and ``turndesk_signal`` is the TurnDesk signal that is connected to it.
    """

    machine_file_key: str
    pin_name: str
    hal_type: str
    is_driven_by_turndesk: bool
    turndesk_signal: str


@dataclass(frozen=True, slots=True)
class HalPin:
    """A pin of HAL with the value that halcmd shows.

    ``signal_name`` is empty if the pin is not connected.
    """

    hal_type: str
    direction: str
    signal_name: str = ""
    value_text: str = ""


@dataclass(frozen=True, slots=True)
class HalSignal:
    """A signal of HAL with the value that halcmd shows, and whether a pin drives it."""

    hal_type: str
    is_driven: bool
    value_text: str = ""


def run_halcmd(*words: str) -> str:
    """Run halcmd and return its output.

    Raises RuntimeError with the error text of halcmd if halcmd fails, or if it takes longer than 10 s. Raises
    OSError if halcmd cannot be started.
    """
    try:
        done = subprocess.run(
            ["halcmd", *words], capture_output=True, text=True, timeout=_HALCMD_TIMEOUT_S, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise RuntimeError(
            f"halcmd {' '.join(words)} did not end within {_HALCMD_TIMEOUT_S:g} s; end all other programs "
            "that use HAL"
        ) from error
    if done.returncode:
        raise RuntimeError((done.stderr or done.stdout).strip() or "halcmd has failed")
    return done.stdout


def parse_pins(output: str) -> dict[str, HalPin]:
    """Return the pins in the output of ``halcmd -s show pin``.

    A line contains owner, type, direction, value, name, and an arrow to a signal.
    """
    found = {}
    for line in output.splitlines():
        words = line.split()
        if len(words) >= 5:
            found[words[4]] = HalPin(words[1], words[2], words[6] if len(words) > 6 else "", words[3])
    return found


def parse_signals(pins: Mapping[str, HalPin], output: str) -> dict[str, HalSignal]:
    """Return the signals in the output of ``halcmd -s show sig``.

    A line contains type, value, name, and the connected pins.
    """
    driven = {pin.signal_name for pin in pins.values() if pin.direction == _OUT}
    found = {}
    for line in output.splitlines():
        words = line.split()
        if len(words) >= 3 and words[0] in _HAL_TYPES:
            found[words[2]] = HalSignal(words[0], words[2] in driven, words[1])
    return found


def describe_pin_error(
    expected_pin: ExpectedPin, pins: Mapping[str, HalPin], signals: Mapping[str, HalSignal]
) -> str:
    """Return the error of a pin or signal in the machine file, or an empty string if it is correct."""
    pin, signal = pins.get(expected_pin.pin_name), signals.get(expected_pin.pin_name)
    if pin is None and signal is None:
        return (
            "HAL does not have this pin or signal; check its spelling, and check that its component is loaded"
        )
    kind = pin.hal_type if pin is not None else signal.hal_type if signal is not None else ""
    if kind != expected_pin.hal_type:
        return f"this pin or signal is of type {kind}; expected type {expected_pin.hal_type}"
    if pin is not None and _has_wrong_direction(expected_pin, pin, signals):
        expected = (
            ("an input pin that TurnDesk drives")
            if expected_pin.is_driven_by_turndesk
            else ("an output pin that TurnDesk reads")
        )
        return f"this pin is an {'output' if pin.direction == _OUT else 'input'}; expected {expected}"
    if (
        expected_pin.is_driven_by_turndesk
        and pin is not None
        and pin.signal_name
        and signals.get(pin.signal_name, HalSignal("", False)).is_driven
    ):
        return (
            f"another source already drives this pin through the signal {pin.signal_name}; remove that "
            "net from the HAL file"
        )
    if expected_pin.is_driven_by_turndesk and signal is not None and signal.is_driven:
        return "another source already drives this signal; remove the net of that source from the HAL file"
    return ""


def is_pin_on(pin_name: str, pins: Mapping[str, HalPin], signals: Mapping[str, HalSignal]) -> bool:
    """Return whether a pin or signal is on."""
    found = signals[pin_name] if pin_name in signals else pins[pin_name]
    return found.value_text == "TRUE"


def _has_wrong_direction(expected: ExpectedPin, pin: HalPin, signals: Mapping[str, HalSignal]) -> bool:
    """Return whether a pin has the wrong direction.

    An input pin may also be read if another pin drives its signal.
    """
    if expected.is_driven_by_turndesk:
        return pin.direction == _OUT
    return pin.direction == _IN and not signals.get(pin.signal_name, HalSignal("", False)).is_driven


def build_net_lines(
    expected: Iterable[ExpectedPin],
    bridge_nets: Mapping[str, Sequence[str]],
    pins: Mapping[str, HalPin],
    signals: Mapping[str, HalSignal],
) -> list[str]:
    """Return the halcmd lines that connect the machine's pins and the bridge's pins to TurnDesk's signals.

    A pin that is already on a signal of the machine remains on it, and TurnDesk's pins are moved to that
    signal. Raises RuntimeError if TurnDesk's signal would have to be on two signals of the machine.
    """
    theirs, loose, kept = dict[str, str](), [], list[str]()
    for each in expected:
        signal = pins[each.pin_name].signal_name if each.pin_name in pins else each.pin_name
        if not signal:
            loose.append(each)
        elif theirs.setdefault(each.turndesk_signal, signal) != signal:
            raise RuntimeError(
                f"{each.machine_file_key}: {signal} and {theirs[each.turndesk_signal]} are driven alike; "
                f"make them one"
            )
        if not each.is_driven_by_turndesk and signal in signals and not signals[signal].is_driven:
            # The first pin would otherwise set its own value.
            kept.append(f"sets {signal} {signals[signal].value_text}")
    lines = []
    for name, pin in pins.items():
        if pin.signal_name in theirs:
            lines += [f"unlinkp {name}", f"net {theirs[pin.signal_name]} {name}"]
    lines += [
        f"net {theirs.get(each.turndesk_signal, each.turndesk_signal)} {each.pin_name}" for each in loose
    ]
    lines += [f"net {theirs.get(signal, signal)} {' '.join(names)}" for signal, names in bridge_nets.items()]
    return [*lines, *kept]
