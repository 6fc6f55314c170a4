"""Director of the tour, which presses the keys of an operator on a simulated lathe, step by step.

The director is called a few times a second. It never waits, and it moves the machine only with the keys
that an operator presses.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Protocol

from app.desk.desk import Desk
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.prompt_line import INTERRUPTED_STATES, MOVING_STATES
from app.desk.translation import tr
from app.extras.tour.tour_setup import is_fully_simulated
from app.offsets.offset_effect import OffsetEffectWorker
from core.executor.commands import Reset
from core.executor.snapshot import MachineState, Snapshot
from core.extras.tour.tour_script import (
    FAULTY_PROGRAM_NAME,
    PALMS_DOWN,
    TOUR_STEPS,
    StepEnd,
    TourStep,
    find_wrong_line,
    read_programs,
)
from core.message import Message

KEY_INTERVAL_S = 0.35  # Seconds between two keys, so that a viewer can follow them.
MAX_STEP_S = 60.0  # Seconds after which a step whose condition is not met ends the tour.
MAX_STOP_S = 8.0  # Seconds after which a tour that is being stopped ends in any state.
STANDSTILL_RPM = 10.0  # Below this speed, the spindle counts as stopped.
START_RETRY_S = 2.0  # Seconds after which the palm buttons are pressed again if the cycle did not start.
_DISTURBED_STATES = INTERRUPTED_STATES | {MachineState.FAULT, MachineState.ESTOP}


class TourKeyboard(Protocol):
    """Keyboard of the simulated operator, which presses keys on the screen."""

    def press_key(self, key: str) -> None:
        """Press a key by its name in the script of the tour."""
        ...


class TourDirector:
    """Director of one tour of a simulated lathe. ``on_end`` is called once when the tour has ended.

    The machine is then at rest with its spindle stopped, unless it did not stop in time.
    """

    def __init__(self, desk: Desk, keyboard: TourKeyboard, on_end: Callable[[], None]) -> None:
        self._desk, self._keyboard, self._on_end = desk, keyboard, on_end
        self._clock = desk.station_controls.clock
        self._wrong_line = find_wrong_line(read_programs()[FAULTY_PROGRAM_NAME])
        self._index = -1
        self._keys = deque[str]()
        self._begun_at_s = self._pressed_at_s = self._clock()
        self._parts_at_begin = desk.read_snapshot().parts
        self._is_stopping = self._has_ended = False

    # --- state ---------------------------------------------------------------------------------------

    @property
    def current_step(self) -> TourStep | None:
        """Return the current step, or None before the first step."""
        return TOUR_STEPS[self._index] if self._index >= 0 else None

    @property
    def is_stopping(self) -> bool:
        """Return whether the tour has been stopped and waits until the machine is at rest."""
        return self._is_stopping

    def make_row(self) -> NoticeRow | None:
        """Return the row with the caption of the current step."""
        step = self.current_step
        if step is None or self._has_ended:
            return None
        if self._is_stopping:
            return _make_caption(tr("THE TOUR ENDS: FEED HOLD, THEN SPINDLE OFF"))
        caption = step.caption
        if step.end is StepEnd.REJECTED:
            caption = Message(caption, line=self._wrong_line)
        values = {"step": self._index + 1, "count": len(TOUR_STEPS)}
        words = tr(Message("TOUR ON A SIMULATED LATHE: {step} OF {count}", **values))
        return _make_caption(tr(caption), f"{words}  ·  {tr('ANY KEY OR TOUCH ENDS THE TOUR')}")

    def close_card(self) -> bool:
        """End the tour, and return False if it has ended already."""
        was_running = not self._has_ended
        self.stop()
        return was_running

    def can_move_machine(self) -> bool:
        """Return whether all drivers of the machine are simulated, so that the tour may press keys."""
        desk = self._desk
        return is_fully_simulated(desk.machine.machine) and desk.desk_control.station_panel is not None

    # --- progress ------------------------------------------------------------------------------------

    def advance(self) -> None:
        """Press the next key, or begin the next step when the current step is over."""
        if self._has_ended:
            return
        now, snapshot = self._clock(), self._desk.read_snapshot()
        if self._is_stopping:
            self._continue_stop(now, snapshot)
        elif not self.can_move_machine() or now - self._begun_at_s > MAX_STEP_S or _is_disturbed(snapshot):
            self.stop()
        elif self._keys:
            self._press_next_key(now)
        elif self._is_step_over(now, snapshot):
            self._begin_next_step(now)
        elif self._must_press_again(now, snapshot):
            self._keys.extend(self.current_step.keys if self.current_step else ())

    def stop(self) -> None:
        """Stop the machine with a feed hold, and end the tour when the machine is at rest."""
        if self._is_stopping or self._has_ended:
            return
        self._is_stopping, self._begun_at_s = True, self._clock()
        self._keys.clear()
        self._desk.station_controls.release_all_buttons()
        self._desk.start_feed_hold()

    def _continue_stop(self, now: float, snapshot: Snapshot) -> None:
        """Cancel the program after the feed hold, and end the tour when the spindle has stopped."""
        if snapshot.state in INTERRUPTED_STATES:
            self._desk.post(Reset())
        if _is_at_rest(snapshot) or now - self._begun_at_s > MAX_STOP_S:
            self._end()

    def _end(self) -> None:
        self._has_ended = True
        self._on_end()

    def _begin_next_step(self, now: float) -> None:
        if self._index + 1 >= len(TOUR_STEPS):
            self._end()
            return
        self._index += 1
        self._begun_at_s = now
        step = TOUR_STEPS[self._index]
        self._keys.extend(step.keys)
        if step.program:
            self._desk.program_choice.load_by_name(step.program)

    def _press_next_key(self, now: float) -> None:
        if now - self._pressed_at_s >= KEY_INTERVAL_S:
            self._pressed_at_s = now
            self._keyboard.press_key(self._keys.popleft())

    def _must_press_again(self, now: float, snapshot: Snapshot) -> bool:
        """Return whether the palm buttons have not started the cycle, for example without the focus."""
        step = self.current_step
        is_start = step is not None and step.end is StepEnd.TOOL and PALMS_DOWN in step.keys
        return is_start and snapshot.state is MachineState.IDLE and now - self._pressed_at_s > START_RETRY_S

    # --- conditions ----------------------------------------------------------------------------------

    def _is_step_over(self, now: float, snapshot: Snapshot) -> bool:
        step = self.current_step
        if step is None:
            return True
        if now - self._begun_at_s < step.seconds:
            return False
        loaded = self._desk.program_loader.loaded_program
        effect = self._desk.page_registry.find_model(OffsetEffectWorker)
        checks: dict[StepEnd, Callable[[], bool]] = {
            StepEnd.TIME: lambda: True,
            StepEnd.PROVED: lambda: loaded.name == step.program and _can_start(loaded),
            StepEnd.READY: lambda: snapshot.state is MachineState.IDLE,
            StepEnd.TOOL: lambda: snapshot.state in MOVING_STATES and snapshot.modal.tool == step.tool,
            StepEnd.FINISHED: lambda: (
                snapshot.parts > self._parts_at_begin and snapshot.state is MachineState.IDLE
            ),
            StepEnd.CORRECTED: lambda: bool(self._desk.offset_book.secondary_offsets),
            StepEnd.PATHS_COMPARED: lambda: effect is not None and effect.compared_paths is not None,
            StepEnd.PARTS_COMPARED: lambda: effect is not None and effect.compared_part is not None,
            StepEnd.REJECTED: lambda: loaded.name == step.program and bool(loaded.blocking_errors),
        }
        return checks[step.end]()


def _can_start(loaded: LoadedProgram) -> bool:
    """Return whether the program is proved without an error."""
    return loaded.phase is LoadingPhase.READY and loaded.proof is not None and not loaded.proof.errors


def _make_caption(text: str, text_below: str = "") -> NoticeRow:
    """Return the row of the tour with this caption."""
    return NoticeRow(text, text_below, color_name="wait", is_caption=True)


def _is_disturbed(snapshot: Snapshot) -> bool:
    """Return whether something has stopped the cycle, such as a late screen, an alarm or the E-stop.

    The programs of the tour have no stops, so the caption would then be wrong.
    """
    return bool(snapshot.alarms) or snapshot.state in _DISTURBED_STATES


def _is_at_rest(snapshot: Snapshot) -> bool:
    """Return whether no program is active and the spindle has stopped."""
    is_spindle_stopped = not snapshot.rpm_command and abs(snapshot.rpm_actual) < STANDSTILL_RPM
    return snapshot.state not in MOVING_STATES | INTERRUPTED_STATES and is_spindle_stopped
