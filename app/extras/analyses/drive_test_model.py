"""Model of the drive test: selection, travel, motion and results.

The first press of an arrow key shows the travel of the test. When the same key is pressed again, the axis
moves while the key is held down. The test does not write to a drive.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar

from app.desk.desk import Desk
from app.desk.late_presses import BlockedLateAction
from app.desk.pages.table_content import TableContent, TableRow, following
from app.desk.status import formats
from app.desk.status.formats import MM_PER_INCH
from app.desk.status.prompt_line import RELEASE_STOP_KEY
from app.desk.translation import tr
from app.extras.analyses.axis_response import UnitFormat, draw_response
from app.extras.analyses.drawing import AnalysisDrawing
from app.extras.analyses.drive_test_results import (
    REST_BEFORE_TEST_S,
    TEST_PATH_KEY,
    DriveTestResults,
    ResultsSection,
    calculate_test_results,
    describe_test_path,
    format_test_path_json,
    make_results_table,
)
from app.jog.held_jog import ActiveJog, HeldJog, JogDirection, JogSpeeds, make_jog_directions
from app.jog.jog_model import MAX_LEASE_S, find_jog_refusal
from app.scope.recording_store import ZERO_INSTANT_KEY
from app.scope.scope_model import ScopeModel
from core.executor.commands import Command, RenewDriveTest, RunDriveTest, StopJog
from core.executor.hand_motion import drive_test
from core.executor.hand_motion.drive_test import AxisTestLimits, DriveTestMotion, Shape
from core.executor.hand_motion.jog_line import get_distance_to_limit
from core.executor.snapshot import MANUAL_STATES, MachineState, Snapshot
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.records.record import AnalysisError, ScopeRecord

SHAPE_NAMES = {Shape.STEP: "STEP", Shape.RAMP: "RAMP", Shape.SINE: "SINE"}
INCH_SIZES, MM_SIZES = (0.002, 0.005, 0.01, 0.02, 0.05, 0.1), (0.05, 0.1, 0.2, 0.5, 1.0, 2.5)
INCH_RAMPS, MM_RAMPS = (0.1, 0.2, 0.5, 1.0), (2.5, 5.0, 10.0, 25.0)
INCH_SPEEDS, MM_SPEEDS = (5.0, 20.0, 50.0, 100.0), (125.0, 500.0, 1250.0, 2500.0)  # per minute
SINE_FREQUENCIES_HZ = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0)  # Hz
_SETTLED = 0.3  # seconds after a test until its last samples are available

TestDirection = tuple[str, int]  # axis and sign


@dataclass(slots=True)
class HeldTestKey(HeldJog):
    """Key that the operator must hold down during a drive test.

    ``make_test_path`` returns the test path, and ``requested_direction`` is the direction whose travel is
    shown.
    """

    starting_action: ClassVar[BlockedLateAction] = BlockedLateAction.DRIVE_TEST
    make_test_path: Callable[[str, int], DriveTestMotion] = field(kw_only=True)
    requested_direction: TestDirection | None = None

    def _start_jog(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        if rapid:
            self.requested_direction = None
            self.show_message(tr("DRIVE TEST HAS NO RAPID. PRESS THE ARROW WITHOUT SHIFT"))
        elif self.requested_direction != (axis, sign):
            self.clear_message()
            self.requested_direction = axis, sign
        else:
            self.requested_direction = None
            self._hold(
                source,
                axis,
                float(sign),
                False,
                RunDriveTest(self.make_test_path(axis, sign), self.motion_lease_s),
            )

    def _renewal(self, _held: ActiveJog, /) -> Command:
        return RenewDriveTest(self.motion_lease_s)


@dataclass(slots=True)
class DriveTestModel:
    """Model of the drive test page.

    ``linear_axes`` contains the linear axes by letter. ``displayed_section`` is the section of the last
    results that is displayed, or None while the page shows the test settings.
    """

    desk: Desk
    scope: ScopeModel
    machine: Machine
    test_shape: Shape = Shape.STEP
    size_index: int = 2
    ramp_index: int = 1
    speed_index: int = 1
    frequency_index: int = 0  # 0 for the series, otherwise the number of a single sine
    displayed_section: ResultsSection | None = None
    results: DriveTestResults | None = None
    saved_record_name: str = ""  # file of the last test
    held_jog: HeldTestKey = field(init=False)
    directions: tuple[JogDirection, ...] = ()
    linear_axes: Mapping[str, Axis] = field(default_factory=dict)
    _begun: tuple[DriveTestMotion, int] | None = None  # active test and its number
    _whole: int = -1  # number of completed tests at the start

    def __post_init__(self) -> None:
        desk, machine = self.desk, self.machine
        self.linear_axes = {axis.name: axis for axis in machine.axes if not axis.is_rotary}
        self.directions = tuple(
            each for each in make_jog_directions(machine) if each.axis_name in self.linear_axes
        )
        self.held_jog = HeldTestKey(
            JogSpeeds(machine),
            min(machine.timing.motion_lease_s, MAX_LEASE_S),
            desk.post,
            desk.say,
            desk.clear_prompt_line,
            self._now,
            self.find_test_refusal,
            refuses_late_press=desk.window_state.late_presses.refuse_late_press,
            make_test_path=self.make_test_path,
        )

    def _now(self) -> float:
        return self.desk.station_controls.clock()

    # --- selection -----------------------------------------------------------------------------------

    @property
    def is_metric(self) -> bool:
        """Return whether lengths are selected and displayed in mm."""
        return self.scope.metric

    def _get_series_length(self, inches: tuple[float, ...], mm: tuple[float, ...], at: int) -> float:
        """Return one length from a series of selectable lengths, converted to mm.

        ``at`` is the index in the series for the selected unit.
        """
        return mm[at] if self.is_metric else inches[at] * MM_PER_INCH

    def make_test_path(self, axis: str, sign: int) -> DriveTestMotion:
        """Return the test path for the current settings, an axis and a direction."""
        if self.test_shape is Shape.RAMP:
            size = self._get_series_length(INCH_RAMPS, MM_RAMPS, self.ramp_index)
            return DriveTestMotion(
                axis,
                self.test_shape,
                sign * size,
                self._get_series_length(INCH_SPEEDS, MM_SPEEDS, self.speed_index) / 60,
            )
        size = sign * self._get_series_length(INCH_SIZES, MM_SIZES, self.size_index)
        if self.test_shape is Shape.STEP:
            return DriveTestMotion(axis, self.test_shape, size)
        fastest = self._limits(axis).max_sine_frequency_hz
        series = tuple(each for each in SINE_FREQUENCIES_HZ if each <= fastest)
        one = (SINE_FREQUENCIES_HZ[self.frequency_index - 1],)
        return DriveTestMotion(
            axis, self.test_shape, size, frequencies_hz=one if self.frequency_index else series
        )

    def _limits(self, axis: str) -> AxisTestLimits:
        machine, model = self.machine, self.machine.find_axis(axis)
        rate = self.desk.read_snapshot().drive_test.sample_rate_hz
        return AxisTestLimits(min(model.max_speed, machine.limits.manual_rapid), model.max_acceleration, rate)

    def select_next_shape(self) -> None:
        """Select the next shape: step, ramp or sine (F2)."""
        self._choose()
        self.test_shape = following(Shape, self.test_shape)

    def select_next_size(self) -> None:
        """Select the next larger size, or the smallest size after the largest (F3)."""
        self._choose()
        if self.test_shape is Shape.RAMP:
            self.ramp_index = (self.ramp_index + 1) % len(INCH_RAMPS)
        else:
            self.size_index = (self.size_index + 1) % len(INCH_SIZES)

    def select_next_speed(self) -> None:
        """Select the next speed of a ramp or the next frequency of a sine (F4)."""
        self._choose()
        if self.test_shape is Shape.RAMP:
            self.speed_index = (self.speed_index + 1) % len(INCH_SPEEDS)
        elif self.test_shape is Shape.SINE:
            self.frequency_index = (self.frequency_index + 1) % (len(SINE_FREQUENCIES_HZ) + 1)

    def show_next_results(self) -> None:
        """Show the next section of the results, or the test settings after the last section (F5)."""
        self.desk.clear_prompt_line()
        if self.results is None:
            self.desk.say(tr("NO TEST VALUES YET. RUN A TEST FIRST"))
        else:
            self.displayed_section = following(
                (None, ResultsSection.RESPONSE, ResultsSection.LIMITS), self.displayed_section
            )

    def change_setting(self, row: int) -> None:
        """Select the next value of the setting in the touched row."""
        if self.displayed_section is None:
            actions = (self.select_next_shape, self.select_next_size, self.select_next_speed)
            if row < len(actions):
                actions[row]()

    def _choose(self) -> None:
        self.desk.clear_prompt_line()
        self.held_jog.release_all_keys(tr("TEST STOPPED: ANOTHER TEST WAS SELECTED"))
        self.held_jog.requested_direction, self.displayed_section = None, None

    # --- conditions and travel -------------------------------------------------------------------------

    def find_test_refusal(self) -> str:
        """Return the reason why no test can start now, or an empty string if a test can start."""
        snapshot = self.desk.read_snapshot()
        if self.desk.window_state.is_stop_key_held():
            return tr(RELEASE_STOP_KEY)
        if snapshot.drive_test.barred:
            return tr(Message("DRIVE TEST NOT POSSIBLE: {why}", why=snapshot.drive_test.barred))
        if abs(snapshot.rpm_actual) >= 1.0 or snapshot.requested_rpm:
            return tr("SPINDLE IS TURNING. STOP IT FIRST")
        return find_jog_refusal(snapshot.state)

    def find_direction_refusal(self, direction: TestDirection) -> str:
        """Return why an axis cannot be tested in this direction, or an empty string if it can.

        The control makes its own check before the axis moves.
        """
        axis, sign = direction
        snapshot, model = self.desk.read_snapshot(), self.machine.find_axis(axis)
        index = snapshot.axes.index(axis)
        if not snapshot.homed[index]:
            return tr(Message("{axis} NOT HOMED, SO TRAVEL CANNOT BE CHECKED. HOME IT FIRST", axis=axis))
        path, limits = self.make_test_path(axis, sign), self._limits(axis)
        if why := path.find_refusal_reason(limits):
            return why
        low, high = drive_test.compute_position_range(path.make_ramps(limits))
        here = snapshot.demand[index]
        if max(high, 1e-9) > get_distance_to_limit(model, here, 1.0) or max(
            -low, 1e-9
        ) > get_distance_to_limit(model, here, -1.0):
            return tr(Message("NOT ENOUGH TRAVEL IN {axis}. JOG AWAY FROM THE END OF TRAVEL", axis=axis))
        return ""

    def describe_travel(self, direction: TestDirection) -> str:
        """Return the start, end and duration of the test travel as display text.

        The positions are in machine coordinates.
        """
        axis, sign = direction
        units, snapshot = UnitFormat(self.is_metric), self.desk.read_snapshot()
        path, limits = self.make_test_path(axis, sign), self._limits(axis)
        ramps, here = path.make_ramps(limits), snapshot.demand[snapshot.axes.index(axis)]
        low, high = drive_test.compute_position_range(ramps)
        return tr(
            Message(
                "{axis} FROM {position} TO {present} AND BACK IN {seconds} S",
                axis=axis,
                position=units.format_length(here),
                present=units.format_length(here + (high if sign > 0 else low)),
                seconds=formats.format_fixed(drive_test.compute_duration_s(ramps), 1),
            )
        )

    def make_travel_question(self) -> str:
        """Return the pending question about the travel of the next test, or else an empty string."""
        asked = self.held_jog.requested_direction
        if asked is None or self.held_jog.active_jog is not None:
            return ""
        if why := self.find_test_refusal() or self.find_direction_refusal(asked):
            return why
        key = next(each.label for each in self.directions if (each.axis_name, each.direction_sign) == asked)
        return tr(
            Message(
                "{travel}: HOLD {key} TO RUN THE TEST, RELEASE TO STOP",
                travel=self.describe_travel(asked),
                key=key,
            )
        )

    # --- every frame ---------------------------------------------------------------------------------

    def update(self, snapshot: Snapshot) -> None:
        """Renew the motion lease while the key is held down, and monitor the active test.

        Without renewal, the axis stops. This method is called once per frame.
        """
        self.held_jog.update(snapshot)
        if snapshot.state not in MANUAL_STATES:
            self.held_jog.requested_direction = None  # The prompt line belongs to an alarm or the E-stop.
        self.scope.file_worker.deliver_results()
        test_status = snapshot.drive_test
        if self.held_jog.active_jog is not None and (self._begun is None or test_status.tested_axis == ""):
            held = self.held_jog.active_jog
            self._begun = (
                self.make_test_path(held.axis_name, 1 if held.velocity > 0.0 else -1),
                test_status.number,
            )
            self._whole = test_status.completed_test_count
        elif (
            self._begun is not None
            and snapshot.state is not MachineState.JOG
            and self.held_jog.active_jog is None
        ):
            self._ended(snapshot)

    def _ended(self, snapshot: Snapshot) -> None:
        """Handle the end of a test, whether it was completed or stopped.

        A completed test is analyzed when its last samples are available.
        """
        assert self._begun is not None
        test_status, live = snapshot.drive_test, self.scope.live_samples
        if test_status.completed_test_count == self._whole or live is None:
            self._begun = None
            return
        path, began = self._begun[0], test_status.start_time_s
        ends = began + drive_test.compute_duration_s(path.make_ramps(self._limits(path.axis)))
        if snapshot.t < ends + _SETTLED or live.newest_time_s < ends - _SETTLED:
            return
        self._begun = None
        self._work_out(path, began)

    def _work_out(self, path: DriveTestMotion, began: float) -> None:
        live, shelf, drives = self.scope.live_samples, self.scope.recording_store, self.linear_axes
        assert live is not None

        def calculate_and_save_results() -> tuple[DriveTestResults | str, str]:
            record = live.read_samples_between(began - 2.0 * REST_BEFORE_TEST_S, live.newest_time_s)
            instant = began - float(record.times_s[0]) if len(record.times_s) else 0.0
            metadata = {
                **record.about,
                TEST_PATH_KEY: format_test_path_json(path),
                ZERO_INSTANT_KEY: f"{instant:.6f}",
            }
            return _figures(replace(record, about=metadata), path, drives), shelf.save_dated_record(
                replace(record, about=metadata),
                Message("drive test {axis} {shape}", axis=path.axis, shape=path.shape.value),
            ).name

        self.scope.file_worker.enqueue_work(calculate_and_save_results, self._take, self.desk.show_refusal)

    def _take(self, answer: tuple[DriveTestResults | str, str]) -> None:
        found, self.saved_record_name = answer
        if isinstance(found, str):
            self.desk.say(found)
            return
        self.results, self.displayed_section = found, ResultsSection.RESPONSE
        self.desk.say(tr(Message("SAVED: {path}", path=self.saved_record_name)))

    # --- keys ----------------------------------------------------------------------------------------

    def handle_direction_press(self, key_source: str, axis: str, direction_sign: int) -> None:
        """Handle a touch or mouse press on a direction arrow."""
        self.held_jog.handle_direction_press(key_source, axis, direction_sign, is_rapid=False)

    def handle_key(self, _key: str) -> bool:
        """Return False because this page has no entry field."""
        return False

    def accepts_key(self, _key: str) -> bool:
        """Return False because this page has no entry field."""
        return False

    def on_open(self) -> None:
        """Clear the question about the test travel when the page opens."""
        self.held_jog.requested_direction = None

    def handle_escape(self) -> bool:
        """Stop the motion or clear the question, and return False if the page can close."""
        if self.held_jog.active_jog is not None:
            self.held_jog.release_all_keys()
            return True
        asked, self.held_jog.requested_direction = self.held_jog.requested_direction, None
        return asked is not None

    @property
    def is_active(self) -> bool:
        """Return whether a test key is held down."""
        return self.held_jog.active_jog is not None

    def release_all_keys(self) -> None:
        """Stop the motion when the page loses the keyboard focus, because key releases are then lost."""
        self.held_jog.release_all_keys(tr("TEST STOPPED: THIS PAGE NO LONGER HAS KEYBOARD FOCUS"))
        self.held_jog.requested_direction = None

    def stop_test(self) -> None:
        """Stop all motion and clear the question when the page closes."""
        self.held_jog.release_all_keys()
        if self.desk.read_snapshot().state is MachineState.JOG:
            self.desk.post(StopJog())
        self.held_jog.requested_direction = None
        self.desk.clear_prompt_line()

    def close(self) -> None:
        """Do nothing because the worker belongs to the scope."""

    # --- display -------------------------------------------------------------------------------------

    def prompt_text(self) -> str:
        """Return the prompt for the current state of the test."""
        why = self.find_test_refusal()
        if why:
            return why
        if self.held_jog.active_jog is not None:
            return tr("KEEP HOLDING THE KEY UNTIL THE AXIS HAS RETURNED")
        if self.results is None:
            return tr("PRESS AN ARROW TO SHOW THE TRAVEL. HOLD IT TO RUN THE TEST")
        return tr("PRESS ARROW: SHOW TRAVEL   HOLD ARROW: RUN TEST   F5: VALUES")

    def make_drawing(self) -> AnalysisDrawing:
        """Return the drawing of the commanded and the actual position of the last test."""
        return draw_response(self.results.motion) if self.results is not None else AnalysisDrawing()

    def describe_drawing(self) -> str:
        """Return the description of the drawing."""
        if self.results is None:
            return tr("no test has been run yet")
        return describe_test_path(self.results.test_path, self.is_metric) + "  ·  " + self.saved_record_name

    def make_table(self) -> TableContent:
        """Return the table of the test settings, or of the results of the last test."""
        if self.displayed_section is not None and self.results is not None:
            return make_results_table(tr("DRIVE TEST"), self.results, self.is_metric, self.displayed_section)
        units = UnitFormat(self.is_metric)
        path = self.make_test_path(next(iter(self.linear_axes)), 1)
        speed = ""
        if self.test_shape is Shape.RAMP:
            speed = units.format_speed(path.speed)
        elif self.test_shape is Shape.SINE:
            speed = Message("{item} Hz", item=", ".join(f"{each:g}" for each in path.frequencies_hz))
        rows = [
            TableRow((tr("SHAPE"), "F2", tr(SHAPE_NAMES[self.test_shape]))),
            TableRow((tr("SIZE"), "F3", units.format_length(abs(path.travel_mm)))),
            TableRow(
                (
                    tr("FREQUENCY") if self.test_shape is Shape.SINE else tr("SPEED"),
                    "F4",
                    speed or tr("as fast as possible"),
                )
            ),
            *self._axis_rows(units),
        ]
        why = self.find_test_refusal()
        notes = (
            *((why,) if why else ()),
            *(
                ()
                if "Y" in self.linear_axes
                else (tr("SIZE is the travel of the axis; in X, the diameter changes by twice this travel."),)
            ),
            tr("The test does not write any data to the drive."),
        )
        heads, shares = ("", tr("KEY"), tr("SETTING")), (0.34, 0.16, 0.5)
        return TableContent(
            tr("DRIVE TEST"), heads, shares, tuple(rows), notes=notes, numeric_columns=frozenset({2})
        )

    def _axis_rows(self, units: UnitFormat) -> list[TableRow]:
        """Return rows with the following-error limit of each linear axis at standstill and full speed."""
        return [
            TableRow(
                (
                    tr(Message("FOLLOWING ERROR LIMIT {axis}", axis=name)),
                    "",
                    f"{units.format_length(axis.standstill_tolerance)} … "
                    f"{units.format_length(axis.following_error_window)}",
                )
            )
            for name, axis in self.linear_axes.items()
            if math.isfinite(axis.following_error_window)
        ]


def _figures(
    record: ScopeRecord, path: DriveTestMotion, drives: Mapping[str, Axis]
) -> DriveTestResults | str:
    try:
        return calculate_test_results(record, path, drives)
    except AnalysisError as error:
        return str(error)
