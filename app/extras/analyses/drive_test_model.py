"""Model of the drive test: selection, travel, motion and results.

The first press of an arrow key shows the travel. The next press of the same key moves the axis while the key
is held down. The test writes nothing to a drive.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar

from app.desk.desk import Desk
from app.desk.late_presses import Starting
from app.desk.pages.sheet import Row, Sheet, following
from app.desk.status import formats
from app.desk.status.formats import MM_PER_INCH
from app.desk.status.prompt_line import STOP_HELD
from app.desk.translation import tr
from app.extras.analyses.axis_response import Units, response_drawing
from app.extras.analyses.drawing import Drawing
from app.extras.analyses.drive_test_figures import (
    BEFORE,
    TESTED,
    DriveTestFigures,
    Part,
    drive_test_figures,
    figures_sheet,
    shown_words,
    words_of,
)
from app.jog.held_jog import Held, HeldJog, JogDirection, JogSpeeds, directions_of
from app.jog.jog_model import LEASE, why_no_jog
from app.scope.record_shelf import INSTANT
from app.scope.scope_model import Scope
from core.executor.commands import Command, DriveTest, DriveTestOn, JogStop
from core.executor.hand_motion import drive_test
from core.executor.hand_motion.drive_test import DriveTestPath, Limits, Shape
from core.executor.hand_motion.jog_line import room_to_limit
from core.executor.snapshot import BY_HAND, Snapshot, State
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.records.record import AnalysisError, Record

SHAPES = {Shape.STEP: "STEP", Shape.RAMP: "RAMP", Shape.SINE: "SINE"}
INCH_SIZES, MM_SIZES = (0.002, 0.005, 0.01, 0.02, 0.05, 0.1), (0.05, 0.1, 0.2, 0.5, 1.0, 2.5)
INCH_RAMPS, MM_RAMPS = (0.1, 0.2, 0.5, 1.0), (2.5, 5.0, 10.0, 25.0)
INCH_SPEEDS, MM_SPEEDS = (5.0, 20.0, 50.0, 100.0), (125.0, 500.0, 1250.0, 2500.0)  # per minute
SERIES = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0)  # Hz
_SETTLED = 0.3  # seconds after a test until its last samples are available

Asked = tuple[str, int]  # axis and sign


@dataclass(slots=True)
class HeldTest(HeldJog):
    """Key of a drive test that must be held down.

    ``path`` returns the test path, and ``asked`` is the direction whose travel is shown.
    """

    starting: ClassVar[Starting] = Starting.DRIVE_TEST
    path: Callable[[str, int], DriveTestPath] = field(kw_only=True)
    asked: Asked | None = None

    def _go(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        if rapid:
            self.asked = None
            self.say(tr("DRIVE TEST HAS NO RAPID. PRESS THE ARROW WITHOUT SHIFT"))
        elif self.asked != (axis, sign):
            self.clear()
            self.asked = axis, sign
        else:
            self.asked = None
            self._hold(source, axis, float(sign), False, DriveTest(self.path(axis, sign), self.lease))

    def _renewal(self, _held: Held, /) -> Command:
        return DriveTestOn(self.lease)


@dataclass(slots=True)
class DriveTests:
    """Model of the drive test page. ``drives`` are the linear axes by letter.

    ``part`` is the displayed part of the last results, or None for the selection.
    """

    desk: Desk
    scope: Scope
    machine: Machine
    shape: Shape = Shape.STEP
    size: int = 2
    way: int = 1
    speed: int = 1
    hertz: int = 0  # 0 for the series, otherwise the number of a single sine
    part: Part | None = None
    found: DriveTestFigures | None = None
    kept: str = ""  # file of the last test
    hold: HeldTest = field(init=False)
    directions: tuple[JogDirection, ...] = ()
    drives: Mapping[str, Axis] = field(default_factory=dict)
    _begun: tuple[DriveTestPath, int] | None = None  # active test and its number
    _whole: int = -1  # number of completed tests at the start

    def __post_init__(self) -> None:
        desk, machine = self.desk, self.machine
        self.drives = {axis.name: axis for axis in machine.axes if not axis.rotary}
        self.directions = tuple(each for each in directions_of(machine) if each.axis in self.drives)
        self.hold = HeldTest(
            JogSpeeds(machine),
            min(machine.timing.lease, LEASE),
            desk.post,
            desk.say,
            desk.clear,
            self._now,
            self.barred,
            refuses=desk.window.late.refuses,
            path=self.path,
        )

    def _now(self) -> float:
        return self.desk.hands.clock()

    # --- selection -----------------------------------------------------------------------------------

    @property
    def metric(self) -> bool:
        """Whether lengths are selected and displayed in mm."""
        return self.scope.metric

    def _of(self, inches: tuple[float, ...], mm: tuple[float, ...], at: int) -> float:
        """Return a length of a series in mm."""
        return mm[at] if self.metric else inches[at] * MM_PER_INCH

    def path(self, axis: str, sign: int) -> DriveTestPath:
        """Return the test path for a direction."""
        if self.shape is Shape.RAMP:
            size = self._of(INCH_RAMPS, MM_RAMPS, self.way)
            return DriveTestPath(
                axis, self.shape, sign * size, self._of(INCH_SPEEDS, MM_SPEEDS, self.speed) / 60
            )
        size = sign * self._of(INCH_SIZES, MM_SIZES, self.size)
        if self.shape is Shape.STEP:
            return DriveTestPath(axis, self.shape, size)
        fastest = self._limits(axis).fastest_sine
        series = tuple(each for each in SERIES if each <= fastest)
        one = (SERIES[self.hertz - 1],)
        return DriveTestPath(axis, self.shape, size, frequencies=one if self.hertz else series)

    def _limits(self, axis: str) -> Limits:
        machine, model = self.machine, self.machine.axis(axis)
        rate = self.desk.snapshot().drive_test.rate
        return Limits(min(model.vmax, machine.limits.manual_rapid), model.amax, rate)

    def next_shape(self) -> None:
        """Select the next shape: step, ramp or sine (F2)."""
        self._choose()
        self.shape = following(Shape, self.shape)

    def next_size(self) -> None:
        """Select the next larger size. The smallest size follows the largest (F3)."""
        self._choose()
        if self.shape is Shape.RAMP:
            self.way = (self.way + 1) % len(INCH_RAMPS)
        else:
            self.size = (self.size + 1) % len(INCH_SIZES)

    def next_speed(self) -> None:
        """Select the next speed of a ramp or the next frequency of a sine (F4)."""
        self._choose()
        if self.shape is Shape.RAMP:
            self.speed = (self.speed + 1) % len(INCH_SPEEDS)
        elif self.shape is Shape.SINE:
            self.hertz = (self.hertz + 1) % (len(SERIES) + 1)

    def toggle_figures(self) -> None:
        """Show the next part of the results, or the selection (F5)."""
        self.desk.clear()
        if self.found is None:
            self.desk.say(tr("NO TEST VALUES YET. RUN A TEST FIRST"))
        else:
            self.part = following((None, Part.RESPONSE, Part.WINDOW), self.part)

    def choose(self, row: int) -> None:
        """Change the setting of the touched row."""
        if self.part is None:
            actions = (self.next_shape, self.next_size, self.next_speed)
            if row < len(actions):
                actions[row]()

    def _choose(self) -> None:
        self.desk.clear()
        self.hold.let_go(tr("TEST STOPPED: ANOTHER TEST WAS SELECTED"))
        self.hold.asked, self.part = None, None

    # --- conditions and travel -------------------------------------------------------------------------

    def barred(self) -> str:
        """Return the reason why no test is possible now, or an empty string."""
        snapshot = self.desk.snapshot()
        if self.desk.window.is_stop_held():
            return tr(STOP_HELD)
        if snapshot.drive_test.barred:
            return tr(Message("DRIVE TEST NOT POSSIBLE: {why}", why=snapshot.drive_test.barred))
        if abs(snapshot.rpm_actual) >= 1.0 or snapshot.spindle_asked:
            return tr("SPINDLE IS TURNING. STOP IT FIRST")
        return why_no_jog(snapshot.state)

    def refusal(self, asked: Asked) -> str:
        """Return the reason why this direction cannot be tested, or an empty string.

        The control checks again.
        """
        axis, sign = asked
        snapshot, model = self.desk.snapshot(), self.machine.axis(axis)
        index = snapshot.axes.index(axis)
        if not snapshot.homed[index]:
            return tr(Message("{axis} NOT HOMED, SO TRAVEL CANNOT BE CHECKED. HOME IT FIRST", axis=axis))
        path, limits = self.path(axis, sign), self._limits(axis)
        if why := path.refusal(limits):
            return why
        low, high = drive_test.reach(path.ramps(limits))
        here = snapshot.demand[index]
        if max(high, 1e-9) > room_to_limit(model, here, 1.0) or max(-low, 1e-9) > room_to_limit(
            model, here, -1.0
        ):
            return tr(Message("NOT ENOUGH TRAVEL IN {axis}. JOG AWAY FROM THE END OF TRAVEL", axis=axis))
        return ""

    def travel(self, asked: Asked) -> str:
        """Return the text about start, end and duration of the travel in machine coordinates."""
        axis, sign = asked
        units, snapshot = Units(self.metric), self.desk.snapshot()
        path, limits = self.path(axis, sign), self._limits(axis)
        ramps, here = path.ramps(limits), snapshot.demand[snapshot.axes.index(axis)]
        low, high = drive_test.reach(ramps)
        return tr(
            Message(
                "{axis} FROM {position} TO {present} AND BACK IN {seconds} S",
                axis=axis,
                position=units.way(here),
                present=units.way(here + (high if sign > 0 else low)),
                seconds=formats.fixed(drive_test.seconds(ramps), 1),
            )
        )

    def asks(self) -> str:
        """Return the question about the travel of the next press, or an empty string."""
        asked = self.hold.asked
        if asked is None or self.hold.held is not None:
            return ""
        if why := self.barred() or self.refusal(asked):
            return why
        key = next(each.label for each in self.directions if (each.axis, each.sign) == asked)
        return tr(
            Message(
                "{travel}: HOLD {key} TO RUN THE TEST, RELEASE TO STOP", travel=self.travel(asked), key=key
            )
        )

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot) -> None:
        """Renew the motion while the key is held down, and follow the active test.

        Called once per frame.
        """
        self.hold.look(snapshot)
        if snapshot.state not in BY_HAND:
            self.hold.asked = None  # The prompt line belongs to an alarm or the E-stop.
        self.scope.filing.poll()
        told = snapshot.drive_test
        if self.hold.held is not None and (self._begun is None or told.axis == ""):
            held = self.hold.held
            self._begun = self.path(held.axis, 1 if held.velocity > 0.0 else -1), told.number
            self._whole = told.whole
        elif self._begun is not None and snapshot.state is not State.JOG and self.hold.held is None:
            self._ended(snapshot)

    def _ended(self, snapshot: Snapshot) -> None:
        """Finish a test. A complete test is analyzed once its last samples are available."""
        assert self._begun is not None
        told, live = snapshot.drive_test, self.scope.live
        if told.whole == self._whole or live is None:
            self._begun = None
            return
        path, began = self._begun[0], told.began
        ends = began + drive_test.seconds(path.ramps(self._limits(path.axis)))
        if snapshot.t < ends + _SETTLED or live.last < ends - _SETTLED:
            return
        self._begun = None
        self._work_out(path, began)

    def _work_out(self, path: DriveTestPath, began: float) -> None:
        live, shelf, drives = self.scope.live, self.scope.shelf, self.drives
        assert live is not None

        def work() -> tuple[DriveTestFigures | str, str]:
            record = live.between(began - 2.0 * BEFORE, live.last)
            instant = began - float(record.times[0]) if len(record.times) else 0.0
            told = {**record.about, TESTED: words_of(path), INSTANT: f"{instant:.6f}"}
            return _figures(replace(record, about=told), path, drives), shelf.keep(
                replace(record, about=told),
                Message("drive test {axis} {shape}", axis=path.axis, shape=path.shape.value),
            ).name

        self.scope.filing.queue(work, self._take, self.desk.refuse)

    def _take(self, answer: tuple[DriveTestFigures | str, str]) -> None:
        found, self.kept = answer
        if isinstance(found, str):
            self.desk.say(found)
            return
        self.found, self.part = found, Part.RESPONSE
        self.desk.say(tr(Message("SAVED: {path}", path=self.kept)))

    # --- keys ----------------------------------------------------------------------------------------

    def finger(self, source: str, axis: str, sign: int) -> None:
        """Handle a touch or mouse press on a direction."""
        self.hold.press(source, axis, sign, rapid=False)

    def typed(self, _key: str) -> bool:
        """Return False, because this page has no entry."""
        return False

    def takes(self, _key: str) -> bool:
        """Return False, because this page has no entry."""
        return False

    def opened(self) -> None:
        """Clear the requested direction when the page opens."""
        self.hold.asked = None

    def escape(self) -> bool:
        """Stop the motion or clear the question. Return False if the page can close."""
        if self.hold.held is not None:
            self.hold.let_go()
            return True
        asked, self.hold.asked = self.hold.asked, None
        return asked is not None

    @property
    def active(self) -> bool:
        """Whether a key is held down."""
        return self.hold.held is not None

    def let_go(self) -> None:
        """Stop the motion, because the keyboard, the window or the page has lost the focus."""
        self.hold.let_go(tr("TEST STOPPED: THIS PAGE NO LONGER HAS KEYBOARD FOCUS"))
        self.hold.asked = None

    def leave(self) -> None:
        """Stop all motion and clear the question when the page closes."""
        self.hold.let_go()
        if self.desk.snapshot().state is State.JOG:
            self.desk.post(JogStop())
        self.hold.asked = None
        self.desk.clear()

    def close(self) -> None:
        """Do nothing, because the worker belongs to the scope."""

    # --- display -------------------------------------------------------------------------------------

    def prompt(self) -> str:
        """Return the prompt for the present state."""
        why = self.barred()
        if why:
            return why
        if self.hold.held is not None:
            return tr("KEEP HOLDING THE KEY UNTIL THE AXIS HAS RETURNED")
        if self.found is None:
            return tr("PRESS AN ARROW TO SHOW THE TRAVEL. HOLD IT TO RUN THE TEST")
        return tr("PRESS ARROW: SHOW TRAVEL   HOLD ARROW: RUN TEST   F5: VALUES")

    def drawing(self) -> Drawing:
        """Return the drawing of command and actual position of the last test."""
        return response_drawing(self.found.move) if self.found is not None else Drawing()

    def words(self) -> str:
        """Return the description of the drawing."""
        if self.found is None:
            return tr("no test has been run yet")
        return shown_words(self.found.path, self.metric) + "  ·  " + self.kept

    def sheet(self) -> Sheet:
        """Return the table of the selection, or the results of the last test."""
        if self.part is not None and self.found is not None:
            return figures_sheet(tr("DRIVE TEST"), self.found, self.metric, self.part)
        units = Units(self.metric)
        path = self.path(next(iter(self.drives)), 1)
        speed = ""
        if self.shape is Shape.RAMP:
            speed = units.speed(path.speed)
        elif self.shape is Shape.SINE:
            speed = Message("{item} Hz", item=", ".join(f"{each:g}" for each in path.frequencies))
        rows = [
            Row((tr("SHAPE"), "F2", tr(SHAPES[self.shape]))),
            Row((tr("SIZE"), "F3", units.way(abs(path.size)))),
            Row(
                (
                    tr("FREQUENCY") if self.shape is Shape.SINE else tr("SPEED"),
                    "F4",
                    speed or tr("as fast as possible"),
                )
            ),
            *self._axis_rows(units),
        ]
        why = self.barred()
        notes = (
            *((why,) if why else ()),
            *(
                ()
                if "Y" in self.drives
                else (tr("SIZE is the travel of the axis; in X, the diameter changes by twice this travel."),)
            ),
            tr("The test does not write any data to the drive."),
        )
        heads, shares = ("", tr("KEY"), tr("SETTING")), (0.34, 0.16, 0.5)
        return Sheet(tr("DRIVE TEST"), heads, shares, tuple(rows), notes=notes, figures=frozenset({2}))

    def _axis_rows(self, units: Units) -> list[Row]:
        """Return the permitted following error of each linear axis at standstill and at full speed."""
        return [
            Row(
                (
                    tr(Message("FOLLOWING ERROR LIMIT {axis}", axis=name)),
                    "",
                    f"{units.way(axis.still_window)} … {units.way(axis.following_window)}",
                )
            )
            for name, axis in self.drives.items()
            if math.isfinite(axis.following_window)
        ]


def _figures(record: Record, path: DriveTestPath, drives: Mapping[str, Axis]) -> DriveTestFigures | str:
    try:
        return drive_test_figures(record, path, drives)
    except AnalysisError as error:
        return str(error)
