"""What a change of offsets does to the path, worked out by hand on a program of four moves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import create_path_drawer
from app.desk.background_work import ProgressCallback
from app.offsets.offset_effect import ComparedPaths, OffsetEffectWorker, OffsetTables
from app.path.path_picture import ProgramPicture
from core.executor.job import Job, make_job
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource

INCH = 25.4
LIMIT = 60.0
PROGRAM = (
    "G90G94F300\nM03S1000\nT1\nX.5Z.1\nG01F5Z-1\nX.6Z-1D1\nZ-1.2\nX1Z1G00D0\nT2\nX.3Z.1\nG01F5Z-.5\nM30\n"
)
TOOLS = {1: ToolOffset(-1.0, -50.0), 2: ToolOffset(2.0, -40.0)}
LATHE = load_machine()


def job() -> Job:
    setup = create_power_up_setup(LATHE, tool_offsets=TOOLS, secondary_offsets={})
    return make_job(ProgramSource("part.nc", PROGRAM), setup)


@pytest.fixture
def effect() -> Iterator[OffsetEffectWorker]:
    effect = OffsetEffectWorker(create_path_drawer(LATHE))
    yield effect
    effect.close()


def settled(effect: OffsetEffectWorker) -> ComparedPaths | None:
    effect.worker.wait_for_results(LIMIT)
    return effect.compared_paths


def test_changed_tool_offset_moves_only_its_own_path(effect: OffsetEffectWorker) -> None:
    after = {**TOOLS, 1: ToolOffset(-1.0 + 0.03, -50.0 - 0.04)}
    effect.request_paths(job(), OffsetTables(TOOLS), OffsetTables(after))
    pair = settled(effect)
    assert pair is not None
    assert pair.largest_distance_mm == pytest.approx(0.05)  # 3, 4, 5
    dx, dz = pair.picture_after.x - pair.picture_before.x, pair.picture_after.z - pair.picture_before.z
    first = abs(pair.picture_before.x - 0.5 * INCH) < 1e-9  # T1's cylinder
    assert dx[first] == pytest.approx(0.03)
    assert dz[first] == pytest.approx(-0.04)
    second = abs(pair.picture_before.x - 0.3 * INCH) < 1e-9  # T2's
    assert second.any()
    assert dx[second] == pytest.approx(0.0)
    assert dz[second] == pytest.approx(0.0)


def test_changed_secondary_offset_moves_only_its_own_moves(effect: OffsetEffectWorker) -> None:
    correction = {1: SecondaryOffset(-0.01, 0.0)}
    effect.request_paths(job(), OffsetTables(TOOLS), OffsetTables(TOOLS, correction))
    pair = settled(effect)
    assert pair is not None
    assert pair.largest_distance_mm == pytest.approx(0.01)
    moved = abs(pair.picture_after.x - pair.picture_before.x) > 1e-9
    assert set(pair.picture_before.x[moved].round(6)) == {round(0.6 * INCH, 6)}


def test_unused_offset_change_is_reported_as_no_effect(effect: OffsetEffectWorker) -> None:
    effect.request_paths(job(), OffsetTables(TOOLS), OffsetTables({**TOOLS, 9: ToolOffset(5.0, 5.0)}))
    pair = settled(effect)
    assert pair is not None
    assert pair.has_no_effect


def test_program_of_different_length_is_drawn_without_comparison() -> None:
    longer = ProgramSource("part.nc", PROGRAM)

    def draw(of: Job, frame: Mapping[int, ToolOffset], watch: ProgressCallback) -> ProgramPicture:
        text = PROGRAM if not of.setup.secondary else PROGRAM.replace("Z-1.2\n", "Z-1.2\nX.7Z-1.2\n")
        return create_path_drawer(LATHE)(make_job(ProgramSource("part.nc", text), of.setup), frame, watch)

    effect = OffsetEffectWorker(draw)
    effect.request_paths(
        make_job(longer, job().setup), OffsetTables(TOOLS), OffsetTables(TOOLS, {1: SecondaryOffset(1.0)})
    )
    pair = settled(effect)
    assert pair is not None
    assert math.isinf(pair.largest_distance_mm)
    assert not pair.has_no_effect
    effect.close()


def test_worker_failure_is_reported() -> None:
    def broken(_job: Job, _frame: Mapping[int, ToolOffset], _watch: ProgressCallback) -> ProgramPicture:
        raise ValueError("no such path")

    effect = OffsetEffectWorker(broken)
    effect.request_paths(job(), OffsetTables(), OffsetTables())
    assert settled(effect) is None
    assert effect.error_text == "no such path"
    effect.close()


def test_cleared_request_gives_no_result(effect: OffsetEffectWorker) -> None:
    effect.request_paths(job(), OffsetTables(TOOLS), OffsetTables(TOOLS))
    effect.clear_results()
    assert settled(effect) is None
    assert effect.error_text == ""
