"""Wear between two parts, on the lathe: the second part is cut by as much deeper as was entered."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.executor.snapshot import MachineState
from tests.screen.jog.bench import INCH, JogBench, Key
from tests.texts import begins, text

PROGRAM = "G90G94F300\nG72\nT1\nM03S1000\nX1Z.1\nG01F60X.5Z.1\nZ-.5\nX1Z.5G00\nM30\n"


def load(jog: JogBench, folder: Path, program: str = PROGRAM) -> None:
    path = folder / "part.nc"
    path.write_text(program, encoding="utf-8")
    assert jog.desk.program_choice.load_by_name(str(path))
    proved(jog)


def proved(jog: JogBench) -> None:
    jog.run(0.05)
    assert not jog.desk.program_loader.wait_until_loaded(30).blocking_errors
    jog.run(0.05)


def start(jog: JogBench) -> None:
    """Both palms, until something happens; the first move was checked before."""
    jog.run(0.5)
    if jog.desk.start_watch is not None:
        jog.desk.start_watch.worker.wait_for_results(60.0)
    jog.run(0.1)
    before = jog.shot.state
    jog.down(Key.Key_F11)
    jog.down(Key.Key_F12)
    jog.until(lambda: jog.shot.state is not before, 2.0)
    jog.up(Key.Key_F11)
    jog.up(Key.Key_F12)


def cut(jog: JogBench) -> float:
    """One part; the least machine X on the way, mm."""
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F2)
    start(jog)
    least = [0.0]

    def ended() -> bool:
        least.append(jog.shot.demand[0])
        return jog.shot.state is MachineState.IDLE

    jog.until(ended, 60.0)
    return min(least)


def test_wear_correction_between_parts_changes_next_part(jog: JogBench, tmp_path: Path) -> None:
    jog.store.offsets.tool_offsets.change_row(1, "touched off", {"x": -1.0 * INCH, "z": -2.0 * INCH}).result(
        60
    )
    jog.desk.offset_book.read_store()
    load(jog, tmp_path)
    first = cut(jog)
    assert first == pytest.approx((-1.0 + 0.25) * INCH, abs=1e-6)  # Ø .5 with the tip 1 in further in
    jog.key(Key.Key_F8)
    for _ in range(4):
        jog.key(Key.Key_Right)
    jog.type("-.002")  # the part is .002 too large on its diameter
    jog.key(Key.Key_F2)
    jog.saved()
    assert jog.prompt == text("screen.saved", names="T1")
    proved(jog)
    assert cut(jog) - first == pytest.approx(-0.001 * INCH, abs=1e-6)


def test_correction_at_program_stop_applies_to_next_repeat(jog: JogBench, tmp_path: Path) -> None:
    """Gauged at M00 with Cycle Repeat on: this part ends as it began, the next one has the new wear."""
    jog.store.offsets.tool_offsets.change_row(1, "touched off", {"x": -1.0 * INCH, "z": -2.0 * INCH}).result(
        60
    )
    jog.desk.offset_book.read_store()
    load(jog, tmp_path, PROGRAM.replace("M30", "M00\nX.6Z.5\nM30"))
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F2)
    jog.key(Key.Key_C)
    start(jog)
    jog.until(lambda: jog.shot.state is MachineState.PROGRAM_STOP, 60.0)
    jog.key(Key.Key_F8)
    jog.run(0.02)
    assert begins(jog.prompt, "screen.program-runs-wear-only")
    for _ in range(4):
        jog.key(Key.Key_Right)
    assert begins(jog.prompt, "jog.counts-from-next-part")
    jog.enter("-.002")
    jog.saved()
    jog.run(0.05)
    assert jog.prompt == text("jog.saved-for-next-part", saved=text("screen.saved", names="T1"))
    assert jog.shot.cycle_repeat
    jog.desk.renewal.running_renewal.worker.wait_for_results(60.0)
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F2)
    start(jog)
    jog.until(lambda: jog.shot.parts == 1, 60.0)
    jog.until(lambda: jog.shot.line == 7, 60.0)
    assert jog.shot.demand[0] == pytest.approx((-1.0 - 0.001 + 0.25) * INCH, abs=1e-6)
    job = jog.desk.program_loader.loaded_program.job
    assert job is not None
    assert job.setup.tools[1].x == pytest.approx((-1.0 - 0.001) * INCH)
    jog.key(Key.Key_C)
    jog.until(lambda: jog.shot.state is MachineState.PROGRAM_STOP, 60.0)
    start(jog)
    jog.until(lambda: jog.shot.state is MachineState.IDLE, 60.0)
    assert jog.shot.parts == 2


def test_f8_is_rejected_during_cycle(jog: JogBench, tmp_path: Path) -> None:
    jog.store.offsets.tool_offsets.change_row(1, "touched off", {"x": -1.0 * INCH, "z": -2.0 * INCH}).result(
        60
    )
    jog.desk.offset_book.read_store()
    load(jog, tmp_path)
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F2)
    start(jog)
    jog.key(Key.Key_F8)
    jog.enter("5")
    jog.run(0.02)
    assert jog.prompt == text("screen.program-runs-wear-only")
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == -1.0 * INCH
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F5)
    jog.down(Key.Key_Left)
    jog.run(0.1)
    assert jog.prompt == text("screen.program-runs-no-jog")
    jog.up(Key.Key_Left)
    jog.key(Key.Key_H)
    jog.until(lambda: jog.shot.state is MachineState.HOLD)
