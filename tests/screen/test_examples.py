"""The worked examples, run on the screen by keys alone: they end where their proofs end, with no underrun."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import Offsets
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.main_window import MainWindow
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import load_source
from core.proving.proof_report import ProofReport
from core.proving.prove_program import prove
from drivers.wakeups import ManualClock
from tests.screen.hands import Key
from tests.worked import worked

EXAMPLES = (
    "linear-diameter",
    "linear-radius",
    "rapid-g00-g01",
    "arc-ik-diameter",
    "arc-ik-radius",
    "arc-r-diameter-barrel",
    "arc-r-radius-convex",
    "workshift-bar-loop",
    "workshift-dry-run",
    "secondary-taper",
    "secondary-three-bores",
    "loop-notches",
    "tapping",
)
OFFSETS = Offsets(
    {n: ToolOffset() for n in range(1, 9)},
    {n: SecondaryOffset(x=-0.0127 * n) for n in range(1, 5)},
    {},
)
TICK = 0.01
MOST = 120.0  # s of machine time


class Lathe:
    """The desk with its window, on a clock that the test moves; a frame is drawn every few ticks."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.desk, self._executor = create_desk_and_executor(None, lambda: OFFSETS, self.clock)
        self.desk.station_controls.clock = self.clock.now
        self.window = MainWindow(ScreenTheme(DARK_PALETTE))
        self.window.resize(1024, 600)
        self.window.show_model(self.desk)
        self.window.show()

    def until(self, *states: MachineState) -> None:
        end, ticks = self.clock.now() + MOST, 0
        while self.desk.read_snapshot().state not in states:
            assert self.clock.now() < end, self.desk.read_snapshot().state
            self._executor.run_tick()
            self.clock.sleep_until(self.clock.now() + TICK)
            ticks += 1
            if ticks % 20 == 0:
                QApplication.processEvents()

    def checks_start(self) -> None:
        """The first move is checked, and what is said of it was read."""
        self.window.refresh()
        assert self.desk.start_watch is not None
        self.desk.start_watch.worker.wait_for_results(60.0)
        for _ in range(50):
            self._executor.run_tick()
            self.clock.sleep_until(self.clock.now() + TICK)

    def key(self, *keys: Key) -> None:
        for key in keys:
            QTest.keyPress(self.window, key)
        self._executor.run_tick()
        for key in keys:
            QTest.keyRelease(self.window, key)

    def close(self) -> None:
        self.window.close_silently()
        self.desk.close()


@pytest.fixture
def lathe(qapp: object) -> Iterator[Lathe]:
    lathe = Lathe()
    yield lathe
    lathe.close()


def proved(path: Path) -> ProofReport:
    machine = load_machine(None)
    setup = create_power_up_setup(
        machine, tool_offsets=OFFSETS.tool_offsets, secondary_offsets=OFFSETS.secondary_offsets
    )
    return prove(load_source(path), setup, machine)


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_ends_on_screen_at_proved_end_position(lathe: Lathe, name: str) -> None:
    path = worked(name)
    proof = proved(path)
    assert proof.errors == ()
    lathe.desk.program_choice.load_by_name(str(path))
    lathe.desk.program_loader.wait_until_loaded(60.0)
    lathe.until(MachineState.DISABLED)
    lathe.key(Key.Key_D)
    lathe.until(MachineState.IDLE)
    lathe.checks_start()
    lathe.key(Key.Key_F11, Key.Key_F12)
    lathe.until(MachineState.RUN)
    lathe.until(MachineState.IDLE, MachineState.HOLD, MachineState.FAULT, MachineState.ESTOP)
    end = lathe.desk.read_snapshot()
    assert (end.state, end.alarms, end.underruns, end.parts) == (MachineState.IDLE, (), 0, 1)
    assert end.demand[:2] == pytest.approx(proof.machine_final_position[:2], abs=1e-6)
    assert end.last_cycle == pytest.approx(proof.program_times.cycle_time_s, rel=0.025)
