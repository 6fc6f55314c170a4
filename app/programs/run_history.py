"""What each program does, from the snapshots: when it ran, how that ended, cycle times, proof."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.persistence import Persistence
from app.desk.programs.program_loading import Loaded, Phase
from app.desk.status import prompt_line
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.store import Store
from core.store.store_errors import StoreError

COMPLETE, UNCOUNTED, GIVEN_UP, ESTOP = "COMPLETE", "NOT COUNTED", "GIVEN UP", "E-STOP"
CUT_OFF = "CUT OFF"  # the control ended in its middle: found at the next start
_RUNNING = frozenset({State.RUN, State.HOLDING, State.WAIT}) | prompt_line.INTERRUPTED
_SETTLED = frozenset({Phase.READY, Phase.REFUSED})


@dataclass(slots=True)
class RunHistory:
    """Looks at every snapshot; posts what has happened to the store and never waits for it."""

    persistence: Persistence = field(default_factory=Persistence)
    running: str = ""  # the program under way
    _parts: int | None = None
    _ends: int = 0
    _timed: int = 0
    _lines: int = 0  # of MDI, when nothing was under way: a line is no run of the program on the desk
    _loaded: Loaded | None = None

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """One frame. Where the store does not take it the desk says so by itself (``Desk.not_kept``)."""
        try:
            self._run(snapshot)
            self._proof(loaded)
        except StoreError:
            self.running = ""

    def _run(self, snapshot: Snapshot) -> None:
        parts, self._parts = self._parts, snapshot.parts
        name = Path(snapshot.program).name
        if parts is not None and snapshot.parts > parts and name:
            if snapshot.timed > self._timed:
                self.persistence.cycle_finished(name, snapshot.last_cycle)
            if not self.running:
                self.persistence.run_started(name)
            self._end(name, COMPLETE)
        elif parts is not None and snapshot.ends > self._ends and self.running:
            self._end(name, UNCOUNTED)
        self._ends, self._timed = snapshot.ends, snapshot.timed
        if snapshot.state not in _RUNNING:
            self._lines = snapshot.lines
        under_way = snapshot.state in _RUNNING and snapshot.block > 0 and snapshot.lines == self._lines
        if under_way and not self.running and name:
            self.running = name
            self.persistence.run_started(name)
        elif self.running and snapshot.state not in _RUNNING:
            self._end(self.running, _outcome(snapshot))

    def _end(self, name: str, outcome: str) -> None:
        self.running = ""
        self.persistence.run_ended(name, outcome)

    def _proof(self, loaded: Loaded) -> None:
        if loaded is self._loaded:
            return
        self._loaded = loaded
        if loaded.phase not in _SETTLED or loaded.path is None or loaded.source is None:
            return
        errors, name, text = len(loaded.errors), loaded.path.name, loaded.source.text
        if loaded.phase is Phase.REFUSED:
            first = loaded.errors[0].message if errors else ""
            self.persistence.program_proved(
                name,
                Message("{errors_count} ERRORS: {errors}", errors_count=max(errors, 1), errors=first),
                None,
                text,
            )
        else:
            planned = loaded.proof.cycle_time if loaded.proof else None
            self.persistence.program_proved(name, "PROVED", planned, text)


def _outcome(snapshot: Snapshot) -> str:
    if snapshot.state is State.ESTOP:
        return ESTOP
    if snapshot.state is State.FAULT and snapshot.alarms:
        return Message("ALARM {number}", number=snapshot.alarms[-1].number)
    return GIVEN_UP


def note_cut_off_runs(store: Store) -> None:
    """At the start, when nothing runs yet: a run without an end is one that the control did not outlive."""
    told = store.runs_cut_off(CUT_OFF, "{program}: the control shut down during the last run of this program")
    with suppress(StoreError):  # a disk that is full gets it later
        told.result()
