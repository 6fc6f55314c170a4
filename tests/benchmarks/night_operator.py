"""Who works the lathe through the night: starts, holds, measures, mends, by keys of the desk and palms.

Chance is that of a seed, so a night that goes wrong goes wrong again.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from app.desk.programs.program_loading import LoadingPhase
from app.screen.page_table import ALL_PAGES, import_class
from app.special.counter_functions import ToolLifeFunction
from app.special.special_functions import SpecialFunction, SpecialFunctionsModel
from core.executor.commands import ForceOutput
from core.executor.snapshot import MachineState
from core.store.production import measured_parts, tool_lives
from core.store.production.measured_parts import FeatureRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.store_rows import OffsetKind
from tests.benchmarks.night_shift import FRAME, INCH, NAME, PATIENCE, TICK, TOOLS, NightShift

PINS, INSERT = 40, 1500  # pins of a bar, parts of an insert
WEARS = 1.5e-6 * INCH  # mm by which each pin makes the next one's diameter larger
SCATTER = 2e-5 * INCH  # mm, of a reading
EVERY, SAMPLE = 25, 3  # parts between two readings; readings behind which a correction is asked for
STUCK = 300.0  # s of the machine in which somebody who does what he can must get a part
LONGEST = 6.0  # s of a part, and somewhat more
LOOKS = 15.0  # s after which the operator mends what he finds
COLLET_OPEN = "opened the collet"  # the spindle was stopped while the feeder pushed: it does not start there
FEATURE = FeatureRow(0, NAME, "PIN", "diameter", 0.4 * INCH, -0.001 * INCH, 0.001 * INCH, "tool", 1, 1, 0, 1)
CHANCES = {  # of a thousand parts so many meet it
    "hold": 20, "single block": 8, "feed pot": 25, "spindle pot": 10, "no count": 5, "give up": 5,
    "E-stop": 4, "drive trips": 3, "slide jams": 3, "inverter trips": 3, "spindle bogs": 3,
    "station silent": 3, "collet switch": 3, "pot noise": 3, "slide is pushed": 2, "spindle switch": 3,
}  # fmt: skip


class StuckError(AssertionError):
    """Nothing that an operator may do gets the machine to make a part."""


class Operator:
    """``make(parts)``: until so many more are counted."""

    def __init__(self, shift: NightShift, seed: int, chances: Mapping[str, float] = CHANCES) -> None:
        self.shift, self.desk, self.lathe = shift, shift.desk, shift.lathe
        self.chance, self._chances = random.Random(seed), chances
        self.did: Counter[str] = Counter()
        self._worn = 0.0  # mm of diameter
        self._pins = 0  # of this bar
        self._ends = -1
        self._since = 0.0  # when the last program came to its end
        self._plan: tuple[float, str] | None = None
        self._mends: list[Callable[[], object]] = []
        self._mend_at = 0.0
        self._readings = 0  # since the last correction
        self._steps = 0  # blocks that are still to be stepped through
        self._gives_up = False

    # --- the evening ----------------------------------------------------------------------------------------

    def begin(self) -> None:
        """Tools, the feature that is measured, the life of an insert, drives, program."""
        store = self.shift.store
        for number, (x, z) in TOOLS.items():
            store.offsets.tool_offsets.change_row(
                number, "touched off", {"x": x * INCH, "z": z * INCH}
            ).result(PATIENCE)
        store.write(lambda c: measured_parts.save_feature(c, FEATURE)).result(PATIENCE)
        life = ToolLifeRow(1, limit_parts=INSERT, stops=True)
        store.write(lambda c: tool_lives.save_tool_life_limits(c, life)).result(PATIENCE)
        self.desk.offset_book.read_store()
        self.desk.enable_drives()
        self.shift.run(0.3)
        if not self.desk.program_choice.load_by_name(NAME):
            raise FileNotFoundError(NAME)
        self._loaded()

    def make(self, parts: int) -> None:
        """Until so many more are counted. Raises StuckError when none comes for long."""
        end = self.shift.shot.parts + parts
        while self.shift.shot.parts < end:
            self.step()
            if self.shift.clock.now() - self._since > STUCK:
                raise StuckError(f"no part for {STUCK:g} s: {self.desk.prompt_notice!r} {self.shift.shot}")

    def meets(self, what: str, after: float = 0.5) -> None:
        """One of ``CHANCES``, so many seconds of the machine from now, instead of what chance had in mind."""
        self._plan = self.shift.clock.now() + after, what

    def finish(self) -> None:
        """Cycle Repeat off, and the part under way is made."""
        if self.shift.shot.cycle_repeat:
            self.desk.toggle_switch("cycle_repeat")
        self._plan = None
        while self.shift.shot.state is not MachineState.IDLE:
            self.step()
        self.shift.saved()

    # --- what he sees, and what he does about it ------------------------------------------------------------

    def step(self) -> None:
        """What he does about the machine of now, and a tick of it."""
        shot = self.shift.shot
        if shot.ends != self._ends:
            self._part_made()
        if self._mends and self.shift.clock.now() > self._mend_at:
            self._mend()
        acts = {
            MachineState.ESTOP: self._twist_out,
            MachineState.FAULT: self._acknowledge,
            MachineState.DISABLED: self._enable,
            MachineState.IDLE: self._start,
            MachineState.PROGRAM_STOP: self._new_bar,
            MachineState.HOLD: self._go_on,
            MachineState.SINGLE_BLOCK_STOP: self._go_on,
        }
        act = acts.get(shot.state)
        if act is not None:
            act()
        elif self._plan is not None and self.shift.clock.now() >= self._plan[0]:
            name, self._plan = self._plan[1], None
            self.did[name] += 1
            getattr(self, "_" + name.lower().replace(" ", "_").replace("-", "_"))()
        self.shift.tick()

    def _part_made(self) -> None:
        """Another pin is in the catcher: sometimes it is measured, sometimes the next one meets something."""
        shift = self.shift
        self._ends, self._since = shift.shot.ends, shift.clock.now()
        self._worn += WEARS
        self._pins += 1
        if self._pins >= PINS:
            self._bar_ends(ended=True)
        if shift.shot.no_count and shift.shot.ends:
            self.desk.toggle_switch("no_count")
        if shift.shot.parts and shift.shot.parts % EVERY == 0:
            self._measure()
        dice = self.chance.random() * 1000.0
        for name, share in self._chances.items():
            dice -= share
            if dice < 0.0:
                self._plan = shift.clock.now() + self.chance.uniform(0.1, LONGEST), name
                break

    def _palms(self) -> None:
        hands = self.desk.station_controls
        for down, pause in ((True, 0.1), (False, 0.4)):
            for side in ("left", "right"):
                hands.palm(side, is_down=down)
            self.shift.run(pause)

    def _start(self) -> None:
        """Both palms, when the program is ready and what stands in the way was done."""
        desk, shot = self.desk, self.shift.shot
        self._loaded()
        told = "LIFE" in desk.prompt_notice and "FRESH INSERT" not in desk.prompt_notice
        if shot.next_barred or told or "life of T1" in shot.start_refusal_reason:
            self.fresh_insert()
        if not shot.cycle_repeat:
            desk.toggle_switch("cycle_repeat")
        if shot.interrupted is not None:
            desk.clear_prompt_line()
            desk.confirm_question()
        self._first_move_is_checked()
        self.shift.run(0.9)  # what it warns of is read
        self.shift.witness.anew()
        self.did["start"] += 1
        self._palms()

    def _go_on(self) -> None:
        if self._gives_up or COLLET_OPEN in self.shift.shot.start_refusal_reason:
            self._gives_up = False
            self.desk.reset_control()
            self.shift.run(0.6)
            self.desk.confirm_question_if_unchanged()
            return
        if self._steps:
            self._steps -= 1
        elif self.shift.shot.single_block:
            self.desk.toggle_switch("single_block")
        self.shift.run(0.9)
        self._palms()

    def _new_bar(self) -> None:
        self.did["bar"] += 1
        self._pins = 0
        self._bar_ends(ended=False)
        self.shift.run(1.0)
        self._palms()

    def _bar_ends(self, *, ended: bool) -> None:
        assert self.desk.desk_control.set_input is not None
        self.desk.desk_control.set_input("TB2-9", ended)

    def _acknowledge(self) -> None:
        self._mend()
        self.shift.run(0.5)
        self.desk.reset_control()
        self.shift.run(0.5)
        if "collet" not in self.shift.shot.outputs:
            self.desk.post(ForceOutput("collet", True))
            self.shift.run(0.5)

    def _enable(self) -> None:
        self.shift.run(0.2)
        self.desk.enable_drives()
        self.shift.run(0.3)

    def _twist_out(self) -> None:
        self.shift.run(1.0)
        self.desk.station_controls.estop(is_pressed=False)
        self.shift.run(0.3)

    def _loaded(self) -> None:
        """The program on the desk is proved and drawn, and nothing of it is on its way."""
        desk = self.desk

        def ready() -> bool:
            waits = (
                desk.renewal.is_requested or desk.offset_book.is_saving or desk.program_loader.worker.is_busy
            )
            return (
                desk.program_loader.loaded_program.phase in {LoadingPhase.READY, LoadingPhase.REFUSED}
                and not waits
            )

        self.shift.settle(ready)

    def _first_move_is_checked(self) -> None:
        """Wait for the worker: a start that comes before its verdict is refused."""
        watch = self.desk.start_watch
        assert watch is not None
        self.shift.run(FRAME * TICK)
        self.shift.settle(lambda: not watch.is_checking)

    # --- measuring ------------------------------------------------------------------------------------------

    def _sections(self) -> Sequence[SpecialFunction]:
        """The sections of the page of measured parts; none where that feature is not installed."""
        entry = next((page for page in ALL_PAGES if page.name == "MEASURED PARTS"), None)
        found = (
            self.desk.page_registry.find_model(import_class(entry.model_class)) if entry is not None else None
        )
        return found.functions if isinstance(found, SpecialFunctionsModel) else ()

    def _measure(self) -> None:
        """Type what the gauge shows; behind a few readings ask for the correction and take it."""
        readings: Any = next((each for each in self._sections() if each.name == "READINGS"), None)
        if readings is None:
            return
        self._kept()
        size = 2.0 * self.shift.witness.radius + self._worn + self.chance.gauss(0.0, SCATTER)
        readings.accept_entry(f"{size / INCH:.5f}")
        self._kept()
        self.did["reading"] += 1
        self._readings += 1
        if self._readings >= SAMPLE:
            self._correct(readings)

    def _correct(self, readings: Any) -> None:
        changes = self.desk.offset_book.changes
        for _ in range(20):
            readings.propose()
            if not self.desk.confirmation_key:
                return  # within the dead band
            self.shift.run(0.6)  # he reads what is asked
            self.desk.confirm_question_if_unchanged()
            if self.desk.offset_book.is_saving or self.desk.offset_book.changes != changes:
                break
        self._kept()
        if self.desk.offset_book.changes != changes:
            self.did["correction"] += 1
            self._readings = 0

    def _kept(self) -> None:
        """What was typed is on the disk and read back, and the program proved with it."""
        desk, book = self.desk, self.shift.parts_book
        worker = desk.renewal.running_renewal.worker
        self.shift.settle(
            lambda: book.is_up_to_date and not desk.offset_book.is_saving and not worker.is_busy
        )

    def fresh_insert(self) -> None:
        """The insert has made its parts: a new one, and its wear is nought again."""
        functions = self.desk.page_registry.find_model(SpecialFunctionsModel)
        assert functions is not None
        lives = next(
            each for each in (*self._sections(), *functions.functions) if isinstance(each, ToolLifeFunction)
        )
        lives.marked = 0  # T1
        self._kept()  # right behind the start its life may not be read yet
        self.shift.settle(
            lambda: 1 in self.shift.parts_book.current_data.tool_lives
        )  # its worker may be late
        made = self.shift.parts_book.current_data.tool_lives[1].parts
        for _ in range(20):  # another answer may have taken the place of the question
            lives.confirm_new_insert()
            self.shift.run(0.6)
            self.desk.confirm_question_if_unchanged()
            self._kept()
            if self.shift.parts_book.current_data.tool_lives[1].parts < made:
                break
        else:
            raise StuckError(f"the insert cannot be changed: {self.desk.prompt_notice!r}")
        why = self.desk.offset_book.change_fields(OffsetKind.TOOL, 1, {"wear_x": 0.0}, "fresh insert")
        assert not why, why
        self._kept()
        self._loaded()
        self._worn, self._readings = 0.0, 0
        self.did["insert"] += 1

    # --- what happens in a night ----------------------------------------------------------------------------

    def _later(self, mend: Callable[[], object]) -> None:
        self._mends.append(mend)
        self._mend_at = self.shift.clock.now() + self.chance.uniform(0.2, LOOKS)

    def _mend(self) -> None:
        mends, self._mends = self._mends, []
        for mend in mends:
            mend()

    def _hold(self) -> None:
        self.desk.station_controls.hold(is_down=True)
        self.shift.run(0.2)
        self.desk.station_controls.hold(is_down=False)

    def _single_block(self) -> None:
        if not self.shift.shot.single_block:
            self.desk.toggle_switch("single_block")
        self._steps = self.chance.randint(1, 12)

    def _feed_pot(self) -> None:
        self.desk.station_controls.feed_pot.set(self.chance.choice((0.0, 0.1, 0.5, 0.8, 1.2, 1.5)))
        self._later(lambda: self.desk.station_controls.feed_pot.set(1.0))

    def _spindle_pot(self) -> None:
        self.desk.station_controls.spindle_pot.set(self.chance.choice((0.6, 0.8, 0.9)))
        self._later(lambda: self.desk.station_controls.spindle_pot.set(1.0))

    def _no_count(self) -> None:
        if not self.shift.shot.no_count:
            self.desk.toggle_switch("no_count")

    def _give_up(self) -> None:
        self._gives_up = True
        self.desk.start_feed_hold()

    def _e_stop(self) -> None:
        self.desk.station_controls.estop(is_pressed=True)

    def _drive_trips(self) -> None:
        self.lathe.drive_fault(self._slide())

    def _slide_jams(self) -> None:
        axis = self._slide()
        self.lathe.jam(axis, True)
        self._later(lambda: self.lathe.jam(axis, False))

    def _inverter_trips(self) -> None:
        self.lathe.spindle_fault("overvoltage")
        self._later(lambda: self.lathe.spindle_fault(""))

    def _spindle_bogs(self) -> None:
        self.lathe.spindle_bog(0.5)
        self._later(lambda: self.lathe.spindle_bog(1.0))

    def _station_silent(self) -> None:
        self.lathe.station_silent(True)
        self._later(lambda: self.lathe.station_silent(False))

    def _collet_switch(self) -> None:
        self.lathe.collet_sensor_stuck(True)
        self._later(lambda: self.lathe.collet_sensor_stuck(False))

    def _pot_noise(self) -> None:
        self.lathe.pot_noise(0.05)
        self._later(lambda: self.lathe.pot_noise(0.0))

    def _slide_is_pushed(self) -> None:
        self.lathe.push(self._slide(), self.chance.choice((-0.05, 0.05)))

    def _spindle_switch(self) -> None:
        self.desk.station_controls.set_spindle_auto(False)
        self._later(lambda: self.desk.station_controls.set_spindle_auto(True))

    def _slide(self) -> str:
        return self.chance.choice(("X", "Z"))
