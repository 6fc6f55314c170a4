"""Pins and signals as halcmd shows them: what is wrong with one, and how the machine is hung on ours."""

from __future__ import annotations

from pathlib import Path

import pytest

from drivers.hal import hal_session
from drivers.hal.bridge import hal_pins
from drivers.hal.bridge.hal_pins import (
    ExpectedPin,
    HalPin,
    HalSignal,
    build_net_lines,
    describe_pin_error,
    is_pin_on,
    parse_pins,
    parse_signals,
    run_halcmd,
)
from tests.texts import text

# ``halcmd -s show pin`` and ``show sig``: owner, type, way, value, name, arrow and signal.
SHOWN_PINS = """\
4  float IN    0          x-motor.in ==> x-cmd
4  float OUT   1.25       x-motor.out
4  bit   OUT   TRUE       guard.out ==> guard
5  bit   IN    FALSE      lamp.in
5  bit   IN    TRUE       ear.in <== guard
5  bit   I/O   FALSE      index
"""
SHOWN_SIGNALS = """\
float 0         x-cmd
                         ==> x-motor.in
bit   TRUE      guard
                         <== guard.out
bit   FALSE     by-hand
"""
PINS = parse_pins(SHOWN_PINS)
SIGNALS = parse_signals(PINS, SHOWN_SIGNALS)


def wanted(pin: str, kind: str = "bit", *, drives: bool = False, ours: str = "ours") -> ExpectedPin:
    return ExpectedPin("io.some", pin, kind, drives, ours)


def test_halcmd_output_is_parsed() -> None:
    assert PINS["x-motor.in"] == HalPin("float", "IN", "x-cmd", "0")
    assert PINS["x-motor.out"] == HalPin("float", "OUT", "", "1.25")
    assert PINS["index"] == HalPin("bit", "I/O", "", "FALSE")
    assert SIGNALS["x-cmd"] == HalSignal("float", False, "0")
    assert SIGNALS["guard"] == HalSignal("bit", True, "TRUE")
    assert SIGNALS["by-hand"] == HalSignal("bit", False, "FALSE")
    assert len(SIGNALS) == 3
    assert (parse_pins("\nnothing here\n"), parse_signals({}, "\nfloat 1\n")) == ({}, {})


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        (wanted("guard.out"), ""),
        (wanted("by-hand"), ""),
        (wanted("by-hand", drives=True), ""),
        (wanted("lamp.in", drives=True), ""),
        (wanted("x-motor.in", "float", drives=True), ""),  # on a signal that nothing drives
        (wanted("ear.in"), ""),  # an input that hears what something else drives
        (wanted("index", drives=True), ""),
        (wanted("gaurd.out"), text("drivers.hal-no-pin")),
        (wanted("x-motor.out"), "this pin or signal is of type float; expected type bit"),
        (wanted("x-cmd"), "this pin or signal is of type float; expected type bit"),
        (
            wanted("guard.out", drives=True),
            "this pin is an output; expected an input pin that TurnDesk drives",
        ),
        (wanted("lamp.in"), "this pin is an input; expected an output pin that TurnDesk reads"),
        (
            wanted("ear.in", drives=True),
            "another source already drives this pin through the signal guard; remove that net",
        ),
        (
            wanted("guard", drives=True),
            ("another source already drives this signal; remove the net of that source from the HAL file"),
        ),
    ],
)
def test_pin_that_differs_from_the_machine_file_is_reported(asked: ExpectedPin, why: str) -> None:
    told = describe_pin_error(asked, PINS, SIGNALS)
    assert told.startswith(why)
    assert bool(told) is bool(why)


def test_state_of_pin_or_signal_is_read() -> None:
    assert is_pin_on("guard", PINS, SIGNALS)
    assert is_pin_on("guard.out", PINS, SIGNALS)
    assert not is_pin_on("by-hand", PINS, SIGNALS)
    assert not is_pin_on("lamp.in", PINS, SIGNALS)


def test_machine_pins_are_connected_to_signals_and_retain_their_values() -> None:
    """A loose pin comes to ours; what hangs already takes ours to it; what nobody drives keeps its value."""
    asked = [
        wanted("lamp.in", drives=True, ours="lamp"),
        wanted("guard.out", ours="door"),
        wanted("by-hand", ours="start"),
    ]
    ours = {**PINS, "old.in": HalPin("bit", "IN", "door")}  # of ours, and to go where the machine's signal is
    lines = build_net_lines(asked, {"door": ["bridge.in.door"], "lamp": ["bridge.out.lamp"]}, ours, SIGNALS)
    assert lines == [
        "unlinkp old.in",
        "net guard old.in",
        "net lamp lamp.in",
        "net guard bridge.in.door",
        "net lamp bridge.out.lamp",
        "sets by-hand FALSE",
    ]


def test_one_terminal_on_two_pins_is_rejected() -> None:
    asked = [wanted("guard", ours="door"), wanted("by-hand", ours="door")]
    with pytest.raises(RuntimeError, match=r"io\.some: by-hand .*guard"):
        build_net_lines(asked, {}, PINS, SIGNALS)


@pytest.mark.parametrize(
    ("script", "told"),
    [
        ("echo 'HAL: ERROR: pin not found' >&2; exit 1", "HAL: ERROR: pin not found"),
        ("echo 'no'; exit 2", "no"),
        ("exit 3", "halcmd"),
    ],
)
def test_halcmd_error_is_reported_with_its_text(
    script: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = tmp_path / "halcmd"
    command.write_text(f"#!/bin/sh\n{script}\n")
    command.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    with pytest.raises(RuntimeError, match=told):
        run_halcmd("show", "pin")
    command.write_text('#!/bin/sh\necho "asked $*"\n')
    assert run_halcmd("-s", "show", "pin") == "asked -s show pin\n"


def test_halcmd_that_hangs_is_reported_with_its_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = tmp_path / "halcmd"
    command.write_text("#!/bin/sh\nexec sleep 600\n")
    command.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    monkeypatch.setattr(hal_pins, "_HALCMD_TIMEOUT_S", 0.05)
    with pytest.raises(RuntimeError, match=r"halcmd -s show pin .*0\.05 s"):
        run_halcmd("-s", "show", "pin")


def test_halcmd_timeout_leaves_time_to_report_it_before_the_driver_gives_up() -> None:
    assert 2 * hal_pins._HALCMD_TIMEOUT_S < hal_session._START
