"""A snapshot as data items, each value reckoned by hand; what cannot be known is not told."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import cast

import pytest

from app.compose.machine.machine_files import load_machine, load_shipped_machine
from app.shopfloor.machine_reading import CONDITION_PLACES, MachineReader, ReadingValue, list_condition_keys
from core.alarms import CATALOG, AlarmCode
from core.executor.raised_alarm import AlarmError, make_alarm, make_alarm_and_reaction
from core.executor.snapshot import Alarm, MachineState, Snapshot
from core.interpreter.shared.modal_state import ModalState
from core.machine.machine_model import InputModel, Machine
from core.ports import ALL_UNKNOWN_PARTS
from tests.interrupted import broken_off
from tests.texts import text

KEYS = frozenset(
    ["Xtravel", "Ztravel", "Xservo", "Zservo", "Sdrive", "comms", "logic", "system", "motion"]  # of the lathe
)
LATHE = load_machine(None)
AT = Snapshot(
    t=1.0,
    state=MachineState.RUN,
    program="/home/op/programs/pin.nc",
    line=7,
    block=3,
    block_text="  G01X.5 ",
    actual=(12.7, -25.4, 90.0),
    homed=(True, True, True),
    modal=ModalState(tool=3),
    velocity=5.08,
    feed_override=0.805,
    spindle_override=1.2,
    rpm_actual=-2001.5,
    requested_rpm=-2000.0,
    inputs=frozenset({"collet_closed"}),
    outputs=frozenset({"collet"}),
    parts=12,
)


def values_of(snapshot: Snapshot, machine: Machine = LATHE) -> Mapping[str, ReadingValue]:
    return MachineReader(machine, lambda: 0.0).make_reading(snapshot).values


def test_running_machine_gives_expected_values() -> None:
    assert values_of(AT) == {
        "avail": "AVAILABLE",
        "estop": "ARMED",
        "mode": "AUTOMATIC",
        "execution": "ACTIVE",
        "program": "pin.nc",
        "line": "7",
        "block": "G01X.5",
        "toolnum": "3",
        "pcount": "12",
        "Xabs": 12.7,  # mm, a radius, from home
        "Zabs": -25.4,
        "Cabs": 90.0,
        "Fact": 5.08,
        "Fovr": pytest.approx(80.5),
        "Srpm": 2001.5,  # a speed has no direction
        "Scmd": 2000.0,
        "Sovr": pytest.approx(120.0),
        "Sload": None,  # this machine has no such input
        "rotmode": "SPINDLE",
        "chuckil": "INACTIVE",
        "chuck": "CLOSED",
        "door": "OPEN",  # the guard's switch is off
        "endbar": "NO",
        "part": None,  # nothing is wired
    }


@pytest.mark.parametrize(
    ("change", "key", "told"),
    [
        ({"state": MachineState.ESTOP}, "estop", "TRIGGERED"),
        ({"program": ""}, "program", None),
        ({"line": 0}, "line", None),
        ({"block_text": "  "}, "block", None),
        ({"modal": ModalState()}, "toolnum", "0"),
        ({"homed": (False, True, True)}, "Xabs", None),
        ({"velocity": 0.13}, "Fact", 0.0),  # an encoder that trembles
        ({"rpm_actual": 0.4}, "Srpm", 0.0),
        ({"spindle_load": 42.5}, "Sload", 42.5),
        ({"modal": ModalState(c_locked=True)}, "rotmode", "CONTOUR"),
        ({"inputs": frozenset()}, "chuck", "UNLATCHED"),  # told to close, and not there yet
        ({"inputs": frozenset(), "outputs": frozenset()}, "chuck", "OPEN"),
        ({"outputs": frozenset()}, "chuck", "CLOSED"),  # told to open, and still there
        ({"inputs": frozenset({"guard", "end_of_bar"})}, "door", "CLOSED"),
        ({"inputs": frozenset({"guard", "end_of_bar"})}, "endbar", "YES"),
    ],
)
def test_each_change_of_machine_changes_its_value(
    change: dict[str, object], key: str, told: ReadingValue
) -> None:
    assert values_of(replace(AT, **change))[key] == told  # type: ignore[arg-type]


def test_values_of_missing_switches_are_unknown() -> None:
    values = values_of(AT, replace(LATHE, inputs={}))
    assert {values[key] for key in ("chuck", "door", "endbar", "part")} == {None}


def test_input_named_part_reports_part_in_chuck() -> None:
    wired = replace(LATHE, inputs={**LATHE.inputs, "part": InputModel("part", "IN-7")})
    assert values_of(AT, wired)["part"] == "NOT_PRESENT"
    assert values_of(replace(AT, inputs=frozenset({"part"})), wired)["part"] == "PRESENT"


def test_c_angle_is_unknown_without_c_axis() -> None:
    assert values_of(AT, replace(LATHE, is_c_enabled=False))["Cabs"] is None


@pytest.mark.parametrize(("rpm", "told"), [(300.0, "ACTIVE"), (-300.0, "ACTIVE"), (1.0, "INACTIVE")])
def test_chuck_interlock_is_active_while_spindle_turns(rpm: float, told: str) -> None:
    strict = replace(LATHE, interlocks=replace(LATHE.interlocks, unclamp_while_turning=False))
    assert values_of(replace(AT, rpm_actual=rpm), strict)["chuckil"] == told


# --- a control that says nothing any more ----------------------------------------------------------------


def test_nothing_is_known_of_silent_control() -> None:
    now = 100.0
    reader = MachineReader(LATHE, lambda: now)
    assert reader.make_reading(AT).is_available
    now += 0.9
    assert reader.make_reading(AT).is_available
    now += 0.2
    reading = reader.make_reading(AT)
    assert (reading.values, reading.conditions) == ({"avail": "UNAVAILABLE"}, {})
    assert reader.make_reading(replace(AT, t=2.0)).is_available  # it speaks again


# --- conditions ------------------------------------------------------------------------------------------


def active(snapshot: Snapshot) -> dict[str, tuple[tuple[str, str, str], ...]]:
    reading = MachineReader(LATHE, lambda: 0.0).make_reading(snapshot)
    assert set(reading.conditions) == KEYS
    return {key: found for key, found in reading.conditions.items() if found}


def alarm(code: AlarmCode, detail: str = "") -> Alarm:
    return make_alarm_and_reaction(AlarmError(code, detail), 0, 0.0)[0]


JOB = text("executor.interrupted-job", program="PIN.NC", line=8, tool="T3", part=5, why="E-STOP")


def moved(axis: str) -> str:
    return text("executor.line-moves", line=12, axis=axis, place="150.000", unit="mm")


def test_conditions_are_normal_without_alarms() -> None:
    assert active(AT) == {}


@pytest.mark.parametrize(
    ("code", "detail", "key"),
    [
        ("axis", "X: over current", "Xservo"),
        ("axis", "Z: following error", "Zservo"),
        ("axis", "C: over current", "Sdrive"),  # the spindle is C
        ("axis", "the drives have lost power", "system"),
        ("following", text("executor.off-setpoint", axis="Z", distance="2.345"), "Zservo"),
        ("in-position", "", "system"),
        ("travel", moved("X"), "Xtravel"),
        ("travel", moved("Z"), "Ztravel"),
        ("travel", "", "motion"),
        ("driver", "the bus is off", "comms"),
        ("spindle", "VFD: E07", "Sdrive"),
        ("thread-lost", "", "Sdrive"),
        ("spindle-still", "", "motion"),
        ("program", "", "motion"),
        ("collet", "", "logic"),
        ("unclamp", "the spindle turns at 300 rpm", "logic"),
        ("internal", "KeyError: 'X'", "system"),
    ],
)
def test_alarm_is_reported_at_its_component(code: AlarmCode, detail: str, key: str) -> None:
    raised = alarm(code, detail)
    fault = ("FAULT", str(raised.number), f"{raised.text}: {raised.cause}")
    assert active(replace(AT, state=MachineState.FAULT, alarms=(raised,))) == {key: (fault,)}


@pytest.mark.parametrize("code", CONDITION_PLACES)
def test_every_assigned_alarm_code_exists(code: AlarmCode) -> None:
    assert alarm(code).code == code


def test_unassigned_alarm_is_reported_at_system() -> None:
    unknown = cast("AlarmCode", "new")  # no catalogue has it
    new = Alarm(999, unknown, "SOMETHING NEW", "nobody knows", "")
    assert active(replace(AT, alarms=(new,))) == {
        "system": (("FAULT", "999", "SOMETHING NEW: nobody knows"),)
    }


def test_two_faults_of_one_axis_are_both_reported() -> None:
    both = (
        alarm("axis", "X: over current"),
        alarm("following", text("executor.off-setpoint", axis="X", distance="2.345")),
    )
    assert [code for _, code, _ in active(replace(AT, alarms=both))["Xservo"]] == ["101", "102"]


def test_interrupted_job_is_a_system_warning_until_cleared() -> None:
    left = replace(Snapshot(state=MachineState.IDLE), interrupted=broken_off())
    assert active(left) == {"system": (("WARNING", "interrupted", JOB),)}


def test_automatic_feed_hold_is_a_warning() -> None:
    held = replace(AT, state=MachineState.HOLD, stop=make_alarm("low-queue", "", 4, 0.0))
    assert active(held) == {"system": (("WARNING", "904", CATALOG["low-queue"].text.upper()),)}
    assert active(replace(held, stop=make_alarm("feed-hold", "H at the keyboard", 4, 0.0))) == {}
    assert active(replace(held, stop=None)) == {}
    assert active(replace(AT, state=MachineState.WAIT, waiting_for="DWELL")) == {}


def test_waiting_for_any_input_of_the_machine_is_waiting_for_a_device() -> None:
    for waits in ("TB2-5", "end_of_bar", "16", "PLC-16"):
        assert values_of(replace(AT, state=MachineState.WAIT, waiting_for=waits))["execution"] == "WAIT"
    assert values_of(replace(AT, state=MachineState.WAIT, waiting_for="TB9-9"))["execution"] == "ACTIVE"


def test_last_values_of_unresponsive_machine_are_not_reported() -> None:
    values = values_of(replace(AT, unknown=ALL_UNKNOWN_PARTS))
    unheard = ("Xabs", "Zabs", "Cabs", "Srpm", "Sload", "Fact", "chuck", "door", "endbar", "part", "chuckil")
    assert [key for key in unheard if values[key] is not None] == []
    assert (values["avail"], values["program"], values["line"]) == ("AVAILABLE", "pin.nc", "7")


@pytest.mark.parametrize(
    ("name", "axes"),
    [("gt75", "XZ"), ("sinumerik-linear", "XZC"), ("ac-table-mill", "XYZAC")],  # on a GT-75 the spindle is C
)
def test_each_axis_with_its_own_drive_has_its_own_conditions(name: str, axes: str) -> None:
    of_machine = KEYS - {"Xtravel", "Ztravel", "Xservo", "Zservo"}
    of_axes = {f"{axis}{kind}" for axis in axes for kind in ("travel", "servo")}
    assert list_condition_keys(load_shipped_machine(name)) == of_machine | of_axes
