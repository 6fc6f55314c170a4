"""Homing by the drives.

An axis homes on its switch. The spindle homes on its encoder index or at its current position.
"""

from __future__ import annotations

from enum import Enum

from core.message import Message
from core.ports import DriverError, Fault
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_objects import BIT_12, BIT_13, HALT, HM, NEW, REACHED, DriveState
from drivers.canopen.cia402_drives import Cia402Drive
from drivers.canopen.drive_set import DrivenAxis

_STALE_STATUS_S = 0.1  # Seconds in which "target reached" may still refer to the last move.
_MODE_CHANGE_S = 0.5  # Seconds for a change of mode.
_TIME_RESERVE_S = 10.0  # Seconds in addition to the travel time at homing speed.
_SETTLING_TIME_S = 0.05  # Seconds until the new count is reported, from which setpoints start.
_STANDSTILL_TIME_S = 0.1  # Seconds without a count before a halted drive is assumed to be at standstill.


class _Step(Enum):
    MODE = "waiting for the drive to change to homing mode"
    RUN = "searching for the home switch"
    SETTLE = "switch found; the position count is being reset"
    HALT = "homing canceled; the axis is braking"
    RESTORE_MODE = "waiting for the drive to return to the previous mode"
    DONE = "the drive has returned to the previous mode"


class CanopenHoming:
    """Homing of one axis by its drive.

    ``advance_homing`` must be called once per tick until ``is_done`` is true or ``failure`` is set.
    """

    def __init__(self, axis: DrivenAxis, previous_mode: int, now: float) -> None:
        self.axis = axis
        self.config = axis.config
        self._drive = axis.drive
        self._back = previous_mode
        self._step = _Step.MODE
        self._since = now
        self.failure: Fault | str = ""
        self._write_parameters()
        self._drive.commanded_mode = HM

    @property
    def is_done(self) -> bool:
        """Return whether the homing has ended and the drive has returned to its previous mode."""
        return self._step is _Step.DONE

    def advance_homing(self, now: float) -> None:
        """Evaluate the status word of the drive and execute the next step of the homing."""
        drive, waited = self._drive, now - self._since
        if self._step is _Step.MODE and drive.reported_mode == HM:
            drive.mode_bits |= NEW
            self._enter(_Step.RUN, now)
        elif self._step is _Step.RUN:
            self._look(now, waited)
        elif self._step is _Step.SETTLE and waited > _SETTLING_TIME_S:
            self._leave(now)
        elif self._step is _Step.HALT:
            self._brake(now, waited)
        elif self._step is _Step.RESTORE_MODE and drive.reported_mode == self._back:
            self._enter(_Step.DONE, now)
        elif self._step in {_Step.MODE, _Step.RESTORE_MODE} and waited > _MODE_CHANGE_S:
            self._fail("the drive stays in mode {shown_mode}", shown_mode=drive.reported_mode)

    def cancel_homing(self) -> None:
        """Cancel the homing, so that the drive brakes.

        The drive returns to its previous mode at standstill, because some drives reject a mode change
        during motion.
        """
        self._drive.mode_bits = self._drive.mode_bits & ~NEW | HALT
        self._step = _Step.HALT

    def _brake(self, now: float, waited: float) -> None:
        if (
            self.axis.is_moving or not self._braking
        ):  # The first check after the cancellation starts the wait.
            self._since, self._braking = now, True
        elif waited > _STANDSTILL_TIME_S:
            self._leave(now)

    def _leave(self, now: float) -> None:
        self._drive.mode_bits &= ~(NEW | HALT)
        self._drive.commanded_mode = self._back
        self._enter(_Step.RESTORE_MODE, now)

    def _look(self, now: float, waited: float) -> None:
        status = self._drive.status_word
        if status & BIT_13:
            self._fail("the drive reports a homing error; check switch, method and direction")
        elif waited > _STALE_STATUS_S and status & BIT_12 and status & REACHED:
            self._enter(_Step.SETTLE, now)
        elif waited > self._longest():
            self._fail("no home switch was found within the axis travel")

    def _longest(self) -> float:
        low, high = self.config.travel or (0.0, 360.0)
        return 2.0 * (high - low) / self.config.home_speed + _TIME_RESERVE_S

    def _enter(self, step: _Step, now: float) -> None:
        self._step, self._since = step, now

    def _fail(self, why: str, **values: object) -> None:
        why = Message(why, **values) if values else why
        self._drive.mode_bits &= ~NEW
        self.failure = Fault("{name}: homing failed: {why}", "homing", name=self.config.name, why=why)

    def _write_parameters(self) -> None:
        """Write the method, and the speeds, acceleration and home offset if the drive has these objects.

        Raises DriverError if the drive rejects a value or cannot count to the home offset, or if it needs a
        home offset but lacks the object.
        """
        config, setup = self.config, self._drive.setup
        slow = config.home_latch_speed or config.home_speed / 10.0
        setup.write(od.HOME_METHOD, 0, config.home_method)
        for index, sub, value in (
            (od.HOME_SPEEDS, 1, max(round(config.convert_to_drive_speed(config.home_speed)), 1)),
            (od.HOME_SPEEDS, 2, max(round(config.convert_to_drive_speed(slow)), 1)),
            (od.HOME_ACCEL, 0, config.convert_to_drive_acceleration(config.amax)),
        ):
            setup.write_optional_object(index, sub, value)
        place = config.convert_position(config.home_offset)
        if not setup.write_optional_object(config.profile.home_offset_object, 0, place) and place:
            raise DriverError(
                "{name}: the drive has no object {home_place}h (home offset), so "
                "axis.{name2}.home.offset must be 0",
                "homing",
                name=config.name,
                home_place=f"{config.profile.home_offset_object:04X}",
                name2=config.name,
            )

    _braking = False


# --- Position of the spindle drive: homed on the index or in place, and tracked while it turns.


_POWERED_MODE_CHANGE_S = 2.0  # Seconds for a change of mode with power.
_INDEX_SEARCH_S = 15.0  # Seconds to find the index.
_STALE_REFERENCE_S = 0.1  # Seconds in which "target reached" may still refer to the last move.
_PRESENT_POSITION_METHODS = (37, 35)  # Homing methods for the present position: the new code and the old one.
_INDEX_METHOD = 34  # Homing method: index, turning forward.
INDEX_SEARCH_RPM = 60


class SpindleHoming:
    """Homing of the spindle drive, which the caller starts and then polls with ``is_done``."""

    def __init__(self, drive: Cia402Drive) -> None:
        self._drive = drive
        self._limit = 0.0
        self._why = ""
        self._since = 0.0
        self._told = False  # The drive has received the start command.

    def start_index_search(self, now: float) -> None:
        """Start the search for the encoder index.

        Raises DriverError if the drive rejects the homing method, the homing speeds or the home offset, or
        does not respond.
        """
        self._limit, self._why = _INDEX_SEARCH_S, "no encoder index was found within one revolution"
        self._drive.setup.write(od.HOME_METHOD, 0, _INDEX_METHOD)
        self._begin(0, now)

    def start_position_setting(self, counts: int, now: float) -> None:
        """Start a homing without motion that sets the current position to ``counts``.

        Raises DriverError if the drive rejects both homing methods for the present position (37 and 35),
        the homing speeds or the home offset, or does not respond.
        """
        self._limit, self._why = _POWERED_MODE_CHANGE_S, "the drive does not accept its new position"
        try:
            self._drive.setup.write(od.HOME_METHOD, 0, _PRESENT_POSITION_METHODS[0])
        except DriverError:
            self._drive.setup.write(od.HOME_METHOD, 0, _PRESENT_POSITION_METHODS[1])
        self._begin(counts, now)

    def is_done(self, now: float) -> bool:
        """Return whether the homing is complete.

        Raises DriverError if the homing has failed.
        """
        drive, waited = self._drive, now - self._since
        if not self._told:
            if drive.is_enabled and drive.reported_mode == HM:
                drive.mode_bits, self._told, self._since = NEW, True, now
            elif waited > _POWERED_MODE_CHANGE_S:
                raise DriverError(
                    "C: the spindle drive remains in state {state}, mode {shown_mode}",
                    "c-coupling",
                    state=drive.reported_state,
                    shown_mode=drive.reported_mode,
                )
            return False
        if drive.status_word & BIT_13 or waited > self._limit:
            raise DriverError(f"C: {self._why}", "c-coupling")
        done = waited > _STALE_REFERENCE_S and bool(
            drive.status_word & BIT_12 and drive.status_word & REACHED
        )
        if done:
            drive.mode_bits = 0
        return done

    def _begin(self, place: int, now: float) -> None:
        write, drive = self._drive.setup.write, self._drive
        write(od.HOME_SPEEDS, 1, INDEX_SEARCH_RPM)
        write(od.HOME_SPEEDS, 2, INDEX_SEARCH_RPM // 10)
        write(od.HOME_OFFSET, 0, place)
        drive.commanded_mode, drive.goal_state, drive.mode_bits, drive.target_value = (
            HM,
            DriveState.OPERATION_ENABLED,
            0,
            0,
        )
        self._told, self._since = False, now


class IndexPhase:
    """Position of the spindle within one revolution, in counts from the index.

    ``counts`` is None until the index is found.
    """

    def __init__(self, counts_per_rev: int) -> None:
        self._per_turn = counts_per_rev
        self._last = 0
        self.counts: int | None = None

    def set_index_position(self, position: int) -> None:
        """Set the phase from a drive position that is counted from the index."""
        self.counts, self._last = position % self._per_turn, position

    def track_position(self, position: int, *, ignore_jumps: bool) -> None:
        """Track the drive position; call this method once per cycle.

        With ``ignore_jumps``, a change of the position does not count as rotation, because homing sets the
        counter while the spindle does not turn.
        """
        moved = (position - self._last + 2**31) % 2**32 - 2**31
        self._last = position
        if self.counts is not None and not ignore_jumps:
            self.counts = (self.counts + moved) % self._per_turn
