"""Picture of a touch-off on the Jog page: it follows the typed digits and shows what must be confirmed.

The slide is at home, so the tip of T1 with the offset X -.601 is at a radius of .601 in: Ø 1.202.
"""

from __future__ import annotations

import pytest
from PySide6.QtCore import QRect

from app.desk.screen_settings import DisplayUnits
from app.jog.touch_off_picture import TouchOffPicture
from app.jog.touch_off_scene import TouchedSurface
from app.offsets.offset_values import UnitMode
from app.screen.color_palettes import LIGHT_PALETTE
from app.screen.text_sizes import ScreenResolution
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import MachineState
from tests.screen.jog.bench import INCH, JogBench, Key
from tests.screen.jog.test_questioned_offsets import given
from tests.screen.jog.test_setter import ABOVE, choose, hold, put
from tests.screen.jog.test_skim_cut import cut, goes, spindle, step
from tests.texts import shows, text

Values = dict[str, float | int | str | bool]
SHAPES: dict[str, tuple[Values, Values]] = {
    "turning": ({"quadrant": 3}, {"kind": "turning", "insert": "CNMG432", "holder": "MCLNR-124B"}),
    "left": ({"quadrant": 4}, {"kind": "turning", "hand": "left", "insert": "DNMG432"}),
    "boring": ({"quadrant": 2}, {"kind": "boring", "diameter": 12.0}),
    "drill": ({"quadrant": 7}, {"kind": "drill", "diameter": 8.0}),
    "cutoff": ({"quadrant": 4}, {"kind": "parting", "width": 3.0}),
    "rear": ({"quadrant": 2}, {"kind": "turning", "rear": True}),
    "wrong tip": ({"quadrant": 3}, {"kind": "boring", "diameter": 12.0}),  # points to the axis at X+
}


def shaped(jog: JogBench, kind: str, *, x: float = -0.601 * INCH) -> None:
    """T1 has an offset and a stored shape, and is chosen."""
    offset, shape = SHAPES[kind]
    jog.store.offsets.tool_offsets.change_row(1, "set", {**offset, "x": x, "z": -50.0})
    jog.store.offsets.tool_shapes.change_row(1, "set", shape).result(60)
    jog.desk.offset_book.read_store()
    choose(jog, 1)


def picture(jog: JogBench) -> TouchOffPicture:
    jog.run(0.02)
    shown = jog.page.model.touch_off_pictures.picture
    assert shown is not None
    return shown


def has_picture(jog: JogBench) -> bool:
    jog.run(0.02)
    return jog.page.model.touch_off_pictures.picture is not None


def test_picture_follows_the_typed_digits(jog: JogBench) -> None:
    given(jog)
    jog.type("x")
    assert picture(jog).new_text == "Ø ?"
    assert picture(jog).scene.new_tip is None
    jog.type("1.2")
    shown = picture(jog)
    assert shown.new_text == "Ø 1.20000"
    assert shown.size_texts == ("Ø 1.20000", "R 0.60000")
    assert shown.old_text == "Ø 1.20200"
    assert shown.size_change_text == "Ø −0.00200"
    assert shown.unit_text == ""
    assert shown.warning_text == ""
    assert shown.scene.new_tip == (0.0, pytest.approx(0.6 * INCH))
    assert shown.scene.old_tip == (0.0, pytest.approx(0.601 * INCH))
    jog.key(Key.Key_Backspace)
    assert picture(jog).scene.new_tip == (0.0, pytest.approx(0.5 * INCH))  # 1.


def test_dimension_has_the_radius_also_if_the_control_uses_diameters(jog: JogBench) -> None:
    given(jog)
    jog.type("x1.2")
    model = jog.page.model
    model.tool_setting.offset_history.unit_mode = UnitMode(is_diameter=True)
    model.touch_off_pictures.update()
    assert model.touch_off_pictures.picture is not None
    assert model.touch_off_pictures.picture.size_texts == ("Ø 1.20000", "R 0.60000")


def test_sizes_have_their_unit_if_the_positions_have_another(jog: JogBench) -> None:
    given(jog)
    jog.desk.settings_store.choose("units", DisplayUnits.METRIC.value)
    jog.type("x1.2")
    assert picture(jog).unit_text == "INCH"
    assert picture(jog).new_text == "Ø 1.20000"
    jog.desk.settings_store.choose("units", DisplayUnits.INCH.value)
    assert picture(jog).unit_text == ""
    jog.desk.settings_store.choose("units", DisplayUnits.PROGRAM.value)


def test_unchanged_entry_is_not_drawn_again(jog: JogBench) -> None:
    given(jog)
    jog.type("x1.2")
    before = picture(jog)
    assert picture(jog) is before


def test_picture_of_a_face_shows_the_entered_position(jog: JogBench) -> None:
    shaped(jog, "cutoff")
    jog.type("z1.97")
    shown = picture(jog)
    assert shown.scene.surface is TouchedSurface.FACE
    assert shown.new_text == "Z 1.97000"
    assert shown.old_text == "Z 1.96850"  # 50 mm
    assert shown.note_text == ""


@pytest.mark.parametrize(
    ("kind", "entry", "surface"),
    [
        ("turning", "1.2", TouchedSurface.OUTSIDE_DIAMETER),
        ("left", "1.2", TouchedSurface.OUTSIDE_DIAMETER),
        ("boring", "1.2", TouchedSurface.BORE),
        ("drill", "0", TouchedSurface.CENTERLINE),
        ("cutoff", "1.2", TouchedSurface.OUTSIDE_DIAMETER),
    ],
)
def test_each_kind_of_tool_is_shown_at_its_surface(
    jog: JogBench, kind: str, entry: str, surface: TouchedSurface
) -> None:
    shaped(jog, kind, x=0.0 if kind == "drill" else -0.601 * INCH)
    jog.type(f"x{entry}")
    assert picture(jog).scene.surface is surface
    assert picture(jog).warning_text == ""
    jog.window.grab()


def test_tool_at_negative_x_is_shown_there_without_a_warning(jog: JogBench) -> None:
    shaped(jog, "rear", x=0.601 * INCH)
    jog.type("x-1.2")
    assert picture(jog).warning_text == ""
    assert picture(jog).scene.new_tip == (0.0, pytest.approx(-0.6 * INCH))


def test_tool_without_shape_is_marked_as_example(jog: JogBench) -> None:
    given(jog)
    jog.type("x1.2")
    assert picture(jog).note_text


def without_shape(jog: JogBench, quadrant: int, old_diameter: float) -> None:
    """T1 has an offset and no stored shape, and is chosen. Its old diameter is in inches."""
    values: Values = {"quadrant": quadrant, "x": -old_diameter / 2 * INCH, "z": -50.0}
    jog.store.offsets.tool_offsets.change_row(1, "set", values).result(60)
    jog.desk.offset_book.read_store()
    choose(jog, 1)


def test_right_diameter_after_a_wrong_sign_shows_an_outside_tool(jog: JogBench) -> None:
    without_shape(jog, quadrant=3, old_diameter=-1.202)
    jog.type("x1.2")
    shown = picture(jog)
    assert shown.scene.surface is TouchedSurface.OUTSIDE_DIAMETER
    assert shown.scene.touched_edge is not None
    assert shown.scene.touched_edge[0][1] == pytest.approx(0.6 * INCH)
    assert shown.note_text == text("jog.example-tool")


def test_face_cut_past_the_center_shows_no_boring_bar(jog: JogBench) -> None:
    without_shape(jog, quadrant=3, old_diameter=-0.010)
    jog.type("z1.97")
    scene = picture(jog).scene
    assert len(scene.part_outlines) == 1  # solid, without a bore
    assert scene.new_tip is not None
    assert scene.new_tip[1] > 0.0


@pytest.mark.parametrize("old_diameter", [1.202, -1.202])
def test_tool_without_quadrant_has_a_neutral_title(jog: JogBench, old_diameter: float) -> None:
    without_shape(jog, quadrant=0, old_diameter=old_diameter)
    jog.type("x1.2")
    assert picture(jog).title == text("jog.unknown-side")
    assert picture(jog).note_text == text("jog.tip-not-set")


def test_drill_beside_the_center_touches_no_diameter(jog: JogBench) -> None:
    shaped(jog, "drill", x=0.0)
    jog.type("x.1")
    assert picture(jog).title == text("jog.no-diameter")


def test_skim_cut_shows_the_cut_surface_at_the_size_question(jog: JogBench) -> None:
    cut(jog)
    goes(jog, Key.Key_Right)
    jog.type("0")
    jog.until(lambda: jog.page.model.tool_setting.question_name != "")
    jog.type(".5")
    radii = {abs(x) for each in picture(jog).scene.part_outlines for _z, x in each}
    assert min(radii) == pytest.approx(0.25 * INCH)
    assert len(radii) == 2  # the step of the cut
    assert jog.page.tool_panel.isVisible()  # and not the manual functions with which the spindle was started
    jog.key(Key.Key_Escape)
    step(jog)
    assert not has_picture(jog)
    assert jog.page.manual_panel.isVisible()


# --- what must be confirmed ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "entry", "reason"),
    [
        ("turning", "-1.2", "offsets.doubt-side"),
        ("turning", ".6", "offsets.doubt-radius"),
        ("turning", "2.404", "offsets.doubt-double"),
        ("turning", "1.1", "offsets.doubt-large"),  # .0505 in on the radius
        ("boring", "-1.2", "offsets.doubt-side"),
        ("wrong tip", ".6", "offsets.doubt-radius"),
        ("wrong tip", "2.2", "offsets.doubt-large"),  # .499 in on the radius
        ("wrong tip", "12", "offsets.doubt-travel"),  # part zero at X -6, and X- ends at -4
        ("wrong tip", "20", "offsets.doubt-travel"),
    ],
)
def test_wrong_entry_is_shown_and_asked_before_it_is_saved(
    jog: JogBench, kind: str, entry: str, reason: str
) -> None:
    shaped(jog, kind)
    before = jog.store.offsets.tool_offsets.read_rows()
    jog.type(f"x{entry}")
    assert picture(jog).warning_text == text(reason)
    jog.key(Key.Key_Return)
    jog.saved()
    assert jog.desk.confirmation_key
    assert shows(jog.prompt, reason)
    assert picture(jog).warning_text == text(reason)  # the picture remains until the answer
    assert jog.store.offsets.tool_offsets.read_rows() == before
    jog.key(Key.Key_N)
    jog.saved()
    assert not has_picture(jog)
    assert jog.store.offsets.tool_offsets.read_rows() == before


@pytest.mark.parametrize("entry", ["1.202", "1.2"])
def test_wrong_tip_quadrant_is_noted_and_not_asked(jog: JogBench, entry: str) -> None:
    shaped(jog, "wrong tip")
    jog.type(f"x{entry}")
    assert picture(jog).warning_text == ""
    assert picture(jog).note_text == text("jog.wrong-tip")
    jog.key(Key.Key_Return)
    jog.saved()
    assert not jog.desk.confirmation_key
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-float(entry) / 2 * INCH)


def test_largest_error_is_asked_first(jog: JogBench) -> None:
    """Ø 12 is twice the old Ø 6, but part zero would be at X -6 in, and the travel ends at -4 in."""
    shaped(jog, "turning", x=-3.0 * INCH)
    jog.type("x12")
    assert picture(jog).warning_text == text("offsets.doubt-travel")
    jog.key(Key.Key_Return)
    jog.saved()
    assert shows(jog.prompt, "offsets.doubt-travel")
    assert not shows(jog.prompt, "offsets.doubt-double")


def test_warning_names_the_following_tool_that_leaves_the_travel(jog: JogBench) -> None:
    """T2 at X -3.99 in follows T1 by .014 in. Its travel ends at -4 in."""
    given(jog)
    jog.store.offsets.tool_offsets.change_row(2, "set", {"x": -3.99 * INCH})
    jog.store.offsets.tool_offsets.set_master_tool(1, "master").result(60)
    jog.desk.offset_book.read_store()
    jog.type("x1.23")
    assert picture(jog).warning_text == f"T2: {text('offsets.doubt-travel')}"


@pytest.mark.parametrize("key", [Key.Key_F4, Key.Key_M])
def test_other_question_removes_the_picture(jog: JogBench, key: Key) -> None:
    given(jog)
    jog.type("x-1.2")
    jog.key(Key.Key_Return)
    assert has_picture(jog)
    jog.key(key)
    assert jog.desk.confirmation_key
    assert not has_picture(jog)


def test_warning_waits_until_the_operator_stops_typing(jog: JogBench) -> None:
    """Ø 1 on the way to 1.2 is .101 in on the radius from the old offset."""
    shaped(jog, "turning")
    jog.type("x1")
    jog.run(0.6)
    assert picture(jog).warning_text == text("offsets.doubt-large")
    assert picture(jog).shown_warning == ""
    jog.run(0.1)
    assert picture(jog).shown_warning == text("offsets.doubt-large")
    jog.type(".2")
    assert picture(jog).shown_warning == ""
    jog.run(0.8)
    assert picture(jog).shown_warning == ""


def test_enter_shows_the_warning_at_once(jog: JogBench) -> None:
    shaped(jog, "turning")
    jog.type("x-1.2")
    assert picture(jog).shown_warning == ""
    jog.key(Key.Key_Return)
    assert picture(jog).shown_warning == text("offsets.doubt-side")


def test_new_tool_at_wrong_side_is_shown_at_once(jog: JogBench) -> None:
    choose(jog, 5)
    jog.type("x-.5")
    assert picture(jog).warning_text == text("offsets.doubt-side")
    assert picture(jog).old_text == "not set"


@pytest.mark.parametrize("entry", ["", "1.2+", "-", "1/0", "99999"])
def test_invalid_entry_shows_no_new_tool(jog: JogBench, entry: str) -> None:
    given(jog)
    jog.type(f"x{entry}")
    assert picture(jog).scene.new_tip is None
    assert picture(jog).new_text == "Ø ?"
    assert picture(jog).warning_text == ""


def test_escape_removes_the_picture_and_shows_the_fields_again(jog: JogBench) -> None:
    given(jog)
    jog.type("x1.2")
    assert has_picture(jog)
    jog.key(Key.Key_Escape)
    assert not has_picture(jog)
    jog.page.tool_panel.grab()
    assert len(jog.page.tool_panel.list_targets()) == 10  # tool, tip and eight fields


def test_other_questions_have_no_picture(jog: JogBench) -> None:
    given(jog)
    for key in "nwqk":
        jog.type(key)
        assert not has_picture(jog)
        jog.key(Key.Key_Escape)


def test_measurement_of_the_tool_setter_has_no_picture(setter: JogBench) -> None:
    choose(setter, 3)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    hold(setter, Key.Key_Up)
    assert setter.page.model.tool_setting.is_tool_setter_result
    assert not has_picture(setter)


def test_turning_spindle_keeps_the_stop_key_of_the_manual_functions(jog: JogBench) -> None:
    spindle(jog)
    choose(jog, 1)
    jog.type("x1")
    assert has_picture(jog)
    assert jog.shot.state is MachineState.IDLE
    assert jog.page.manual_panel.isVisible()
    assert not jog.page.tool_panel.isVisible()


def test_digit_keys_of_the_manual_functions_are_hidden_while_they_type(jog: JogBench) -> None:
    """Key 0 types a digit during an entry, so the key of SPINDLE STOP is only a touch target then."""
    panel = jog.page.manual_panel
    spindle(jog)
    choose(jog, 1)
    assert {"0", "1", "2"} <= {shown for _box, shown in panel.read_painted_texts()}
    jog.type("x1")
    jog.run(0.02)
    panel.grab()
    assert not any(shown.isdigit() for _box, shown in panel.read_painted_texts())
    jog.type("0")
    assert jog.page.model.tool_setting.text == "10"
    assert jog.shot.rpm_actual > 190.0
    jog.key(Key.Key_Escape)
    jog.run(0.02)
    panel.grab()
    assert "0" in {shown for _box, shown in panel.read_painted_texts()}
    jog.type("0")
    jog.until(lambda: jog.shot.rpm_actual < 1.0)


# --- layout ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize(
    ("size", "resolution"),
    [((1024, 600), 4.61), ((1280, 800), 4.9), ((1920, 1080), 5.6), ((3840, 2160), 6.4), ((1080, 1920), 5.6)],
)
def test_picture_covers_neither_position_nor_keys(
    jog: JogBench, size: tuple[int, int], resolution: float, language: str
) -> None:
    jog.desk.settings_store.choose("language", language)
    jog.window.theme.set_palette(LIGHT_PALETTE)
    jog.window.resize(*size)
    jog.window.theme.screen = ScreenResolution(resolution)
    jog.frame.arrange_parts()
    shaped(jog, "turning")
    jog.type("x-1.2")
    jog.run(0.8)
    assert picture(jog).shown_warning
    page = jog.page
    panel = page.tool_panel
    assert panel.isVisible()
    for other in (page.number_pad, page.entry_panel):
        assert other.isVisible()
        assert not panel.geometry().intersects(other.geometry())
    assert QRect(0, 0, page.width(), page.height()).contains(panel.geometry())
    panel.grab()
    assert all(min(each.box.width(), each.box.height()) >= FINGERTIP_PX for each in panel.list_targets())
    texts = panel.read_painted_texts()
    assert all(panel.find_full_area().contains(box) for box, _text in texts)
    drawing = [box for box, shown in texts if shown.startswith("Ø −1.2")]
    assert len(drawing) == 2  # the new size, and the dimension in the drawing
    jog.desk.settings_store.choose("language", "en")
