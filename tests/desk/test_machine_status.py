"""One snapshot in words and figures: value, unit and mode never come from two different ones."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from app.desk.status.machine_status import StatusTone, make_machine_status
from app.desk.status.readouts import Lamp, ReadoutKind, find_readout_values, make_drives_lamp
from core.alarms import CATALOG
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import Alarm, MachineState, Snapshot
from core.interpreter.shared.modal_state import ModalState
from core.ports import ALL_UNKNOWN_PARTS, UnknownPart
from tests.texts import text

INCH = 25.4
AT = Snapshot(
    state=MachineState.RUN,
    actual=(1.5 * INCH, -2 * INCH, 90.0),
    block=3,
    block_end=(1.75 * INCH, -2.25 * INCH, 90.0),
    offset=(1.0 * INCH, -1.0 * INCH),
    homed=(True, True, True),
)


def shown(snapshot: Snapshot, readout: ReadoutKind = ReadoutKind.POSITION) -> list[tuple[str, str, str]]:
    """(mark, large, small) of each axis."""
    return [
        (a.diameter_mark, a.value, a.second_value)
        for a in make_machine_status(snapshot, readout, has_c_axis=True).position.axes
    ]


def test_inch_readout_shows_radius_position_and_distance_to_go() -> None:
    assert shown(AT) == [
        ("R", "0.50000", "0.25000"),
        ("", "−1.00000", "−0.25000"),
        ("", "90.00", "0.00"),
    ]


def test_diameter_mode_doubles_only_x_position_and_distance_to_go() -> None:
    diameter = replace(AT, modal=ModalState(diameter=True))
    assert shown(diameter)[0] == ("Ø", "1.00000", "0.50000")
    assert shown(diameter)[1] == shown(AT)[1]


def test_metric_readout_has_four_decimals_and_its_unit() -> None:
    metric = replace(AT, modal=ModalState(metric=True))
    assert shown(metric)[0] == ("R", "12.7000", "6.3500")
    assert make_machine_status(metric, ReadoutKind.POSITION, has_c_axis=True).position.unit == "MM"


@pytest.mark.parametrize(
    ("readout", "x"), [(ReadoutKind.POSITION, 0.5), (ReadoutKind.TO_GO, 0.25), (ReadoutKind.HOME, 1.5)]
)
def test_readout_kind_selects_the_coordinates(readout: ReadoutKind, x: float) -> None:
    assert find_readout_values(AT, readout)[0] == pytest.approx(x * INCH)


def test_distance_to_go_is_zero_outside_a_block() -> None:
    assert find_readout_values(replace(AT, block=0), ReadoutKind.TO_GO) == (0.0, 0.0, 0.0)


def test_readout_kinds_cycle_back_to_the_first() -> None:
    assert ReadoutKind.POSITION.next_kind.next_kind.next_kind is ReadoutKind.POSITION


def test_distance_to_go_readout_also_shows_the_position() -> None:
    assert (
        make_machine_status(AT, ReadoutKind.TO_GO, has_c_axis=True).position.second_kind
        is ReadoutKind.POSITION
    )


def test_a_lathe_without_c_shows_two_axes() -> None:
    assert [
        a.name for a in make_machine_status(AT, ReadoutKind.POSITION, has_c_axis=False).position.axes
    ] == [
        "X",
        "Z",
    ]


def test_tiny_negative_positions_have_no_sign() -> None:
    near = replace(AT, actual=(1.0 * INCH - 1e-6, -1.0 * INCH - 1e-6, -1e-4))
    assert [row[1] for row in shown(near)] == ["0.00000", "0.00000", "0.00"]


def test_measured_feed_per_revolution_uses_the_spindle_speed() -> None:
    # .005 in/rev at 1200 rpm = 20 rev/s: 2.54 mm/s
    modal = ModalState(per_rev=True)
    view = make_machine_status(
        replace(AT, modal=modal, feed=0.127, velocity=2.54, rpm_actual=1200), ReadoutKind.POSITION, True
    )
    assert (view.feed.programmed_value, view.feed.measured_value, view.feed.measured_unit) == (
        "0.00500",
        "0.00500",
        "in/rev",
    )


def test_feed_per_revolution_with_a_stopped_spindle_is_a_dash() -> None:
    view = make_machine_status(
        replace(AT, modal=ModalState(per_rev=True), feed=0.127, velocity=0.0), ReadoutKind.POSITION, True
    )
    assert view.feed.measured_value == "—"


def test_rapid_is_shown_per_minute_even_in_g95() -> None:
    view = make_machine_status(
        replace(AT, modal=ModalState(per_rev=True), rapid=True, velocity=127.0), ReadoutKind.POSITION, True
    )
    assert (view.feed.programmed_value, view.feed.programmed_unit) == ("RAPID", "")
    assert (view.feed.measured_value, view.feed.measured_unit) == ("300.00", "in/min")


def test_metric_feed_is_shown_in_millimeters() -> None:
    view = make_machine_status(
        replace(AT, modal=ModalState(metric=True), feed=2.0, velocity=1.9), ReadoutKind.POSITION, True
    )
    assert (view.feed.programmed_value, view.feed.measured_value) == ("120.0", "114.0")


def test_surface_speed_is_shown_without_sign_for_a_reversed_spindle() -> None:
    # 2 · pi · .5 in · 1000 rpm / 12 = 261.8 ft/min
    back = replace(AT, actual=(0.5 * INCH, 0.0, 0.0), rpm_command=-1000.0, rpm_actual=-1000.0)
    spindle = make_machine_status(back, ReadoutKind.POSITION, True).spindle
    assert math.isclose(2 * math.pi * 0.5 * 1000 / 12, 261.8, rel_tol=1e-4)
    assert (spindle.surface_speed, spindle.surface_speed_label) == ("262", "SFM")
    assert (spindle.direction, spindle.commanded_rpm, spindle.measured_rpm) == ("M04 REV", "1000", "1000")


def test_constant_surface_speed_mode_is_shown() -> None:
    turning = replace(AT, modal=ModalState(css=True, metric=True), rpm_command=500.0)
    spindle = make_machine_status(turning, ReadoutKind.POSITION, True).spindle
    assert spindle.direction == "M03 FWD · G96"
    assert spindle.surface_speed_label == "M/MIN"


@pytest.mark.parametrize(
    ("command", "actual", "word", "lit", "warn"),
    [
        (0.0, 0.0, "SPINDLE", False, False),
        (900.0, 0.0, "SPINDLE", False, False),
        (900.0, 880.0, "SPINDLE FWD", True, False),
        (-900.0, -880.0, "SPINDLE REV", True, False),
        (0.0, 400.0, text("desk.spindle-coasts"), True, True),
    ],
)
def test_spindle_lamp_shows_measured_rotation(
    command: float, actual: float, word: str, lit: bool, warn: bool
) -> None:
    view = make_machine_status(
        replace(AT, rpm_command=command, rpm_actual=actual), ReadoutKind.POSITION, True
    )
    lamp = view.lamps[0]
    assert (lamp.label, lamp.is_lit, lamp.is_warning) == (word, lit, warn)


def test_spindle_lamp_shows_orientation_in_progress_and_reached_angle() -> None:
    turning = make_machine_status(replace(AT, is_orienting=True, rpm_actual=90.0), ReadoutKind.POSITION, True)
    held = make_machine_status(replace(AT, oriented=90.0), ReadoutKind.POSITION, True)
    assert (turning.lamps[0].label, turning.lamps[0].is_warning) == (text("desk.spindle-orients"), True)
    lamp = held.lamps[0]
    assert (lamp.label, lamp.is_lit, lamp.is_warning) == (text("desk.spindle-oriented"), True, False)
    assert held.spindle.direction.startswith(text("desk.held-angle", angle=90))
    assert make_machine_status(AT, ReadoutKind.POSITION, True).spindle.direction == "M05 OFF"


def test_lamps_show_the_outputs_instead_of_the_programmed_state() -> None:
    make_alarm = replace(AT, modal=ModalState(coolant=True, collet_closed=True), outputs=frozenset())
    words = {
        lamp.label: lamp.is_lit for lamp in make_machine_status(make_alarm, ReadoutKind.POSITION, True).lamps
    }
    assert words["COOLANT"] is False
    assert text("desk.collet-open") in words
    done = replace(make_alarm, outputs=frozenset({"coolant", "collet", "live2"}))
    words = {lamp.label: lamp.is_lit for lamp in make_machine_status(done, ReadoutKind.POSITION, True).lamps}
    assert {"COOLANT", "COLLET CLOSED", "LIVE TOOL"} <= {word for word, lit in words.items() if lit}


def test_every_machine_state_has_a_text_and_a_tone() -> None:
    for state in MachineState:
        view = make_machine_status(replace(AT, state=state), ReadoutKind.POSITION, True)
        assert view.state_text == state.value
        assert isinstance(view.state_tone, StatusTone)
    assert (
        make_machine_status(replace(AT, state=MachineState.FAULT), ReadoutKind.POSITION, True).state_tone
        is StatusTone.ALARM
    )


def test_wait_state_shows_its_condition() -> None:
    view = make_machine_status(
        replace(AT, state=MachineState.WAIT, waiting_for="AT SPEED"), ReadoutKind.POSITION, True
    )
    assert view.state_text == text("desk.waiting", what="AT SPEED")


def test_stop_message_is_shown_only_during_the_stop() -> None:
    stop = replace(AT, state=MachineState.PROGRAM_STOP, message="CHECK THE BORE")
    assert make_machine_status(stop, ReadoutKind.POSITION, True).message == "CHECK THE BORE"
    assert make_machine_status(replace(stop, message=""), ReadoutKind.POSITION, True).message == text(
        "screen.program-stop"
    )
    assert (
        make_machine_status(replace(stop, state=MachineState.RUN), ReadoutKind.POSITION, True).message == ""
    )


def test_first_alarm_is_shown_first() -> None:
    """What comes behind it follows from it more often than not."""
    first, then = (Alarm(n, "axis", f"TROUBLE {n}", "", "") for n in (101, 102))
    view = make_machine_status(
        replace(AT, state=MachineState.FAULT, alarms=(first, then)), ReadoutKind.POSITION, True
    )
    assert view.alarms == (first, then)
    assert view.state_text == text("screen.alarm", number=101, what="TROUBLE 101")


def test_automatic_hold_shows_its_cause_and_operator_hold_does_not() -> None:
    silent = make_alarm("station-silent", "", 4, 0.0)
    view = make_machine_status(replace(AT, state=MachineState.HOLD, stop=silent), ReadoutKind.POSITION, True)
    assert view.stop_cause is silent
    assert view.state_text == text("screen.feed-hold", number=601, what=text("screen.station-silent"))
    pressed = make_alarm("feed-hold", "H at the keyboard", 4, 0.0)
    view = make_machine_status(replace(AT, state=MachineState.HOLD, stop=pressed), ReadoutKind.POSITION, True)
    assert (view.stop_cause, view.state_text) == (None, "FEED HOLD")


@pytest.mark.parametrize(
    ("machine", "shift", "wraps", "c", "home"),
    [
        (390.0, 0.0, True, "30.00", "30.00"),
        (-10.0, 30.0, True, "320.00", "350.00"),
        (719.9999, 0.0, True, "0.00", "0.00"),
        (390.0, 30.0, False, "360.00", "390.00"),
        (-350.0, 0.0, False, "−350.00", "−350.00"),
    ],
)
def test_c_position_is_shown_modulo_360_or_continuous(
    machine: float, shift: float, wraps: bool, c: str, home: str
) -> None:
    """With the offsets of C in the program's figure, without them in the machine's."""
    at = replace(AT, actual=(0.0, 0.0, machine), modal=ModalState(offset_c=shift, is_c_axis_modulo=wraps))
    assert shown(at)[2][1] == c
    assert shown(at, ReadoutKind.HOME)[2][1] == home


def test_feed_of_c_axis_alone_is_shown_in_degrees() -> None:
    alone = replace(AT, turns=True, feed=50.0, modal=ModalState(metric=True))
    feed = make_machine_status(alone, ReadoutKind.POSITION, has_c_axis=True).feed
    assert (feed.programmed_value, feed.programmed_unit) == ("3000.0", "°/min")
    by_turn = replace(alone, feed=2.0, modal=ModalState(metric=True, per_rev=True))
    feed = make_machine_status(by_turn, ReadoutKind.POSITION, has_c_axis=True).feed
    assert (feed.programmed_value, feed.programmed_unit) == ("2.0000", "°/rev")


def test_silent_parts_are_shown_as_unknown() -> None:
    """The last that was known: 0 rpm, coolant off, collet closed. None of it may be read as so."""
    stood = replace(AT, outputs=frozenset({"collet"}), unknown=ALL_UNKNOWN_PARTS)
    view = make_machine_status(stood, ReadoutKind.POSITION, True)
    assert not any(axis.is_known for axis in view.position.axes)
    assert (view.spindle.commanded_rpm, view.spindle.measured_rpm, view.spindle.surface_speed) == (
        "?",
        "?",
        "?",
    )
    assert (view.spindle.direction, view.spindle.is_known) == ("UNKNOWN", False)
    assert view.feed.measured_value == "?"
    told = [(lamp.label, lamp.is_lit, lamp.is_warning) for lamp in view.lamps]
    words = ("SPINDLE UNKNOWN", "COOLANT ?", "COLLET ?", "LIVE TOOL ?")
    assert told == [(word, True, True) for word in words]


def test_drives_lamp_follows_the_power_and_not_the_machine_state() -> None:
    """An alarm that takes the power leaves FAULT, not DRIVES OFF; what is not heard is neither."""
    assert make_drives_lamp(replace(AT, state=MachineState.FAULT, powered=False), "D") == Lamp(
        "DRIVES ON", False, "D"
    )
    assert make_drives_lamp(replace(AT, state=MachineState.FAULT, powered=True)) == Lamp("DRIVES ON", True)
    unheard = replace(AT, powered=True, unknown=ALL_UNKNOWN_PARTS)
    assert make_drives_lamp(unheard) == Lamp("DRIVES ?", True, is_warning=True)


def test_only_the_part_that_is_silent_is_unknown() -> None:
    view = make_machine_status(
        replace(AT, unknown=frozenset({UnknownPart.SPINDLE})), ReadoutKind.POSITION, True
    )
    assert all(axis.is_known for axis in view.position.axes)
    assert view.lamps[0].label == text("screen.spindle-unknown")
    assert view.lamps[1].label == "COOLANT"


def test_hold_that_waits_for_tapping_to_end_is_shown() -> None:
    held = replace(AT, state=MachineState.RUN, waiting_for="FEED HOLD BEHIND THE TAP")
    assert make_machine_status(held, ReadoutKind.POSITION, True).state_text == text("desk.hold-after-tap")


def test_metric_feed_has_a_prefix_and_inch_feed_does_not() -> None:
    metric = replace(Snapshot(), modal=ModalState(metric=True), feed=5.0)
    assert make_machine_status(metric, ReadoutKind.POSITION, has_c_axis=True).feed.value_prefix == "MM"
    assert make_machine_status(Snapshot(), ReadoutKind.POSITION, has_c_axis=True).feed.value_prefix == ""


def test_x_readout_is_doubled_exactly_when_marked_as_diameter() -> None:
    """The mode that remains after a program is that of the value, of the mark and of the words."""
    left = replace(Snapshot(), actual=(12.7, 0.0, 0.0), x_diameter=True)
    view = make_machine_status(left, ReadoutKind.POSITION, has_c_axis=True)
    x = view.position.axes[0]
    assert (x.diameter_mark, x.value) == ("Ø", "1.00000")
    assert "G73" in view.position.x_label  # what a typed program begins with


def test_an_overloaded_computer_is_the_first_cause_of_a_silent_control() -> None:
    entry = CATALOG["control-silent"]
    assert entry.number == 908
    assert "overloaded" in entry.causes[0]
