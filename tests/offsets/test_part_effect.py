"""What typed offsets do to the part, feature by feature, and where there is none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.program_proving import create_loading_steps, create_part_comparer, create_path_drawer
from app.compose.stored_offsets import Offsets
from app.desk.desk import Desk
from app.offsets.offset_effect import EffectDisplay, OffsetEffectWorker
from app.offsets.offset_values import UnitMode
from app.offsets.part_effect import make_part_table
from core.language.source import ProgramSource
from core.store.store_rows import OffsetKind
from tests.desk.test_part_found import LIMIT, SHAFT, TOOLS
from tests.offsets.conftest import Room
from tests.texts import text

INCH = UnitMode()


@pytest.fixture
def shown(room: Room) -> EffectDisplay:
    """F8 with the shaft on the desk: .8 in diameter .5 in long, a cone, then the bar."""
    machine = load_machine(None)
    room.desk.page_registry.attach_model(
        OffsetEffectWorker(create_path_drawer(machine), create_part_comparer(machine))
    )
    for number, tool in TOOLS.items():
        room.desk.offset_book.change_fields(OffsetKind.TOOL, number, {"x": tool.x, "z": tool.z}, "before")
    page = room.grid()
    room.settle(page)
    put(room.desk, SHAFT)
    return EffectDisplay(page)


def put(desk: Desk, text: str) -> None:
    steps = create_loading_steps(load_machine(None), lambda: Offsets(TOOLS, {}, {}))
    job = steps.make_job(ProgramSource("part.nc", text), False)
    steps.prove_job(job, lambda _count: None)
    picture = steps.draw_path(job, lambda _count: None)
    desk.program_loader.replace_loaded_program(
        replace(desk.program_loader.loaded_program, job=job, picture=picture)
    )


def turned_to_part(shown: EffectDisplay) -> None:
    for _ in range(3):  # the path, the place of the greatest change, the part
        shown.show_next_view()
        effect = shown.offset_effect
        assert effect is not None
        effect.worker.wait_for_results(LIMIT)
    assert shown.is_part_shown


def types(room: Room, shown: EffectDisplay, *answers: str) -> None:
    for answer in answers:
        for key in answer:
            assert shown.offset_table.handle_key(key)
        if answer is not answers[-1]:
            assert shown.offset_table.handle_key("Enter")


def test_diameter_changes_by_twice_x_correction_and_shoulder_is_unchanged(
    room: Room, shown: EffectDisplay
) -> None:
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    part = shown.compared_part
    assert part is not None
    rows = {row.cells[0].split("  ")[0] + row.cells[1]: row for row in make_part_table(part, INCH).rows}
    turned = rows["DIAMETER0.80000"]
    assert (turned.cells[2], turned.cells[3], turned.is_lamp_lit) == ("0.79800", "−0.00200", True)
    face = rows["SHOULDER0.00000"]
    assert (face.cells[2], face.cells[3], face.is_lamp_lit) == ("0.00000", "–", False)
    assert shown.words == text("offsets.one-feature")


def test_part_effect_is_shown_in_millimeters(room: Room, shown: EffectDisplay) -> None:
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    part = shown.compared_part
    assert part is not None
    cells = [row.cells for row in make_part_table(part, UnitMode(is_metric=True)).rows]
    assert [each[3] for each in cells if each[1] == "20.3200"] == ["−0.0508"]


def test_next_view_after_part_is_offset_table_and_escape_closes_part(
    room: Room, shown: EffectDisplay
) -> None:
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    shown.show_next_view()
    assert (shown.is_open, shown.is_part_shown, shown.compared_part) == (False, False, None)
    turned_to_part(shown)
    shown.close_view()
    assert shown.compared_part is None


def test_program_without_part_shows_message(room: Room, shown: EffectDisplay) -> None:
    put(room.desk, "G90G94F100\nM03S1500\nT1\nX2Z2\nX2.5\nM30\n")
    types(room, shown, "1", "0-.501")
    turned_to_part(shown)
    assert shown.compared_part is None
    assert text("offsets.no-part") in shown.words


def test_part_of_too_long_program_is_not_compared(room: Room, shown: EffectDisplay) -> None:
    now = room.desk.program_loader.loaded_program
    assert now.picture is not None
    long = replace(now.picture, part=None, no_part="70000 blocks: too many")
    room.desk.program_loader.replace_loaded_program(replace(now, picture=long))
    types(room, shown, "1", "0-.501")
    for _ in range(3):
        shown.show_next_view()
        assert shown.offset_effect is not None
        shown.offset_effect.worker.wait_for_results(LIMIT)
    assert not shown.is_open
    assert room.desk.prompt_notice == "70000 blocks: too many"
