"""A night at the lathe on a clock that is moved: pins from bars, seen by a witness beside all counters.

Desk, executor, simulated lathe and store are the product's. What was made is counted by looking where the
slides are: a pin is a pin when the parting tool has been past the middle of the bar.
"""

from __future__ import annotations

import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.error_log import ErrorLog
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_stored_offsets
from app.desk.data_folder import RECORDS_FOLDER_NAME, find_data_folder
from app.desk.desk import Desk
from app.desk.status.state_prompt import make_page_prompt
from app.production.parts_book import ProductionRecords
from app.production.parts_watch import ProductionMonitor
from app.programs.atomic_files import write_program_file
from core.executor.executor import Executor
from core.executor.scope_recorder import ScopeRecorder
from core.executor.snapshot import Alarm, MachineState, Snapshot
from core.store.store import Store
from drivers.simulators.plant_controls import PlantControls
from drivers.wakeups import ManualClock

INCH = 25.4
NAME = "night.nc"
PROGRAM = """\
G90G94F300G72(PINS OF A NIGHT)
T4(BAR STOP)
X0Z.2
M03S600
Z-.1F200
M13(THE FEEDER PUSHES)
Z.02F100
M12
F300Z.15
T1(TURNING TOOL)
X.46Z.05
M08
G95F.05Z0
X.3
G94F300Z.05
X.4
G95F.05Z-.1
X.46
G94F300Z.1
T3(PARTING TOOL SET ON ITS LEFT EDGE)
M25
X.5Z.05
Z-.15
G95F.05X-.03
G94F300X.5
Z.1
M26
M09
M05
M95
M30
}1
M31
M00(END OF BAR)
M99
"""
PUSHING, TURNING, PARTING = 6, 17, 24  # source lines
TOOLS = {1: (-0.5, -3.0), 3: (-1.0, -3.2), 4: (0.5, -2.8)}  # inches from home
RADIUS = 0.2  # inch, of the pin as it is programmed
TICK, FRAME, DRAIN = 0.02, 5, 50  # s; ticks between two looks of the desk, and of the scope's recorder
PATIENCE = 60.0  # s of this computer for a worker


@dataclass
class Truth:
    """What was seen of the slides, whatever anybody has counted. Lengths mm."""

    pins: int = 0  # parted off
    given_up: int = 0  # of them those whose program did not come to its end
    uncounted: int = 0  # of them those that were made with NO COUNT
    at_stop: Counter[tuple[float, ...]] = field(default_factory=Counter)  # ticks by setpoint, feeder pushing
    turned: dict[float, set[float]] = field(default_factory=lambda: defaultdict(set))  # X by T1's X offset
    lag: float = 0.0  # slide against setpoint where the feeder has pushed, the worst
    alarms: Counter[str] = field(default_factory=Counter)


class Witness:
    """Looks at every snapshot of the executor, and sees what the slides have made."""

    def __init__(self) -> None:
        self.truth = Truth()
        self.radius = 0.0  # mm, of the pin that was turned last, by the slide
        self._behind = False  # the parting tool is past the middle
        self._pins = 0  # of the program under way
        self._alarms: tuple[Alarm, ...] = ()
        self._ends = self._parts = 0

    def look(
        self, shot: Snapshot, offsets: Mapping[str, float], where: Callable[[], tuple[float, ...]]
    ) -> None:
        """``offsets``: X of T1 by job; ``where`` the slides really are."""
        if shot.line == PARTING:
            self._parting(shot.actual[0] - TOOLS[3][0] * INCH)
        elif shot.line == TURNING and shot.state is MachineState.RUN and shot.job in offsets:
            self._turning(shot, offsets[shot.job])
        elif shot.line == PUSHING and shot.state is MachineState.WAIT:
            self._at_stop(shot, where())
        if shot.alarms != self._alarms:
            self.truth.alarms.update(each.code for each in shot.alarms if each not in self._alarms)
            self._alarms = shot.alarms
        if shot.ends != self._ends:
            self._ended(shot)

    def _turning(self, shot: Snapshot, offset: float) -> None:
        if abs(shot.block_end[0] - shot.demand[0]) < 1e-6:  # the slide goes along Z alone
            self.truth.turned[offset].add(shot.demand[0])
            self.radius = shot.demand[0] - TOOLS[1][0] * INCH

    def _parting(self, x: float) -> None:
        if x < 0.0 and not self._behind:
            self.truth.pins += 1
            self._pins += 1
        self._behind = x < 0.0

    def _at_stop(self, shot: Snapshot, where: tuple[float, ...]) -> None:
        self.truth.at_stop[shot.demand] += 1
        off = [abs(a - b) for a, b in zip(where[:2], shot.demand[:2], strict=True)]
        self.truth.lag = max(self.truth.lag, *off)

    def _ended(self, shot: Snapshot) -> None:
        """A program came to its end; what it has parted off is counted, or was not to be."""
        if shot.parts == self._parts:
            self.truth.uncounted += self._pins
        self._ends, self._parts, self._pins = shot.ends, shot.parts, 0
        self._behind = False

    def anew(self) -> None:
        """The program begins at its first line; what it has parted off before counts for nobody."""
        self.truth.given_up += self._pins
        self._pins, self._behind = 0, False


class NightShift:
    """The lathe, its desk and its store; all of it goes on by ``tick``."""

    def __init__(self, desk: Desk, executor: Executor, clock: ManualClock, journal: Journal) -> None:
        self.desk, self.executor, self.clock, self.journal = desk, executor, clock, journal
        assert isinstance(desk.desk_control.station_panel, PlantControls)
        self.lathe = desk.desk_control.station_panel
        self.witness = Witness()
        self._ticks = 0
        self._offsets: dict[str, float] = {}  # X of T1 by job

    # --- time -----------------------------------------------------------------------------------------------

    @property
    def shot(self) -> Snapshot:
        """The machine of now."""
        return self.executor.snapshot

    @property
    def store(self) -> Store:
        """What the lathe remembers."""
        assert self.desk.offset_book.store is not None
        return self.desk.offset_book.store

    @property
    def parts_book(self) -> ProductionRecords:
        """Measured parts and lives."""
        watch = self.desk.page_registry.find_model(ProductionMonitor)
        assert watch is not None
        return watch.production_records

    def tick(self) -> None:
        """One tick of the executor, and every so often a frame of the desk."""
        self.clock.advance(TICK)
        self.executor.run_tick()
        self.witness.look(self.shot, self._jobs(), self.lathe.get_true_positions)
        self._ticks += 1
        if self._ticks % FRAME == 0:
            self.frame()
        if self._ticks % DRAIN == 0 and isinstance(self.desk.desk_control.recordings, ScopeRecorder):
            self.desk.desk_control.recordings.store_queued_ticks()

    def frame(self) -> None:
        """What the window asks for in a frame, without its drawing."""
        shot, _view, loaded = self.desk.update()
        make_page_prompt(self.desk, shot, loaded)

    def run(self, seconds: float) -> None:
        """So much time of the machine."""
        for _ in range(max(1, round(seconds / TICK))):
            self.tick()

    def settle(self, true: Callable[[], bool]) -> None:
        """Workers and the disk take this computer's time; the machine's stands still meanwhile."""
        end = time.monotonic() + PATIENCE
        while not true():
            if time.monotonic() > end:
                raise TimeoutError(f"a worker does not come back: {self.desk.prompt_notice or self.shot}")
            time.sleep(0.001)
            self.frame()

    def saved(self) -> None:
        """All that was posted is on the disk, and the desk has seen the machine as it is now."""
        self.store.write(lambda _connection: None).result(PATIENCE)
        self.frame()

    def _jobs(self) -> dict[str, float]:
        """X of T1 of the job on the desk, by its digest; the last few that were."""
        job = self.desk.program_loader.loaded_program.job
        if job is not None and job.digest not in self._offsets:
            self._offsets = dict([*self._offsets.items()][-3:])
            self._offsets[job.digest] = job.setup.tools[1].x
        return self._offsets


@contextmanager
def night_shift() -> Iterator[NightShift]:
    """The lathe in the product's folder, tools in its store and the program in its folder; put away after."""
    write_program_file(find_data_folder() / "programs" / NAME, PROGRAM.encode())
    clock, journal, log = ManualClock(), Journal.open_default(), ErrorLog()
    desk, executor = create_desk_and_executor(
        None, read_stored_offsets, clock, journal, find_data_folder() / RECORDS_FOLDER_NAME
    )
    desk.station_controls.clock = clock.now
    try:
        yield NightShift(desk, executor, clock, journal)
    finally:
        executor.shut_down()
        if isinstance(desk.desk_control.recordings, ScopeRecorder):
            desk.desk_control.recordings.close()
        desk.close()
        journal.close()
        log.close()
