"""The axis of a half profile that ends on it, and the place of damage in a DXF file."""

from __future__ import annotations

from pathlib import Path

import ezdxf.filemanagement
import pytest

from app.extras.drawings.drawing_plan import PlanRequest
from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_placement import find_axes, require_clear_axis, select_axis
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from tests.extras.drawings.hand import chain, dxf, planned, profile_of

# a shaft of 20 and 30 mm in diameter, whose half profile ends on its axis at Y 17
HALF = (0.0, 17.0), (0.0, 27.0), (-20.0, 27.0), (-20.0, 32.0), (-35.0, 32.0), (-35.0, 17.0)


def test_axis_through_both_ends_of_a_half_profile_can_be_chosen(tmp_path: Path) -> None:
    """From that axis, the largest radius is 32 - 17 = 15 mm; from Y 0, it would be 32 mm."""
    path = dxf(tmp_path / "half.dxf", chain(*HALF))
    names = [axis.name for axis in find_axes(read_drawing(path))]
    assert names[:2] == ["Y 0", "PROFILE ENDS"]
    profile = profile_of(path, axis="PROFILE ENDS")
    assert max(each.end[0] for each in profile.elements) == pytest.approx(15.0)
    profile = profile_of(path, axis="Y 0")
    assert max(each.end[0] for each in profile.elements) == pytest.approx(32.0)


def test_form_asks_for_the_axis_of_such_a_profile(tmp_path: Path) -> None:
    path = dxf(tmp_path / "half.dxf", chain(*HALF))
    setting = ProgramSettings(metric=True, shop=ShopData(travel_mm=(150.0, 200.0)))
    plan = planned(PlanRequest(path, {}, (), setting))
    assert "PROFILE ENDS" in plan.field_errors["AXIS"]
    for axis in ("PROFILE ENDS", "Y 0"):
        assert "AXIS" not in planned(PlanRequest(path, {"AXIS": axis}, (), setting)).field_errors


CLOSED = (*HALF, HALF[0])
ON_Y0 = tuple((x, y - 17.0) for x, y in HALF)
SLOPING = (*HALF[:-1], (-35.0, 18.0))
CROSSING = (*HALF[:3], (-20.0, 15.0), *HALF[4:])


@pytest.mark.parametrize("points", [CLOSED, ON_Y0, SLOPING, CROSSING])
def test_clear_axis_is_not_asked_for(points: tuple[tuple[float, float], ...], tmp_path: Path) -> None:
    """Closed, ending on Y 0, with ends at two heights, or on both sides of the line through its ends."""
    drawing = read_drawing(dxf(tmp_path / "x.dxf", chain(*points)))
    require_clear_axis(drawing)
    assert "PROFILE ENDS" not in [axis.name for axis in find_axes(drawing)]


def test_center_line_is_the_axis_without_a_question(tmp_path: Path) -> None:
    document = ezdxf.filemanagement.new("R2010", setup=True)
    space = document.modelspace()
    chain(*HALF)(space)
    space.add_line((5.0, 17.0), (-40.0, 17.0), dxfattribs={"linetype": "CENTER"})
    path = tmp_path / "center.dxf"
    document.saveas(path)
    drawing = read_drawing(path)
    require_clear_axis(drawing)
    assert select_axis(drawing, "").point[0] == 17.0


def saved(path: Path) -> str:
    """Return the text of a file with the contour in a block."""
    document = ezdxf.filemanagement.new("R2010")
    chain(*HALF)(document.blocks.new("SHAFT"))
    document.modelspace().add_blockref("SHAFT", (3.0, 0.0))
    document.saveas(path)
    return path.read_text()


def find_error(path: Path, text: str) -> str:
    path.write_text(text)
    with pytest.raises(DrawingError) as caught:
        read_drawing(path)
    assert caught.value.code == "damaged"
    return str(caught.value)


def test_block_is_part_of_the_drawing(tmp_path: Path) -> None:
    path = tmp_path / "x.dxf"
    saved(path)
    assert len(read_drawing(path).elements) == 5


def test_missing_block_is_named(tmp_path: Path) -> None:
    path = tmp_path / "x.dxf"
    text = saved(path)
    start = text.rindex("SHAFT\n", 0, text.index("OBJECTS"))  # the name in INSERT, not in BLOCKS
    said = find_error(path, f"{text[:start]}LOST\n{text[start + 6 :]}")
    assert "x.dxf" in said
    assert "block LOST" in said


def test_line_of_a_damaged_table_is_named(tmp_path: Path) -> None:
    """A group code is replaced by a word; the file is read in pairs of lines from the first line."""
    path = tmp_path / "x.dxf"
    lines = saved(path).splitlines(keepends=True)
    at = next(n for n, line in enumerate(lines) if line == "LAYER\n" and lines[n - 2] == "TABLE\n")
    lines[at - 1] = "xx\n"
    assert f"line {at}" in find_error(path, "".join(lines))


def test_file_that_ends_too_early_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "x.dxf"
    text = saved(path)
    assert "ends too early" in find_error(path, text[: text.index("ENTITIES\n") + 9])
