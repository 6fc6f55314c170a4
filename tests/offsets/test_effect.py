"""What a change of offsets does to the path, worked out by hand on a program of four moves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import setup_for
from app.compose.workshop import drawer
from app.desk.background_work import Watch
from app.offsets.offset_effect import Compared, Effect, Tables
from app.path.path_picture import Picture
from core.executor.job import Job, make_job
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import Source

INCH = 25.4
LIMIT = 60.0
PROGRAM = (
    "G90G94F300\nM03S1000\nT1\nX.5Z.1\nG01F5Z-1\nX.6Z-1D1\nZ-1.2\nX1Z1G00D0\nT2\nX.3Z.1\nG01F5Z-.5\nM30\n"
)
TOOLS = {1: ToolOffset(-1.0, -50.0), 2: ToolOffset(2.0, -40.0)}
LATHE = load_machine()


def job() -> Job:
    setup = setup_for(LATHE, tools=TOOLS, secondary={})
    return make_job(Source("part.nc", PROGRAM), setup)


@pytest.fixture
def effect() -> Iterator[Effect]:
    effect = Effect(drawer(LATHE))
    yield effect
    effect.close()


def settled(effect: Effect) -> Compared | None:
    effect.worker.settle(LIMIT)
    return effect.now


def test_a_tool_that_moves_moves_its_own_path_alone(effect: Effect) -> None:
    after = {**TOOLS, 1: ToolOffset(-1.0 + 0.03, -50.0 - 0.04)}
    effect.ask(job(), Tables(TOOLS), Tables(after))
    pair = settled(effect)
    assert pair is not None
    assert pair.furthest == pytest.approx(0.05)  # 3, 4, 5
    dx, dz = pair.after.x - pair.before.x, pair.after.z - pair.before.z
    first = abs(pair.before.x - 0.5 * INCH) < 1e-9  # T1's cylinder
    assert dx[first] == pytest.approx(0.03)
    assert dz[first] == pytest.approx(-0.04)
    second = abs(pair.before.x - 0.3 * INCH) < 1e-9  # T2's
    assert second.any()
    assert dx[second] == pytest.approx(0.0)
    assert dz[second] == pytest.approx(0.0)


def test_a_secondary_offset_moves_the_moves_that_it_is_called_for(effect: Effect) -> None:
    correction = {1: SecondaryOffset(-0.01, 0.0)}
    effect.ask(job(), Tables(TOOLS), Tables(TOOLS, correction))
    pair = settled(effect)
    assert pair is not None
    assert pair.furthest == pytest.approx(0.01)
    moved = abs(pair.after.x - pair.before.x) > 1e-9
    assert set(pair.before.x[moved].round(6)) == {round(0.6 * INCH, 6)}


def test_no_difference_is_said(effect: Effect) -> None:
    effect.ask(job(), Tables(TOOLS), Tables({**TOOLS, 9: ToolOffset(5.0, 5.0)}))
    pair = settled(effect)
    assert pair is not None
    assert pair.same


def test_a_path_of_another_kind_is_drawn_as_it_is() -> None:
    longer = Source("part.nc", PROGRAM)

    def draw(of: Job, frame: Mapping[int, ToolOffset], watch: Watch) -> Picture:
        text = PROGRAM if not of.setup.secondary else PROGRAM.replace("Z-1.2\n", "Z-1.2\nX.7Z-1.2\n")
        return drawer(LATHE)(make_job(Source("part.nc", text), of.setup), frame, watch)

    effect = Effect(draw)
    effect.ask(make_job(longer, job().setup), Tables(TOOLS), Tables(TOOLS, {1: SecondaryOffset(1.0)}))
    pair = settled(effect)
    assert pair is not None
    assert math.isinf(pair.furthest)
    assert not pair.same
    effect.close()


def test_a_worker_that_fails_is_told() -> None:
    def broken(_job: Job, _frame: Mapping[int, ToolOffset], _watch: Watch) -> Picture:
        raise ValueError("no such path")

    effect = Effect(broken)
    effect.ask(job(), Tables(), Tables())
    assert settled(effect) is None
    assert effect.trouble == "no such path"
    effect.close()


def test_what_nobody_looks_at_any_more_is_forgotten(effect: Effect) -> None:
    effect.ask(job(), Tables(TOOLS), Tables(TOOLS))
    effect.forget()
    assert settled(effect) is None
    assert effect.trouble == ""
