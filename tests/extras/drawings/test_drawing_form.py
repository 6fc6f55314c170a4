"""The form of a drawing: picked by key and by pointer, tried, written as shapes; and what it refuses."""

from __future__ import annotations

import re
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from app.desk.background_work import ProgressCallback, WorkAbandonedError
from app.extras.drawings.drawing_form import AdditionalDrawingForm, DrawingForm
from app.extras.drawings.drawing_plan import DrawingPlanner
from app.extras.drawings.drawings_setup import run_drawing_trial
from app.extras.shapes.shapes_model import ShapesModel
from app.screen.screen_theme import set_language
from core.extras.drawings.drawing import Drawing
from core.extras.drawings.drawing_file import read_drawing
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from tests.extras.drawings.hand import TOOLS, chain, dxf
from tests.extras.shapes.hand import machine
from tests.texts import pattern, text

STEP = ((0, 0), (0, 4), (-10, 4), (-10, 6), (-20, 6), (-20, 0))


class Desk:
    """Shapes beside a folder with drawings."""

    def __init__(self, folder: Path, *, metric: bool = True) -> None:
        shop = ShopData(tools=TOOLS)
        self.shapes = ShapesModel(lambda: shop, ProgramSettings(metric=metric))
        self.shapes.shop_data = shop
        self.drawing = AdditionalDrawingForm(
            lambda: {path.name: path for path in sorted(folder.glob("*.*"))},
            lambda text, plan, watch: run_drawing_trial(machine(), lambda: TOOLS, text, plan, watch),
        )
        self.shapes.additional_forms = (self.drawing,)

    def open(self, text: str = "") -> DrawingForm:
        assert self.shapes.open_program_text("x.nc", text, 1) == ""
        self.shapes.worker.wait_for_results(60.0)
        while self.shapes.form is not None:  # that of the piece at the cursor
            self.shapes.handle_escape()
        self.strike("x")
        form = self.shapes.form
        assert isinstance(form, DrawingForm)
        return form

    def strike(self, *keys: str) -> None:
        for key in keys:
            assert self.shapes.handle_key(key), key
        self.settle()

    def settle(self) -> None:
        self.drawing.plan_worker.wait_for_results(60.0)
        self.drawing.trial_worker.wait_for_results(60.0)


@pytest.fixture
def desk(tmp_path: Path) -> Any:
    made = Desk(tmp_path)
    yield made
    made.shapes.close()


def test_unit_and_layer_are_translated_to_spanish_but_layer_names_are_not(desk: Desk, tmp_path: Path) -> None:
    dxf(tmp_path / "step.dxf", chain(*STEP))
    form = desk.open()
    unit, layer = (next(each for each in form.fields if each.name == word) for word in ("DUNIT", "LAYER"))
    set_language("es")
    try:
        assert form.get_display_text(layer) == "TODAS"
        form.entered_texts = {"DUNIT": "INCH", "LAYER": "OUTSIDE"}
        assert form.get_display_text(unit) == "PULGADAS"
        assert form.get_display_text(layer) == "OUTSIDE"
        form.entered_texts = {"LAYER": "NO COUNT is on"}
        assert form.get_display_text(layer) == "NO COUNT is on"
    finally:
        set_language("en")


def test_drawing_becomes_shapes_that_can_be_reopened(desk: Desk, tmp_path: Path) -> None:
    dxf(tmp_path / "step.dxf", chain(*STEP))
    form = desk.open()
    assert not form.error_texts
    assert form.remarks[0] == "secondary offset 1 must have X -.8 (diameter), Z -.4, R .4 mm"
    assert any("remains in the corner at Z -9.975" in each for each in form.remarks)
    desk.shapes.write_form()
    assert [each.shape_instance.shape.name for each in desk.shapes.shape_pieces] == ["HEAD", "FACE", "TURN"]
    assert all(each.edited_line < 0 for each in desk.shapes.shape_pieces)
    assert "X12\n" in desk.shapes.text


def test_contour_and_axis_are_picked_with_the_pointer(desk: Desk, tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        chain(*STEP)(space)
        space.add_lwpolyline([(0, 12), (-6, 12), (-6, 15), (0, 15)], close=True)
        space.add_line((-30, -3), (30, -3))

    dxf(tmp_path / "two.dxf", draw)
    form = desk.open()
    desk.shapes.handle_touch((-3.0, 14.0))
    desk.settle()
    assert form.get_value_text(form.shape.fields[3]) == "2"
    desk.shapes.select_touched_field("CONTOUR 1")  # the number that stands on it
    desk.settle()
    assert form.filled_shape.get_text("CONTOUR") == "1"
    form.select_field_by_name("AXIS")
    desk.shapes.handle_touch((20.0, -3.1))  # the line of no other end, drawn last
    desk.settle()
    assert form.filled_shape.get_text("AXIS") == "LINE 10"
    assert form.drawing_plan is not None
    assert form.drawing_plan.profile is not None
    assert max(each.bounding_box[1] for each in form.drawing_plan.profile.elements) == pytest.approx(
        9.0
    )  # 6 above Y 0


def test_contour_and_side_are_picked_with_keys(desk: Desk, tmp_path: Path) -> None:
    """Down to the side of the face, Right: the face is at the left."""
    dxf(tmp_path / "step.dxf", chain(*STEP))
    form = desk.open()
    form.select_field_by_name("FRONT")
    desk.strike("Right")
    assert form.filled_shape.get_text("FRONT") == "LEFT"
    form.select_field_by_name("ROUGH")
    desk.strike("0")
    assert not any("G75" in line for line in form.program_lines)


@pytest.mark.parametrize("number", ["²", "①", "-1", "2"])
def test_unknown_contour_number_is_an_error_of_its_field(desk: Desk, tmp_path: Path, number: str) -> None:
    dxf(tmp_path / "step.dxf", chain(*STEP))
    form = desk.open()
    desk.shapes.select_touched_field(f"CONTOUR {number}")
    desk.settle()
    assert "has 1 contours: choose 1 to 1." in form.error_texts["CONTOUR"]
    assert form.filled_shape.get_text("CONTOUR") == number
    form.show_trial_result(None, ())
    assert not form.program_lines


def test_second_program_head_is_not_written_after_a_program(desk: Desk, tmp_path: Path) -> None:
    dxf(tmp_path / "step.dxf", chain(*STEP))
    form = desk.open("G90G94F7620G71G72(HEAD METRIC UNIT DIAMETER WORDS)\nM30\n")
    assert form.program_lines[0].startswith("T1(FACE")


def test_error_is_shown_at_its_field(desk: Desk, tmp_path: Path) -> None:
    dxf(tmp_path / "a.dxf", chain(*STEP), unit=0)
    (tmp_path / "b.dxf").write_text("no drawing")
    form = desk.open()
    assert form.error_texts["DUNIT"] == text("shapes.no-unit", file="a.dxf")
    form.select_field_by_name("DUNIT")
    desk.strike("M")
    assert not form.error_texts
    form.select_field_by_name("SIDE")
    desk.strike("Right")
    assert "no bore" in form.error_texts["CONTOUR"]
    form.select_field_by_name("FILE")
    desk.strike("Right")
    assert "damaged" in form.error_texts["FILE"]
    desk.shapes.write_form()
    assert desk.shapes.form is form  # nothing is written


def test_drawing_that_gives_an_invalid_program_is_not_written(desk: Desk, tmp_path: Path) -> None:
    dxf(tmp_path / "a.dxf", chain(*STEP))
    form = desk.open()
    form.select_field_by_name("FROM")
    desk.strike("5")
    assert re.search(pattern("shapes.outside-stock", stock="5"), form.current_error)
    assert not form.program_lines


def test_form_without_a_drawing_says_where_to_put_one(desk: Desk) -> None:
    assert text("shapes.no-drawing") in desk.open().current_error


class Reading:
    """Reading that goes on until it is canceled, or let go."""

    def __init__(self) -> None:
        self.begun, self.free, self.canceled = Event(), Event(), Event()

    def __call__(self, path: Path, watch: ProgressCallback) -> Drawing:
        self.begun.set()
        try:
            while not self.free.wait(0.01):
                watch(7.4)
        except WorkAbandonedError:
            self.canceled.set()
            raise
        return read_drawing(path)


@pytest.fixture
def reading(desk: Desk, tmp_path: Path) -> Reading:
    """The form of a drawing is open, and its file is being read."""
    dxf(tmp_path / "a.dxf", chain(*STEP))
    found = Reading()
    desk.drawing.planner = DrawingPlanner(found)
    desk.shapes.open_program_text("x.nc", "", 1)
    desk.shapes.handle_key("x")
    assert found.begun.wait(60.0)
    return found


def test_nothing_is_written_before_the_drawing_is_read(desk: Desk, reading: Reading) -> None:
    while desk.drawing.plan_worker.progress_count < 7:
        pass
    assert desk.shapes.prompt_text() == text("shapes.being-read", seconds=7)
    desk.shapes.write_form()
    assert desk.shapes.text == ""
    reading.free.set()
    desk.settle()
    assert desk.shapes.form is not None
    assert desk.shapes.form.program_lines


@pytest.mark.parametrize("how", ["F6", "Esc"])
def test_reading_can_be_canceled_and_restarted(desk: Desk, reading: Reading, how: str) -> None:
    shapes = desk.shapes
    if how == "Esc":
        assert shapes.handle_escape()
    else:
        shapes.make_function_keys()[6].action()
    assert reading.canceled.wait(60.0)
    desk.settle()
    assert isinstance(shapes.form, DrawingForm)
    assert shapes.prompt_text() == text("shapes.reading-canceled")
    assert not shapes.form.is_calculating
    shapes.write_form()
    assert shapes.text == ""  # there is nothing to write
    reading.free.set()
    shapes.make_function_keys()[6].action()
    desk.settle()
    assert not shapes.form.error_texts
    assert shapes.form.program_lines
    assert shapes.make_function_keys().get(6) is None


def test_closing_the_page_cancels_the_reading(desk: Desk, reading: Reading) -> None:
    desk.shapes.close()
    assert reading.canceled.wait(60.0)


def test_a_second_escape_leaves_the_form(desk: Desk, reading: Reading) -> None:
    assert desk.shapes.handle_escape()
    assert desk.shapes.form is not None
    assert desk.shapes.handle_escape()
    assert desk.shapes.form is None
