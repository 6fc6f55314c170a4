"""Shape of a tool, F8 of the tool offsets: fields by kind, what is refused, what is shown, and when."""

from __future__ import annotations

import pytest

from app.offsets.tool_shapes import ToolShapeTable
from core.executor.snapshot import MachineState
from core.part.tool_shape import ToolKind
from core.store.store_rows import TOOL_KINDS, ToolShapeRow
from tests.offsets.conftest import LIMIT, Room
from tests.screen.yes import read
from tests.texts import shows, text

INCH = 25.4


def set_tools(room: Room) -> None:
    """T1 turns and was touched off, T2 was touched off and has no shape, T3 is a drill from the office."""
    room.store.offsets.tool_offsets.change_row(
        1, "set", {"x": -12.7, "z": -76.2, "nose_radius": 0.79375, "quadrant": 3}
    )
    room.store.offsets.tool_offsets.change_row(2, "set", {"x": 25.4, "z": -50.8})
    room.store.offsets.tool_shapes.change_row(1, "set", {"kind": "turning", "insert": "CNMG432"})
    room.store.offsets.tool_shapes.change_row(3, "set", {"kind": "drill", "diameter": 6.35}).result(LIMIT)
    room.desk.offset_book.read_store()


def shape_of(room: Room, number: int, name: str = "kind") -> ToolShapeTable:
    """The page of this tool with the cursor on a field."""
    set_tools(room)
    page = ToolShapeTable(room.desk)
    page.offset_history.on_open()
    page.update(room.now[0])
    page.select_tool(number)
    page.move_cursor(page.field_names.index(name))
    return page


def write(page: ToolShapeTable, *keys: str) -> None:
    """``Enter`` and the like are keys; other words are typed letter by letter."""
    for key in keys:
        named = key in {
            "Enter",
            "Left",
            "Right",
            "Up",
            "Down",
            "Tab",
            "Page up",
            "Page down",
            "Back",
            "Delete",
        }
        for each in [key] if named else key:
            assert page.handle_key(each)


def save(room: Room, page: ToolShapeTable) -> None:
    """Wait for the disk, then look as a frame would."""
    room.store.write(lambda _connection: None).result(LIMIT)
    room.desk.offset_book.poll_saving()
    page.update(room.now[0])


def test_fields_depend_on_tool_kind(room: Room) -> None:
    page = shape_of(room, 1)
    assert page.field_names[:4] == ("kind", "hand", "quadrant", "nose_radius")
    assert "diameter" not in page.field_names
    page.select_tool(3)
    assert page.field_names == ("kind", "quadrant", "diameter", "point", "length", "stick_out", "flutes")
    page.select_tool(2)
    assert page.field_names == ("kind",)


@pytest.mark.parametrize("kind", TOOL_KINDS)
def test_every_kind_has_its_fields_on_the_page(room: Room, kind: str) -> None:
    set_tools(room)
    room.desk.offset_book.tool_shapes[5] = ToolShapeRow(kind)
    page = ToolShapeTable(room.desk)
    page.update(room.now[0])
    page.select_tool(5)
    assert len(page.field_names) <= 12, "two columns of six"
    for name in page.field_names:
        page.move_cursor(page.field_names.index(name))
        assert page.question_text.startswith("T5  ")
        page.format_field(name)
    assert page.tool_outline is not None
    assert ToolKind(kind)


def test_tool_kind_is_selected_and_saved(room: Room) -> None:
    page = shape_of(room, 2)
    write(page, "Right")
    assert page.entered_text == "TURNING"
    write(page, "Right", "Right", "Left", "Left", "Left")
    assert page.entered_text == "FORM TOOL", "it goes round"
    write(page, "Right", "Enter")
    save(room, page)
    assert room.store.offsets.tool_shapes.read_rows()[2] == ToolShapeRow("turning")
    assert room.desk.prompt_notice == "T2 SAVED"
    assert page.offset_history.last_change_text == "T2   not set  →  TURNING  RIGHT HAND"


@pytest.mark.parametrize(
    ("metric", "typed", "mm"), [(False, ".25", 6.35), (False, "1/4+1/8", 9.525), (True, "6.5", 6.5)]
)
def test_length_is_typed_in_the_controls_unit(room: Room, metric: bool, typed: str, mm: float) -> None:
    page = shape_of(room, 3, "diameter")
    room.at(metric=metric, diameter=True)  # an X that is a diameter changes no size of a tool
    page.update(room.now[0])
    write(page, typed, "Enter")
    save(room, page)
    assert room.store.offsets.tool_shapes.read_rows()[3].diameter == pytest.approx(mm)


def test_angle_is_typed_in_degrees(room: Room) -> None:
    page = shape_of(room, 3, "point")
    write(page, "118", "Enter")
    save(room, page)
    assert room.store.offsets.tool_shapes.read_rows()[3].point == 118.0
    assert page.format_field("point") == "118°"


def test_text_is_opened_edited_and_saved(room: Room) -> None:
    page = shape_of(room, 1, "insert")
    assert not page.accepts_key("D")
    write(page, "Enter")
    assert (page.text, page.accepts_key("D")) == ("CNMG432", True)
    write(page, "Delete", "DNMG 442", "Enter")
    save(room, page)
    assert room.store.offsets.tool_shapes.read_rows()[1].insert == "DNMG 442"
    assert page.format_field("insert") == "DNMG 442"


def test_nose_radius_and_tip_come_from_offset(room: Room) -> None:
    page = shape_of(room, 1, "nose_radius")
    assert page.format_field("nose_radius") == "0.03125"
    write(page, ".0156", "Enter")
    save(room, page)
    assert room.store.offsets.tool_offsets.read_rows()[1].nose_radius == pytest.approx(0.0156 * INCH)
    assert len(room.store.offsets.tool_shapes.read_history()) == 2, "the shape has not changed"
    assert room.desk.prompt_notice == "SAVED"
    assert page.tool_outline is not None
    assert page.tool_outline.cutting_outlines[0][:, 1].min() == pytest.approx(0.0, abs=1e-9)


def test_page_keys_select_next_tool_in_page_and_table(room: Room) -> None:
    page = shape_of(room, 1)
    write(page, "Page down", "Page down")
    assert (page.tool_number, room.grid().tool_number) == (3, 3)
    write(page, *["Page up"] * 5)
    assert page.tool_number == 1


def test_f3_deletes_shape_after_confirmation_and_undo_restores_it(room: Room) -> None:
    page = shape_of(room, 3)
    page.delete_shape()
    assert text("offsets.forget-shape", number=3) in room.desk.prompt_notice
    assert 3 in room.store.offsets.tool_shapes.read_rows()
    read(room.desk)
    room.desk.confirm_question()
    save(room, page)
    assert 3 not in room.store.offsets.tool_shapes.read_rows()
    page.handle_undo()
    room.confirm()
    save(room, page)
    assert room.store.offsets.tool_shapes.read_rows()[3].diameter == 6.35
    assert room.desk.prompt_notice == "T3 UNDONE"


# --- refusals ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("number", "name", "keys", "says"),
    [
        (
            1,
            "insert",
            ("Enter", "Delete", "CNXG432", "Enter"),
            text(
                "offsets.insert-invalid",
                code="CNXG432",
                what="tolerance class",
                where="character 3 (X)",
                known=" ".join("ACEFGHJKLMNU"),
            ),
        ),
        (1, "nose_radius", (".26", "Enter"), "the nose radius is too large for insert CNMG432"),
        (
            1,
            "entry",
            ("101", "Enter"),
            "an entering angle of 101° leaves no clearance for a point angle of 80°",
        ),
        (1, "entry", ("200", "Enter"), text("offsets.takes", field="entering angle", range="0…150 degrees")),
        (1, "rear", ("Right", "Enter"), ""),
        (3, "diameter", ("-.25", "Enter"), "allowed range is 0…20"),
        (3, "diameter", ("1/", "Enter"), "REJECTED: "),
        (3, "flutes", ("2.5", "Enter"), text("offsets.takes", field="flutes", range="0…20")),
        (3, "quadrant", ("7", "Enter"), "T3 IS NOT SET"),
        (1, "quadrant", ("10", "Enter"), text("offsets.takes", field="tip quadrant", range="0…9")),
    ],
)
def test_invalid_value_is_rejected_and_remains_for_editing(
    room: Room, number: int, name: str, keys: tuple[str, ...], says: str
) -> None:
    page = shape_of(room, number, name)
    before = (
        room.store.offsets.tool_shapes.read_rows()[number],
        room.store.offsets.tool_offsets.read_rows().get(number),
    )
    write(page, *keys)
    if not says:  # a contradiction with another field is kept, and shown there
        save(room, page)
        assert shows(page.prompt_text(room.now[0]), "offsets.front-quadrant", quadrant=3)
        assert page.tool_outline is None
        return
    assert says in room.desk.prompt_notice
    assert page.text
    assert (
        room.store.offsets.tool_shapes.read_rows()[number],
        room.store.offsets.tool_offsets.read_rows().get(number),
    ) == before


def test_letters_are_rejected_in_number_field(room: Room) -> None:
    page = shape_of(room, 3, "diameter")
    assert not page.handle_key("q")
    write(page, "Up")
    page.move_cursor(0)
    write(page, "5")
    assert room.desk.prompt_notice == text("offsets.choices")
    assert page.text == ""


def test_text_field_accepts_nothing_before_it_is_opened(room: Room) -> None:
    page = shape_of(room, 1, "insert")
    write(page, "5")
    assert room.desk.prompt_notice == text("offsets.write-it")
    assert page.text == ""


def test_cursor_does_not_leave_unfinished_entry(room: Room) -> None:
    page = shape_of(room, 3, "diameter")
    write(page, ".3", "Down")
    assert page.name == "diameter"
    write(page, "Page down")
    assert page.tool_number == 3
    assert room.desk.prompt_notice == text("offsets.set-it")
    assert page.handle_escape()
    assert (page.text, room.desk.prompt_notice) == ("", text("offsets.shape-as-it-was", number=3))
    assert not page.handle_escape()


def test_changes_are_rejected_while_program_runs(room: Room) -> None:
    page = shape_of(room, 3, "diameter")
    room.at(MachineState.RUN)
    write(page, ".3", "Enter")
    assert "PROGRAM RUNNING" in room.desk.prompt_notice
    page.discard_entry()
    page.move_cursor(0)
    write(page, "Right")
    assert page.text == ""
    page.delete_shape()
    page.handle_undo()
    assert not room.desk.confirmation_key
    assert len(room.store.offsets.tool_shapes.read_history()) == 2


def test_missing_shape_cannot_be_deleted(room: Room) -> None:
    page = shape_of(room, 2)
    page.delete_shape()
    assert room.desk.prompt_notice == text("offsets.no-shape", number=2)
    assert not room.desk.confirmation_key
