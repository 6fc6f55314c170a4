"""Where the spindle's drive is: homed on its index or where it stands, followed through all its turning."""

from __future__ import annotations

from core.ports import DriverError
from drivers.canopen import objects as od
from drivers.canopen.drive import Drive402
from drivers.canopen.states import BIT_12, BIT_13, HM, NEW, REACHED, DriveState

_CHANGE = 2.0  # s for a change of mode with power
_SEARCH = 15.0  # s for the index
_FIRST = 0.1  # s in which "target reached" may still be that of the last move
_HERE = (37, 35)  # homing methods "where it stands", the new code and the old one
_INDEX = 34  # homing method: the index, turning forward
SEARCH_RPM = 60


class Referencing:
    """One homing of the drive: begun, then asked in every round whether it is done."""

    def __init__(self, drive: Drive402) -> None:
        self._drive = drive
        self._limit = 0.0
        self._why = ""
        self._since = 0.0
        self._told = False  # the drive was told to begin

    def index(self, now: float) -> None:
        """Look for the index. Raises DriverError."""
        self._limit, self._why = _SEARCH, "no index was found within a turn"
        self._drive.setup.write(od.HOME_METHOD, 0, _INDEX)
        self._begin(0, now)

    def here(self, place: int, now: float) -> None:
        """It counts ``place`` where it stands. Raises DriverError."""
        self._limit, self._why = _CHANGE, "it does not take its position"
        try:
            self._drive.setup.write(od.HOME_METHOD, 0, _HERE[0])
        except DriverError:
            self._drive.setup.write(od.HOME_METHOD, 0, _HERE[1])
        self._begin(place, now)

    def done(self, now: float) -> bool:
        """Whether it is over. Raises DriverError where it has failed."""
        drive, waited = self._drive, now - self._since
        if not self._told:
            if drive.enabled and drive.shown_mode == HM:
                drive.extra, self._told, self._since = NEW, True, now
            elif waited > _CHANGE:
                raise DriverError(
                    f"C: the spindle's drive is {drive.state} in mode {drive.shown_mode}", "c-coupling"
                )
            return False
        if drive.status & BIT_13 or waited > self._limit:
            raise DriverError(f"C: {self._why}", "c-coupling")
        done = waited > _FIRST and bool(drive.status & BIT_12 and drive.status & REACHED)
        if done:
            drive.extra = 0
        return done

    def _begin(self, place: int, now: float) -> None:
        write, drive = self._drive.setup.write, self._drive
        write(od.HOME_SPEEDS, 1, SEARCH_RPM)
        write(od.HOME_SPEEDS, 2, SEARCH_RPM // 10)
        write(od.HOME_OFFSET, 0, place)
        drive.mode, drive.goal, drive.extra, drive.target = HM, DriveState.ENABLED, 0, 0
        self._told, self._since = False, now


class Phase:
    """Counts from the index within a turn; ``counts`` None: it was never looked for."""

    def __init__(self, per_turn: int) -> None:
        self._per_turn = per_turn
        self._last = 0
        self.counts: int | None = None

    def found(self, position: int) -> None:
        """The drive counts from its index now."""
        self.counts, self._last = position % self._per_turn, position

    def follow(self, position: int, *, leaps: bool) -> None:
        """Once a round. ``leaps``: the counter is being set, and the spindle does not turn."""
        moved = (position - self._last + 2**31) % 2**32 - 2**31
        self._last = position
        if self.counts is not None and not leaps:
            self.counts = (self.counts + moved) % self._per_turn
