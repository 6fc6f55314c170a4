"""The tool table and the presets of a mill: typed, touched off, refused; what the interpreter gets."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.compose.machine.kinematics_chain import build_kinematics
from app.compose.machine.machine_files import load_named_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import create_offset_book, create_setup_with_offsets, read_offsets_file
from app.desk.status.machine_status import StatusTone
from app.offsets.active_offsets import MillOffsets, add_mill_offsets
from app.offsets.cell_table import CellTable
from app.offsets.mill_tools import MillToolTable
from app.offsets.mill_touch import MillToolLives, MillTouchCalculator
from app.offsets.zero_offsets import PresetTable
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import ToolOffset
from core.production.tool_life import ToolLife
from core.store.store_rows import MillToolRow, OffsetKind, PresetRow
from tests.offsets.conftest import LIMIT, Room
from tests.texts import text

AXES = ("X", "Y", "Z", "A", "C")


def mill(room: Room, *at: float, tool: int = 0) -> None:
    """The machine is an A-C table that stands there."""
    machine = build_kinematics(load_named_machine("ac-table-mill"))
    room.desk.page_registry.attach_model(MillTouchCalculator(room.desk, machine))
    snapshot, place = room.now[0], (*at, *(0.0,) * (5 - len(at)))
    modal = snapshot.modal._replace(metric=True, tool=tool)
    room.now[0] = replace(snapshot, axes=AXES, actual=place, demand=place, homed=(True,) * 5, modal=modal)


def types(room: Room, page: CellTable, text: str, *, name: str = "", row: int = 0) -> None:
    page.update(room.now[0])
    if name:
        page.choose(row, page.columns.index(name))
    for key in text:
        assert page.handle_key(key)
    page.handle_key("Enter")
    settle(room, page)


def settle(room: Room, page: CellTable) -> None:
    room.store.write(lambda _connection: None).result(LIMIT)
    room.desk.update()
    page.update(room.now[0])


def kept(room: Room, tool: int = 1) -> MillToolRow:
    return room.store.offsets.mill_tools.read_rows()[tool]


# --- typed ----------------------------------------------------------------------------------------------


def test_lengths_radii_and_teeth_are_entered_in_millimeters(room: Room) -> None:
    mill(room)
    page = MillToolTable(room.desk)
    typed = {"length": "80.5", "radius": "12/2", "dl": "-.02", "teeth": "4", "life": "90"}
    for name, value in typed.items():
        types(room, page, value, name=name, row=19)
    row = kept(room, 20)
    assert row == MillToolRow(length=80.5, radius=6.0, dl=-0.02, teeth=4, life=90.0)
    page.handle_undo()
    room.confirm()
    settle(room, page)
    assert kept(room, 20).life == 0.0


def test_tool_name_accepts_letters_after_return(room: Room) -> None:
    mill(room)
    page = MillToolTable(room.desk)
    page.choose(4, 0)
    assert not page.accepts_key("H")
    page.handle_key("Enter")
    assert page.accepts_key("H")
    types(room, page, "Hole 8")
    assert kept(room, 5).name == "Hole 8"


def test_a_preset_is_in_force_until_it_is_chosen_again(room: Room) -> None:
    mill(room)
    page = PresetTable(room.desk)
    types(room, page, "10", name="x", row=2)
    page.activate_preset()
    settle(room, page)
    assert room.desk.offset_book.active_preset == 3
    page.activate_preset()
    settle(room, page)
    assert room.desk.offset_book.active_preset == 0


# --- touched off ----------------------------------------------------------------------------------------


def test_tool_length_is_set_from_tip_on_part(room: Room) -> None:
    mill(room, 250.0, 220.0, -265.0)  # zero lies at Z -350: the nose is 85 over it, the tip 5
    page = MillToolTable(room.desk)
    page.choose(0, page.columns.index("length"))
    page.update(room.now[0])
    for key in "5":
        page.handle_key(key)
    page.set_value_from_position()
    settle(room, page)
    assert kept(room).length == pytest.approx(80.0)


def test_workpiece_datum_is_set_from_touching_tip(room: Room) -> None:
    room.store.offsets.get_table(MillToolTable.kind).change_row(
        7, "", {"length": 60.0, "radius": 5.0}
    ).result(LIMIT)
    room.desk.offset_book.read_store()
    mill(room, 100.0, 50.0, -200.0, tool=7)
    page = PresetTable(room.desk)
    for name, reads in (("x", "-5"), ("y", ""), ("z", "2")):
        page.choose(0, page.columns.index(name))
        page.update(room.now[0])
        for key in reads:
            page.handle_key(key)
        page.set_value_from_position()
        settle(room, page)
    # The tip is 60 below the nose; its centre stands 5 before the left side.
    assert room.store.offsets.presets.read_rows()[1] == PresetRow(x=105.0, y=50.0, z=-262.0)


def test_rotated_table_position_is_converted_to_zero_rotation(room: Room) -> None:
    # C at 180 about X 300, Y 252: what touches at 340, 252 lies at 260, 252 with C at 0.
    room.store.offsets.get_table(MillToolTable.kind).change_row(7, "", {"length": 60.0}).result(LIMIT)
    room.desk.offset_book.read_store()
    mill(room, 340.0, 252.0, -200.0, 0.0, 180.0, tool=7)
    page = PresetTable(room.desk)
    page.set_value_from_position()
    settle(room, page)
    assert room.store.offsets.presets.read_rows()[1].x == pytest.approx(260.0)


def touches(room: Room, page: MillToolTable | PresetTable, name: str, reads: str = "") -> None:
    page.choose(0, page.columns.index(name))
    page.update(room.now[0])
    for key in reads:
        page.handle_key(key)
    page.set_value_from_position()
    settle(room, page)


def test_rotary_axis_datum_is_set_from_entered_reading(room: Room) -> None:
    """C at 130 shall read 40: its zero is 90, and the part's zero goes along, 40 to the right of the table's
    line at X 300, Y 252, a quarter turn back."""
    room.store.offsets.presets.change_row(1, "", {"x": 340.0, "y": 252.0, "z": 7.0}).result(LIMIT)
    room.desk.offset_book.read_store()
    mill(room, 0.0, 0.0, 0.0, 0.0, 130.0)
    page = PresetTable(room.desk)
    assert page.columns == ("x", "y", "z", "rotation", "a", "c", "remark")
    touches(room, page, "c", "40")
    row = room.store.offsets.presets.read_rows()[1]
    assert (row.c, row.x, row.y, row.z) == pytest.approx((90.0, 300.0, 212.0, 7.0))
    types(room, page, "10", name="c")  # typed it is the figure alone
    assert room.store.offsets.presets.read_rows()[1] == row._replace(c=10.0)


def at(room: Room, x: float, y: float) -> None:
    room.now[0] = replace(room.now[0], actual=(x, y, -200.0, 0.0, 0.0))


def test_basic_rotation_is_set_from_two_points_of_edge(room: Room) -> None:
    """10 up on 100 along is atan .1 = 5.7106 degrees, from whichever end; an edge along Y reads 90."""
    room.store.offsets.mill_tools.change_row(7, "", {"length": 60.0}).result(LIMIT)
    room.desk.offset_book.read_store()
    mill(room, 100.0, 50.0, -200.0, tool=7)
    page = PresetTable(room.desk)
    page.choose(0, page.columns.index("rotation"))
    for first, last, reads, wanted in (
        ((100.0, 50.0), (200.0, 60.0), "", 5.7105931),
        ((200.0, 60.0), (100.0, 50.0), "", 5.7105931),
        ((100.0, 50.0), (90.0, 150.0), "90", 5.7105931),
    ):
        at(room, *first)
        page.set_value_from_position()
        assert text("offsets.first-point") in room.desk.prompt_notice
        at(room, *last)
        for key in reads:
            page.handle_key(key)
        page.set_value_from_position()
        settle(room, page)
        assert room.store.offsets.presets.read_rows()[1].rotation == pytest.approx(wanted, abs=1e-6)


def test_coincident_edge_points_are_rejected_and_cell_change_clears_first(room: Room) -> None:
    room.store.offsets.mill_tools.change_row(7, "", {"length": 60.0}).result(LIMIT)
    room.desk.offset_book.read_store()
    mill(room, 100.0, 50.0, -200.0, tool=7)
    page = PresetTable(room.desk)
    page.choose(0, page.columns.index("rotation"))
    page.set_value_from_position()
    at(room, 100.5, 50.5)
    page.set_value_from_position()
    assert "LESS THAN 1 MM APART" in room.desk.prompt_notice
    assert room.store.offsets.presets.read_rows() == {}
    page.choose(0, page.columns.index("rotation"))
    page.set_value_from_position()
    assert text("offsets.first-point") in room.desk.prompt_notice


# --- tool life ------------------------------------------------------------------------------------------


def test_cur_time_shows_cutting_time_and_edit_goes_to_counter(room: Room) -> None:
    room.store.offsets.mill_tools.change_row(1, "", {"length": 60.0, "life": 30.0}).result(LIMIT)
    room.desk.offset_book.read_store()
    mill(room)
    told: list[tuple[int, float]] = []
    lives = {1: ToolLife(1, limit_seconds=1800.0, seconds=1680.0)}
    room.desk.page_registry.attach_model(
        MillToolLives(lambda: lives, lambda number, cut: told.append((number, cut)))
    )
    page = MillToolTable(room.desk)
    page.choose(0, page.columns.index("used"))
    assert page.value_at(1, "used") == 28.0
    assert page.tone_at(1, "used") is StatusTone.PAUSE
    types(room, page, "0", name="used")
    assert told == [(1, 0.0)]
    types(room, page, "5", name="used", row=8)
    assert text("offsets.not-in-table", number=9) in room.desk.prompt_notice
    assert told == [(1, 0.0)]


def test_return_toggles_stop_setting(room: Room) -> None:
    mill(room)
    page = MillToolTable(room.desk)
    page.choose(0, page.columns.index("stops"))
    for wanted in (True, False):
        page.handle_key("Enter")
        settle(room, page)
        assert kept(room).stops is wanted
    types(room, page, "2")
    assert room.desk.prompt_notice.startswith("REJECTED")


# --- refusals -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "text"),
    [("radius", "-1"), ("length", "1001"), ("teeth", "2.5"), ("dl", "100"), ("point", "181")],
)
def test_invalid_tool_value_is_rejected(room: Room, name: str, text: str) -> None:
    mill(room)
    page = MillToolTable(room.desk)
    types(room, page, text, name=name)
    assert room.desk.prompt_notice.startswith("REJECTED")
    assert room.store.offsets.mill_tools.read_rows() == {}


def test_changes_are_rejected_while_program_runs(room: Room) -> None:
    mill(room)
    room.at(MachineState.RUN)
    page = PresetTable(room.desk)
    types(room, page, "3", name="x")
    assert room.store.offsets.presets.read_rows() == {}
    page.activate_preset()
    assert text("offsets.between-cycles") in room.desk.prompt_notice


def test_tool_length_is_not_set_with_tilted_tool(room: Room) -> None:
    mill(room, 250.0, 220.0, -265.0, 30.0)
    page = MillToolTable(room.desk)
    page.choose(0, page.columns.index("length"))
    page.set_value_from_position()
    assert "TILTED" in room.desk.prompt_notice
    assert room.store.offsets.mill_tools.read_rows() == {}


def test_workpiece_is_not_set_with_tool_of_unknown_length(room: Room) -> None:
    mill(room, 1.0, 2.0, 3.0, tool=9)
    page = PresetTable(room.desk)
    page.set_value_from_position()
    assert "TOOL CALL" in room.desk.prompt_notice
    assert room.store.offsets.presets.read_rows() == {}


def test_position_is_not_set_from_unhomed_axis(room: Room) -> None:
    mill(room)
    room.now[0] = replace(room.now[0], homed=(True, True, False, True, True))
    MillToolTable(room.desk).set_value_from_position()
    page = MillToolTable(room.desk)
    page.choose(0, page.columns.index("length"))
    page.set_value_from_position()
    assert text("offsets.not-homed", axes="Z") in room.desk.prompt_notice


def test_unset_preset_cannot_be_activated(room: Room) -> None:
    mill(room)
    page = PresetTable(room.desk)
    page.activate_preset()
    assert "PRESET 1 IS NOT SET" in room.desk.prompt_notice
    assert room.desk.offset_book.active_preset == 0


# --- what the interpreter counts with -------------------------------------------------------------------


def test_setup_has_lengths_names_and_active_preset_of_tables() -> None:
    plain = create_power_up_setup(load_named_machine("ac-table-mill"), tool_offsets={}, secondary_offsets={})
    tools = {5: MillToolRow("Mill 12", length=80.0, radius=6.0, dl=-0.1, dr=0.02, point=118.0)}
    made = add_mill_offsets(plain, MillOffsets(tools, {3: PresetRow(1.0, 2.0, 3.0, 15.0)}, 3))
    assert (made.tools[5].z, made.tools[5].nose_radius) == pytest.approx((79.9, 6.02))
    assert (made.tool_names, made.mill_tools[5].point_angle_deg, made.preset) == ({"MILL 12": 5}, 118.0, 3)
    assert made.kinematics is not None
    assert (made.kinematics.origin, made.kinematics.basic_rotation_deg) == ((1.0, 2.0, 3.0), 15.0)
    assert made.presets[0].origin == (230.0, 210.0, -350.0)  # of the machine file


def test_setup_has_only_tools_of_mill_tool_table() -> None:
    """A store may have rows of a lathe: their Z counted as lengths while the tool table showed 0."""
    plain = create_power_up_setup(
        load_named_machine("ac-table-mill"), tool_offsets={20: ToolOffset(z=76.2)}, secondary_offsets={}
    )
    made = add_mill_offsets(plain, MillOffsets({5: MillToolRow(length=80.0)}))
    assert {number: tool.z for number, tool in made.tools.items()} == {5: 80.0}


def test_tools_of_offsets_file_are_read_only_in_tool_table(tmp_path: Path) -> None:
    file = tmp_path / "tools.toml"
    file.write_text('[tool.20]\nz = 3.0\nnose_radius = 0.25\nwear_z = -0.01\nremark = "Mill"\n')
    offsets = read_offsets_file(file)
    book = create_offset_book(lambda: offsets, None)
    shown, counts = (
        book.mill_tools[20],
        create_setup_with_offsets(load_named_machine("ac-table-mill"), offsets).tools[20],
    )
    assert (shown.name, shown.length, shown.radius) == ("Mill", pytest.approx(75.946), pytest.approx(6.35))
    assert (counts.z, counts.nose_radius) == (shown.length, shown.radius)
    assert "READ-ONLY" in book.change_fields(OffsetKind.MILL_TOOL, 20, {"length": 1.0}, "typed")


def test_mill_offsets_do_not_change_lathe_setup_or_use_missing_preset() -> None:
    lathe = create_power_up_setup(load_named_machine("gt75"), tool_offsets={}, secondary_offsets={})
    assert add_mill_offsets(lathe, MillOffsets({5: MillToolRow(length=1.0)})) is lathe
    plain = create_power_up_setup(load_named_machine("ac-table-mill"), tool_offsets={}, secondary_offsets={})
    made = add_mill_offsets(plain, MillOffsets({}, {}, 7))
    assert made.preset == 0
    assert made.kinematics == plain.kinematics
