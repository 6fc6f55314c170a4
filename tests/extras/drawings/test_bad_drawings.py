"""Drawings that no contour can be taken from: each is refused by one clear sentence, none by a traceback."""

from __future__ import annotations

import errno
import math
from pathlib import Path
from typing import Any

import pytest

from core.extras.drawings.drawing import MAX_DRAWING_BYTES, DrawingError
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_placement import ContourSide
from core.extras.drawings.turning_contour import ToolAngleLimits, make_turning_contour
from tests.coded import raises_code
from tests.extras.drawings.hand import Draw, chain, dxf, profile_of


def refused(path: Path, **how: Any) -> DrawingError:
    """Return the error of a drawing; its text is one line that names the file."""
    with pytest.raises(DrawingError) as told:
        profile_of(path, **how)
    text = str(told.value)
    assert path.name in text
    assert text.endswith(".")
    assert "\n" not in text
    return told.value


def box(space: Any) -> None:
    space.add_3dface([(0, 0, 0), (1, 0, 0), (1, 1, 5), (0, 1, 5)])


def wire(space: Any) -> None:
    space.add_line((0, 0, 0), (10, 0, 4))


def tilted(space: Any) -> None:
    space.add_circle((0, 0), 5, dxfattribs={"extrusion": (0, 1, 0)})


def words(space: Any) -> None:
    space.add_text("M8", height=2)


@pytest.mark.parametrize(
    ("draw", "code", "value"),
    [
        (lambda _space: None, "nothing-drawn", ""),
        (words, "nothing-drawn", "TEXT"),
        (box, "three-dimensional", ""),
        (wire, "three-dimensional", ""),
        (tilted, "three-dimensional", ""),
    ],
)
def test_drawing_without_a_contour_is_rejected(tmp_path: Path, draw: Draw, code: str, value: str) -> None:
    error = refused(dxf(tmp_path / "x.dxf", draw))
    assert error.code == code
    assert value in str(error)


def test_self_crossing_contour_is_rejected(tmp_path: Path) -> None:
    """The second line runs back through the first wall, 10 behind the face at a diameter of 10."""
    path = dxf(
        tmp_path / "x.dxf", chain((0, 4), (-10, 4), (-10, 8), (-14, 8), (-14, 5), (-6, 5), (-6, 9), (-20, 9))
    )
    error = refused(path, axis="Y 0")
    assert (error.code, str(error).count("10.000 mm")) == ("crosses-itself", 2)


def test_contour_crossing_the_axis_is_rejected(tmp_path: Path) -> None:
    """Down through the axis 10 behind the face, and up again."""
    path = dxf(tmp_path / "x.dxf", chain((0, 0), (0, 4), (-8, 4), (-12, -4), (-16, 4), (-20, 4)))
    error = refused(path, axis="Y 0")
    assert (error.code, str(error).count("10.000 mm")) == ("crosses-axis", 1)


def test_inside_of_a_contour_without_a_bore_is_rejected(tmp_path: Path) -> None:
    path = dxf(tmp_path / "x.dxf", chain((0, 0), (0, 4), (-8, 4), (-8, 0)))
    assert refused(path, side=ContourSide.INSIDE).code == "no-bore"


def test_invalid_axis_is_rejected(tmp_path: Path) -> None:
    path = dxf(tmp_path / "x.dxf", chain((0, 0), (0, 4), (-8, 4, 1), (-8, 0)))
    axis, line, arc = (refused(path, axis=name) for name in ("Z 0", "LINE 9", "LINE 3"))
    assert [each.code for each in (axis, line, arc)] == ["no-axis", "no-line", "axis-is-arc"]
    assert [value in str(each) for each, value in ((axis, "Y 0"), (line, "9"), (arc, "3"))] == [True] * 3


@pytest.mark.parametrize("name", ["LINE ²", "LINE ①", "LINE -1", "LINE 1.5", "LINE ", "LINE"])
def test_axis_without_a_line_number_is_rejected(tmp_path: Path, name: str) -> None:
    """The signs ² and ① are digits, but not numbers."""
    path = dxf(tmp_path / "x.dxf", chain((0, 0), (0, 4), (-8, 4, 1), (-8, 0)))
    error = refused(path, axis=name)
    assert (error.code, name in str(error)) == ("no-axis", True)


def test_face_alone_has_nothing_to_turn(tmp_path: Path) -> None:
    chosen = profile_of(dxf(tmp_path / "x.dxf", chain((0, 0), (0, 4))), axis="Y 0")
    with raises_code(DrawingError, "nothing-to-turn"):
        make_turning_contour(chosen, ToolAngleLimits())


def test_tool_leaning_into_a_shoulder_is_rejected(tmp_path: Path) -> None:
    chosen = profile_of(dxf(tmp_path / "x.dxf", chain((0, 0), (0, 4), (-8, 4), (-8, 6), (-12, 6), (-12, 0))))
    with raises_code(DrawingError, "too-steep", "72", "90"):
        make_turning_contour(chosen, ToolAngleLimits(math.radians(70), math.radians(72.5)))


# --- files


def test_empty_huge_missing_and_foreign_files_are_rejected(tmp_path: Path) -> None:
    empty, huge = tmp_path / "empty.dxf", tmp_path / "huge.dxf"
    empty.touch()
    with huge.open("wb") as file:
        file.truncate(100_000_000)
    assert refused(empty).code == "empty"
    error = refused(huge)
    assert error.code == "too-large"
    assert f"{MAX_DRAWING_BYTES >> 20} MB" in str(error)
    assert refused(tmp_path / "none.dxf").code == "unreadable"
    other, dwg = tmp_path / "part.step", tmp_path / "part.dxf"
    other.write_text("ISO-10303-21;")
    dwg.write_bytes(b"AC1027\0\0\0\0\0")
    assert refused(other).code == "not-a-drawing"
    assert refused(dwg).code == "dwg"


def test_damaged_files_load_or_raise_a_drawing_error(tmp_path: Path) -> None:
    """Cut off, or with a byte that is another one: a drawing or a sentence, never anything else."""
    whole = dxf(tmp_path / "whole.dxf", chain((0, 0), (0, 4), (-8, 4, 0.3), (-8, 0))).read_bytes()
    bad = tmp_path / "bad.dxf"
    for at in range(200, len(whole), len(whole) // 12):
        for data in (whole[:at], whole[:at] + b"\xff\x00" + whole[at:], whole[:at] + b"9" + whole[at + 1 :]):
            bad.write_bytes(data)
            try:
                read_drawing(bad)
            except DrawingError as error:
                assert "bad.dxf" in str(error)  # noqa: PT017 - or it is read


def test_file_truncated_in_its_lines_is_rejected_as_damaged(tmp_path: Path) -> None:
    whole = dxf(tmp_path / "whole.dxf", chain((0, 0), (0, 4), (-8, 4), (-8, 0))).read_text()
    bad = tmp_path / "bad.dxf"
    bad.write_text(whole[: whole.index("LWPOLYLINE") + 120])
    assert refused(bad).code == "damaged"


# --- blocks


def test_blocks_are_exploded(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        block = space.doc.blocks.new("PART")
        chain((0, 0), (0, 4), (-8, 4), (-8, 0))(block)
        space.add_blockref("PART", (10, 0), dxfattribs={"xscale": 2, "yscale": 2})

    chosen = profile_of(dxf(tmp_path / "b.dxf", draw))
    assert (chosen.front_z_mm, chosen.back_z_mm) == (0.0, -16.0)
    assert chosen.elements[0].end[0] == 8.0


def test_self_referencing_blocks_are_rejected(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        block = space.doc.blocks.new("PART")
        block.add_blockref("PART", (1, 0))
        space.add_blockref("PART", (0, 0))

    refused(dxf(tmp_path / "b.dxf", draw))


def test_hidden_or_switched_off_entities_are_ignored(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        space.doc.layers.add("OFF").off()
        space.doc.layers.add("ICE").freeze()
        for layer in ("OFF", "ICE"):
            space.add_line((0, 0), (9, 9), dxfattribs={"layer": layer})
        chain((0, 0), (0, 4), (-8, 4), (-8, 0))(space)

    assert read_drawing(dxf(tmp_path / "b.dxf", draw)).layers == ("0",)


def test_mirrored_arcs_and_polylines_are_read(tmp_path: Path) -> None:
    """As CAD leaves them when a half is mirrored: the plane turned over, x from right to left."""

    def draw(space: Any) -> None:
        over = {"extrusion": (0, 0, -1)}
        space.add_lwpolyline(
            [(0, 2, 0), (10, 2, math.tan(math.pi / 8)), (12, 4, 0)], format="xyb", dxfattribs=over
        )
        space.add_arc((12, 6), 2, 270, 360, dxfattribs=over)

    elements = profile_of(dxf(tmp_path / "m.dxf", draw), axis="Y 0").elements
    assert [each.end for each in elements] == [
        pytest.approx((2, -10)), pytest.approx((4, -12)), pytest.approx((6, -14)),
    ]  # fmt: skip
    assert [getattr(each, "clockwise", None) for each in elements] == [None, False, False]


@pytest.mark.parametrize(
    ("name", "reads"), [("part.dxf", "ezdxf.filemanagement.readfile"), ("part.svg", "svgelements.SVG.parse")]
)
@pytest.mark.parametrize(
    ("error", "code"),
    [
        (OSError(errno.EIO, "Input/output error"), "unreadable"),
        (MemoryError(), "out-of-memory"),
    ],
)
def test_disk_error_is_not_reported_as_a_damaged_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, reads: str, error: Exception, code: str
) -> None:
    def fails(*_args: object, **_named: object) -> None:
        raise error

    monkeypatch.setattr(reads, fails)
    path = tmp_path / name
    path.write_text("<svg></svg>")
    with raises_code(DrawingError, code, name):
        read_drawing(path)


def test_entity_of_an_unknown_kind_is_omitted_and_counted(tmp_path: Path) -> None:
    """Programs write kinds of their own; what has not even a layer is no line of a contour."""
    path = tmp_path / "own.dxf"
    lines = "0 SECTION 2 ENTITIES 0 OWNKIND 8 PART 0 LINE 8 PART 10 0 20 0 11 0 21 5 0 ENDSEC 0 EOF"
    path.write_text("\n".join(lines.split()) + "\n")
    drawing = read_drawing(path)
    assert len(drawing.elements) == 1
    assert drawing.omitted_object_counts == {"OWNKIND": 1}


@pytest.mark.parametrize(
    "element",
    [
        '<circle cx="5" cy="5" r="NaN"/>',
        '<rect x="nan" y="0" width="3" height="3"/>',
        '<path d="M0 0L10 nan"/>',
        '<line x1="0" y1="-Infinity" x2="3" y2="3"/>',
        '<polyline points="0,0 inf,5"/>',
    ],
)
def test_svg_dimension_that_is_not_a_number_is_rejected(tmp_path: Path, element: str) -> None:
    """svgelements would leave the element out, and a sound one beside it would be the whole drawing."""
    path = tmp_path / "x.svg"
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="9mm"><path d="M0 0L5 5L9 0"/>{element}</svg>'
    )
    assert refused(path).code == "no-number"


def test_names_in_svg_may_contain_nan(tmp_path: Path) -> None:
    path = tmp_path / "x.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><path id="nan" class="inf" d="M0 0L5 5L9 0"/></svg>'
    )
    assert len(read_drawing(path).elements) == 2
