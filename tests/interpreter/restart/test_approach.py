"""The way to a line: in lathe order, no farther off than the program has been, and Z last in a bore."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.actions import Coolant, Output, SpindleRun, SpindleStop
from core.interpreter.begin import Checkpoint, Do, Leg, Step, Turn
from core.interpreter.modal import Modal
from core.interpreter.restart.approach import Choices, Now, begin_at, starting, way
from core.interpreter.restart.found import Clear, Found
from core.interpreter.restart.rebuild import Rebuild
from core.language.source import Source
from tests.interpreter.programs import setup

AT = Checkpoint(Modal(tool=1, tool_x=-10.0, tool_z=-50.0, spindle=1, rpm=800.0, coolant=True), x=8.0, z=-12.0)
FOUND = Found(
    9, AT, Clear(-48.0, 14.0, {1: (-2.0, 5.0)})
)  # the tool was 15 mm off the centre, Z 2 mm off the face
STANDS = Now((-3.0, -60.0, 0.0), Modal(tool=1, tool_x=-10.0, tool_z=-50.0))


def legs(steps: tuple[Step, ...]) -> list[tuple[float | None, float | None]]:
    return [(step.x, step.z) for step in steps if isinstance(step, Leg)]


def order(steps: tuple[Step, ...]) -> list[str]:
    return [step.text for step in steps]


def test_outside_x_goes_out_first_and_comes_in_last() -> None:
    steps = way(FOUND, STANDS, Choices())
    assert legs(steps) == [(5.0, None), (None, -48.0), (None, -62.0), (-2.0, None)]
    assert order(steps) == ["X", "Z", "M03", "M08", "Z", "X"]
    last = steps[-1]
    assert isinstance(last, Leg)
    assert not last.rapid  # a feed waits for the spindle's speed
    assert last.feed < Choices().rapid


def test_inside_a_bore_z_goes_out_first_and_comes_in_last() -> None:
    steps = way(FOUND, STANDS, Choices(inside=True))
    assert legs(steps) == [(None, -48.0), (-2.0, None), (None, -62.0)]
    assert order(steps) == ["Z", "X", "M03", "M08", "Z"]


def test_on_the_far_side_of_the_centre_line_out_is_x_minus() -> None:
    point = replace_point(AT, x=-8.0)
    found = Found(9, point, Clear(-48.0, 14.0, {1: (-40.0, -15.0)}))
    now = Now((-17.0, -60.0, 0.0), STANDS.modal)
    assert legs(way(found, now, Choices())) == [(-40.0, None), (None, -48.0), (None, -62.0), (-18.0, None)]


def replace_point(point: Checkpoint, **changes: float) -> Checkpoint:
    return point._replace(**changes)  # type: ignore[arg-type]


def test_a_slide_that_stands_farther_out_stays_there() -> None:
    now = Now((30.0, -20.0, 0.0), STANDS.modal)
    assert legs(way(FOUND, now, Choices())) == [(5.0, None), (None, -62.0), (-2.0, None)]


def test_what_must_not_run_is_stopped_before_anything_moves() -> None:
    now = Now(STANDS.at, STANDS.modal._replace(spindle=-1, coolant=True, outputs=frozenset({"live1"})))
    found = replace(FOUND, checkpoint=AT._replace(modal=AT.modal._replace(coolant=False)))
    steps = way(found, now, Choices())
    assert order(steps)[:3] == ["M05", "M09", "LIVE1 OFF"]
    actions = [step.action for step in steps if isinstance(step, Do)]
    assert actions[:3] == [SpindleStop(), Coolant(False), Output("live1", False)]


def test_what_starts_is_told_and_coolant_only_as_chosen() -> None:
    told = [step.action for step in starting(FOUND, STANDS, Choices()) if isinstance(step, Do)]
    assert told == [SpindleRun(800.0, None), Coolant(True)]
    without = begin_at(FOUND, STANDS, Choices(coolant=False))
    assert not without.checkpoint.modal.coolant
    assert "M08" not in order(without.way)


def test_c_is_locked_and_turned_to_its_angle_by_the_short_way() -> None:
    modal = AT.modal._replace(spindle=0, c_locked=True, coolant=False, offset_c=720.0)
    found = replace(FOUND, checkpoint=AT._replace(modal=modal, c=90.0))
    begin = begin_at(found, Now((-3.0, -60.0, 1000.0), STANDS.modal), Choices())
    turn = next(step for step in begin.way if isinstance(step, Turn))
    assert turn.c == pytest.approx(1170.0)  # 90 degrees and three turns: the nearest to 1000
    assert begin.checkpoint.modal.offset_c == pytest.approx(1080.0)


@pytest.mark.parametrize(
    ("text", "line", "inside"),
    [
        ("X1Z.1\nG01G94F10X.5\nZ-.5\nX.6\nG94F300Z.1\n", 4, False),  # turning
        ("X.2Z.1\nG01G94F10Z-.5\nX.18\nG94F300Z.1\n", 4, True),  # boring
        ("X.3Z.1\nG01G94F10X.28Z0\nZ-.5\nG02X.26Z-.52R.02\nG94F300Z.1\n", 4, True),  # an arc to the centre
        ("X.6Z0\nG01G94F10X-.02\nG94F300Z.1\n", 3, True),  # a face: in along Z at the outside
        ("X.3Z.1\nG01G94F10Z-.5\nG94F300Z.1\n", 4, True),  # straight out again, at the radius of the bore
        ("X.6Z-.4\nG01G94F10X.3\nZ-.35\nG94F300X.6\nZ.1\n", 4, False),  # a groove widened towards Z+
        ("X0Z.1\nG01G94F10Z-.5\nG94F300Z.1\n", 3, True),  # drilling on the centre
        ("X1Z-.5\nG01G94F10X.4\nG04F.2\nX1\nG94F300Z.1\n", 3, False),  # a groove
        ("X1Z-.5\nX.9\n", 3, False),  # nothing tells: the way of turning
    ],
)
def test_inside_or_outside_is_told_by_how_the_tool_is_taken_off(text: str, line: int, inside: bool) -> None:
    program = Source("PART", f"G90G94F300\n{text}M30\n")
    found = Rebuild(program, setup(), lambda _count: None).find(line)
    assert isinstance(found, Found)
    assert found.inside is inside
