"""At the desk: a program with its subprogram file, G54 of the store, a hold while C turns alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_stored_offsets
from app.desk.desk import Desk
from app.desk.programs.program_loading import LoadingPhase
from app.desk.status.machine_status import make_machine_status
from app.desk.status.readouts import ReadoutKind
from app.editor.editor_model import EditorModel
from core.executor.executor import Executor
from core.executor.snapshot import MachineState, Snapshot
from core.language.diagnostics import Severity
from core.store.store_rows import OffsetKind
from drivers.wakeups import ManualClock

pytestmark = pytest.mark.long

MAIN = """\
N10 G54 G0 X40 Z2 C0
N20 S900 M3
N30 G1 Z-10 C=ACP(270) F600
N40 C=IC(720) F3000
FACET
N60 M30
"""
SUB = "N1 G0 C=DC(0)\nN2 M17\n"
TICK = 0.01


class Bench:
    """A desk on the modulo lathe, its time moved by hand."""

    def __init__(self, home: Path) -> None:
        (home / "programs").mkdir(parents=True)
        (home / "programs" / "part.mpf").write_text(MAIN)
        (home / "programs" / "facet.spf").write_text(SUB)
        self.clock: ManualClock = ManualClock()
        self.journal = Journal(home)
        made = create_desk_and_executor("sinumerik-modulo", read_stored_offsets, self.clock, self.journal)
        self.desk: Desk = made[0]
        self._executor: Executor = made[1]
        self.desk.station_controls.clock = self.clock.now

    def until(self, so: Callable[[Snapshot], bool]) -> Snapshot:
        for _ in range(20_000):
            if so(self.desk.read_snapshot()):
                return self.desk.read_snapshot()
            self._executor.run_tick()
            self.desk.update()
            self.clock.sleep_until(self.clock.now() + TICK)
        raise AssertionError(f"not so: {self.desk.read_snapshot()}")

    def wait(self, seconds: float) -> None:
        end = self.desk.read_snapshot().t + seconds
        self.until(lambda s: s.t > end)

    def started(self) -> None:
        assert self.desk.program_choice.load_by_name("part")
        loaded = self.desk.program_loader.wait_until_loaded(60.0)
        errors = [each for each in loaded.diagnostics if each.severity is Severity.ERROR]
        assert (loaded.phase, errors) == (LoadingPhase.READY, [])
        self.until(lambda s: s.state is MachineState.DISABLED)
        self.desk.enable_drives()
        self.until(lambda s: s.state is MachineState.IDLE and not s.needs_proof)
        first_move = self.desk.start_watch
        assert first_move is not None
        self.until(lambda _: first_move.first_move_result is not None)
        self.wait(0.5)  # what is announced was read
        self.desk.station_keys.press_start()
        self.until(lambda s: s.state is MachineState.RUN)

    def c(self) -> str:
        return (
            make_machine_status(self.desk.read_snapshot(), ReadoutKind.POSITION, has_c_axis=True)
            .position.axes[2]
            .value
        )

    def close(self) -> None:
        self.desk.close()
        self.journal.close()


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    bench = Bench(tmp_path / "home")
    yield bench
    bench.close()


def test_program_runs_to_end_and_c_is_shown_modulo_360(bench: Bench) -> None:
    bench.started()
    over = bench.until(lambda s: s.line == 4 and s.actual[2] > 500)
    assert 0.0 <= float(bench.c()) < 360.0
    view = make_machine_status(over, ReadoutKind.POSITION, has_c_axis=True)
    assert (view.feed.programmed_value, view.feed.programmed_unit) == ("3000.0", "°/min")
    end = bench.until(lambda s: s.state is MachineState.IDLE)
    assert (end.parts, end.alarms) == (1, ())
    assert bench.c() == "0.00"
    assert end.actual[2] == pytest.approx(1080.0, abs=0.01)


def test_program_resumes_after_hold_while_c_alone_turns(bench: Bench) -> None:
    bench.started()
    bench.until(lambda s: s.line == 4 and s.actual[2] > 400)
    bench.desk.start_feed_hold()
    held = bench.until(lambda s: s.state is MachineState.HOLD)
    assert 400 < held.actual[2] < 990
    still = bench.until(lambda s: s.t > held.t + 1.0)
    assert still.actual[2] == pytest.approx(held.actual[2], abs=0.05)
    bench.desk.station_keys.press_start()
    end = bench.until(lambda s: s.state is MachineState.IDLE)
    assert (end.parts, end.alarms) == (1, ())


def stands_behind(line: int, shot: Snapshot) -> bool:
    return shot.state is MachineState.SINGLE_BLOCK_STOP and shot.line == line


def test_single_block_stops_between_move_and_c_rotation(bench: Bench) -> None:
    bench.desk.toggle_switch("single_block")
    bench.started()
    for line in (1, 2, 3, 4):
        bench.until(partial(stands_behind, line))
        bench.wait(2.0)  # into a cut only with the spindle at speed
        bench.desk.station_keys.press_start()
    bench.until(lambda s: s.line == 5)


def test_c_offset_rotates_part(bench: Bench) -> None:
    bench.desk.offset_book.change_fields(OffsetKind.ZERO, 54, {"c": 30.0, "z": -5.0}, "turned")
    while not bench.desk.offset_book.zero_offsets:
        bench.desk.update()
    bench.started()
    turned = bench.until(lambda s: s.line == 5)
    assert make_machine_status(turned, ReadoutKind.POSITION, has_c_axis=True).tool_text == "G54"
    bench.until(lambda s: s.line == 5 and bench.c() == "0.00")
    end = bench.until(lambda s: s.state is MachineState.IDLE and s.parts == 1)
    assert end.actual[1] == pytest.approx(-15.0, abs=0.01)
    assert end.actual[2] % 360 == pytest.approx(30.0, abs=0.01)
    assert bench.c() == "30.00"  # the end has taken the offsets away
    assert end.modal.settable == 0


def test_missing_subprogram_is_reported_before_any_motion(bench: Bench, tmp_path: Path) -> None:
    (tmp_path / "home" / "programs" / "facet.spf").unlink()
    bench.desk.program_choice.load_by_name("part")
    loaded = bench.desk.program_loader.wait_until_loaded(60.0)
    assert loaded.phase is LoadingPhase.REFUSED
    assert [each.code for each in loaded.blocking_errors] == ["subprogram-missing"]


def shown(bench: Bench) -> str:
    return make_machine_status(
        bench.desk.read_snapshot(), ReadoutKind.POSITION, has_c_axis=True
    ).position.unit


def test_metric_lathe_displays_mm_before_during_and_after_a_program(bench: Bench) -> None:
    assert shown(bench) == "MM"
    bench.started()
    assert shown(bench) == "MM"
    bench.until(lambda s: s.state is MachineState.IDLE)
    assert shown(bench) == "MM"
    assert bench.desk.read_snapshot().modal.metric


def test_metric_lathe_displays_mm_after_inch_or_canceled_program(bench: Bench, tmp_path: Path) -> None:
    (tmp_path / "home" / "programs" / "part.mpf").write_text("G70 G0 X1 Z.1\nG1 Z-.4 F50\nM30\n")
    bench.started()
    bench.until(lambda s: s.line == 2)
    assert shown(bench) == "INCH"
    bench.desk.start_feed_hold()
    bench.until(lambda s: s.state is MachineState.HOLD)
    bench.desk.reset_control()
    bench.desk.prompt_line._since = float("-inf")  # the question has been read
    bench.desk.confirm_question_if_unchanged()
    bench.until(lambda s: s.state is MachineState.IDLE)
    assert shown(bench) == "MM"


def test_program_without_unit_runs_in_mm_with_a_warning(bench: Bench, tmp_path: Path) -> None:
    """What names no unit runs in the control's; the editor and the list prove it as it will run."""
    bench.until(lambda s: s.state is MachineState.DISABLED)
    path = tmp_path / "home" / "programs" / "plain.nc"
    path.write_text("G90G94F300\nX10Z-10\nM30\n")
    assert bench.desk.program_choice.load_by_name("plain")
    loaded = bench.desk.program_loader.wait_until_loaded(60.0)
    assert [d.code for d in loaded.diagnostics] == ["units-unnamed"]
    assert loaded.job is not None
    editor = bench.desk.page_registry.find_model(EditorModel)
    assert editor is not None
    proved = editor.loading_steps.make_job(loaded.job.source, False)
    assert proved.digest == loaded.job.digest
