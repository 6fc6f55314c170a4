"""What typed offsets do to the part, feature by feature, and where there is none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.stored_offsets import Offsets
from app.compose.workshop import drawer, part_comparer, workshop
from app.desk.desk import Desk
from app.offsets.offset_effect import Effect, EffectDisplay
from app.offsets.offset_values import Mode
from app.offsets.part_effect import part_table
from core.language.source import Source
from core.store.store_rows import Kind
from tests.desk.test_part_found import LIMIT, SHAFT, TOOLS
from tests.offsets.conftest import Room
from tests.texts import text

INCH = Mode()


@pytest.fixture
def shown(room: Room) -> EffectDisplay:
    """F8 with the shaft on the desk: .8 in diameter .5 in long, a cone, then the bar."""
    machine = load_machine(None)
    room.desk.pages.attach(Effect(drawer(machine), part_comparer(machine)))
    for number, tool in TOOLS.items():
        room.desk.book.change(Kind.TOOL, number, {"x": tool.x, "z": tool.z}, "before")
    page = room.grid()
    room.settle(page)
    put(room.desk, SHAFT)
    return EffectDisplay(page)


def put(desk: Desk, text: str) -> None:
    steps = workshop(load_machine(None), lambda: Offsets(TOOLS, {}, {}))
    job = steps.make_job(Source("part.nc", text), False)
    steps.prove(job, lambda _count: None)
    picture = steps.draw(job, lambda _count: None)
    desk.session.adopt(replace(desk.session.now, job=job, picture=picture))


def turned_to_part(shown: EffectDisplay) -> None:
    for _ in range(3):  # the path, the place of the greatest change, the part
        shown.turn()
        effect = shown.effect
        assert effect is not None
        effect.worker.settle(LIMIT)
    assert shown.of_part


def types(room: Room, shown: EffectDisplay, *answers: str) -> None:
    for answer in answers:
        for key in answer:
            assert shown.table.typed(key)
        if answer is not answers[-1]:
            assert shown.table.typed("Enter")


def test_a_thousandth_of_x_takes_two_off_each_diameter_and_leaves_shoulders(
    room: Room, shown: EffectDisplay
) -> None:
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    part = shown.part
    assert part is not None
    rows = {row.cells[0].split("  ")[0] + row.cells[1]: row for row in part_table(part, INCH).rows}
    turned = rows["DIAMETER0.80000"]
    assert (turned.cells[2], turned.cells[3], turned.lit) == ("0.79800", "−0.00200", True)
    face = rows["SHOULDER0.00000"]
    assert (face.cells[2], face.cells[3], face.lit) == ("0.00000", "–", False)
    assert shown.words == text("offsets.one-feature")


def test_in_mm_the_same_is_told_in_mm(room: Room, shown: EffectDisplay) -> None:
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    part = shown.part
    assert part is not None
    cells = [row.cells for row in part_table(part, Mode(metric=True)).rows]
    assert [each[3] for each in cells if each[1] == "20.3200"] == ["−0.0508"]


def test_after_the_part_comes_the_table_and_escape_leads_there_at_once(
    room: Room, shown: EffectDisplay
) -> None:
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    shown.turn()
    assert (shown.open, shown.of_part, shown.part) == (False, False, None)
    turned_to_part(shown)
    shown.close()
    assert shown.part is None


def test_a_program_that_makes_no_part_says_so(room: Room, shown: EffectDisplay) -> None:
    put(room.desk, "G90G94F100\nM03S1500\nT1\nX2Z2\nX2.5\nM30\n")
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    assert shown.part is None
    assert text("offsets.no-part") in shown.words


def test_of_a_program_that_is_too_long_no_part_is_compared(room: Room, shown: EffectDisplay) -> None:
    now = room.desk.session.now
    assert now.picture is not None
    long = replace(now.picture, part=None, no_part="70000 blocks: too many")
    room.desk.session.adopt(replace(now, picture=long))
    types(room, shown, "1", "0-.501")
    for _ in range(3):
        shown.turn()
        assert shown.effect is not None
        shown.effect.worker.settle(LIMIT)
    assert not shown.open
    assert room.desk.notice == "70000 blocks: too many"
