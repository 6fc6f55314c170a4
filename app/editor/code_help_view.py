"""Code help of the editor: meaning and sketch of the code at the cursor, and the list of codes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from app.desk.pages.code_help import CodeHelp
from app.desk.pages.table_content import WHOLE_LIST, FunctionKey
from app.editor.live_proof import LiveProof
from app.editor.text_view import ProgramTextField
from app.screen.code_choices_view import CodeChoiceList, draw_code_entry
from app.screen.drawings import SketchPanel
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from core.language.code_book import CodeBookEntry
from core.language.source import Dialect
from core.sketch import Dimension, Outline, Sketch, make_cut_outline, make_part_outline, make_sketch
from core.tool_edges import TIP_DIRECTIONS

Point = tuple[float, float]


def make_code_sketch(code: str, dialect: Dialect = Dialect.OMNITURN) -> Sketch | None:
    """Return the sketch of a lathe code, or None if the code has no sketch.

    In the sketch, Z points to the right and the radius axis points up.
    """
    return _CODE_SKETCHES.get(dialect, {}).get(code)


def _arc(centre: Point, radius: float, begin: float, end: float) -> tuple[Point, ...]:
    angles = [math.radians(begin + (end - begin) * k / 12) for k in range(13)]
    return tuple((centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles)


def _make_arc_sketch(text: str, *, convex: bool) -> Sketch:
    """Return the sketch of an arc from the face to the chuck.

    A convex arc is a rounded shoulder, and a concave arc is a filled corner.
    """
    corner = _arc((-4, 4), 4, 0, 90) if convex else _arc((0, 8), 4, 270, 180)
    solid = make_part_outline((0, 0), *corner, (-16, 8), (-16, 0))
    return make_sketch(
        solid,
        make_cut_outline(*corner),
        _make_arrow(corner[5], corner[7]),
        dimensions=(Dimension(text, (2, 10)),),
    )


def _make_arrow(a: Point, b: Point) -> Outline:
    """Return an arrow from ``a`` to ``b`` that shows the direction of tool motion."""
    angle = math.atan2(b[1] - a[1], b[0] - a[0])
    ends = [(b[0] - 1.4 * math.cos(angle + s), b[1] - 1.4 * math.sin(angle + s)) for s in (0.5, -0.5)]
    return Outline((ends[0], b, ends[1]), "tool")


def _make_roughing_sketch(deep: str, left: str, *points: str) -> Sketch:
    """Return the sketch of a roughing cycle.

    ``deep`` and ``left`` are the address words for the depth of cut and the finishing allowance. ``points``
    are the address words for the start and end points.
    """
    profile = ((0, 3), (-6, 3), (-9, 6), (-14, 6), (-14, 9))
    passes = [
        make_cut_outline((1, r), (z, r))
        for r, z in ((8.0, -13.7), (7.0, -13.7), (6.3, -9.0), (5.0, -7.7), (4.0, -6.7))
    ]
    solid = make_part_outline((0, 0), *profile, (-20, 9), (-20, 0))
    places = ((2.0, 10.0), (0.0, 3.0), (-14.0, 9.0))
    named = (Dimension(name, at) for name, at in zip(points, places, strict=False))
    return make_sketch(
        solid, *passes, dimensions=(Dimension(deep, (1.5, 7.5)), Dimension(left, (-11, 6.2)), *named)
    )


def _make_threading_sketch(lead: str, start: str, last: str, end: str) -> Sketch:
    """Return the sketch of a threading cycle.

    The parameters are the address words that label the lead, start, last pass and end.
    """
    teeth = [(-float(k), 7.0 if k % 2 else 5.6) for k in range(13)]
    depths = [
        make_cut_outline((3, 7.0 - 0.7 * math.sqrt(k)), (-12, 7.0 - 0.7 * math.sqrt(k))) for k in (1, 2, 3, 4)
    ]
    solid = make_part_outline((0, 0), *teeth, (-20, 7), (-20, 0))
    dims = (
        Dimension(lead, (-4, 8.4)),
        Dimension(start, (4, 6.5)),
        Dimension(last, (-14, 5)),
        Dimension(end, (-12, 9)),
    )
    return make_sketch(solid, *depths, dimensions=dims)


def _make_side_sketch(*, outside: bool) -> Sketch:
    """Return the sketch of a tool nose moving toward the chuck along an outside or inside contour."""
    solid = make_part_outline((0, 0), (0, 5), (-8, 5), (-12, 8), (-18, 8), (-18, 0))
    off = 1.2 if outside else -1.2
    path = make_cut_outline((2, 5 + off), (-8, 5 + off), (-12, 8 + off), (-18, 8 + off))
    nose = Outline(_arc((-4, 5 + off), 1.2, 0, 360), "tool", is_closed=True)
    return make_sketch(
        solid,
        path,
        nose,
        _make_arrow((-14, 8 + off), (-16, 8 + off)),
        dimensions=(Dimension("D R", (-4, 5 + 2 * off)),),
    )


def _make_quadrant_sketch() -> Sketch:
    """Return the sketch of the tip quadrants around the nose center. X points up, toward the operator."""
    nose = Outline(_arc((0, 0), 3, 0, 360), "tool", is_closed=True)
    tips = tuple(Dimension(str(n), (6.0 * z, 6.0 * x)) for n, (z, x) in TIP_DIRECTIONS.items() if n)
    cross = (Outline(((-4, 0), (4, 0)), "part"), Outline(((0, -4), (0, 4)), "part"))
    return Sketch((nose, *cross), tips)


_CODE_SKETCHES: dict[Dialect, dict[str, Sketch]] = {
    Dialect.OMNITURN: {
        "G02": _make_arc_sketch("G02 R", convex=True),
        "G03": _make_arc_sketch("G03 R", convex=False),
        "G33": _make_threading_sketch("K", "I", "X", "Z"),
        "G75": _make_roughing_sketch("I", "U", "S", "A", "B"),
        "G78": _make_roughing_sketch("I", "U", "S", "A", "B"),
        "G41": _make_side_sketch(outside=True),
        "G42": _make_side_sketch(outside=False),
        "T": _make_quadrant_sketch(),
    },
    # X points up in this language, so left and right, and clockwise and counterclockwise, are swapped.
    Dialect.SINUMERIK: {
        "G3": _make_arc_sketch("G3 CR=", convex=True),
        "G2": _make_arc_sketch("G2 CR=", convex=False),
        "CYCLE97": _make_threading_sketch("PIT", "APP", "ROP", "FPL"),
        "CYCLE95": _make_roughing_sketch("MID", "FAL"),
        "G42": _make_side_sketch(outside=True),
        "G41": _make_side_sketch(outside=False),
        "D": _make_quadrant_sketch(),
    },
}


SKETCH_HEIGHT = 17.0  # units: height of a sketch


class CodeStrip(Panel):
    """Strip that shows a code with its syntax and meaning. A touch opens the list of codes."""

    background_color = "panel"
    code_entry: RedrawingAttribute[CodeBookEntry | None] = RedrawingAttribute(None)

    def __init__(self, theme: ScreenTheme, press: Callable[[], None], parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._press = press

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the current code with its meaning, or the word CODES if no code is shown."""
        self.add_target(self.find_full_area(), self._press)
        box = self.find_full_area().adjusted(
            1.2 * self.theme.unit_px, 0.3 * self.theme.unit_px, -0.6 * self.theme.unit_px, 0
        )
        if self.code_entry is None:
            painter.draw_text_line(box, "CODES", 1.8, "accent")
            return
        draw_code_entry(painter, box, self.code_entry, "accent", "text")


class CodeList(CodeChoiceList):
    """List of codes, which shows the description, examples and a sketch of the selected code."""

    def __init__(
        self,
        theme: ScreenTheme,
        text_field: ProgramTextField,
        live_proof: LiveProof,
        return_to_text: Callable[[], None],
        parent: QWidget,
    ) -> None:
        """Create the list.

        ``return_to_text`` is called to close the list and move the focus back to the program text.
        """
        self._codes = CodeHelp()
        super().__init__(theme, self._codes, self._insert_code, parent)
        self._field, self._proof, self._back = text_field, live_proof, return_to_text
        self.dialect = Dialect.OMNITURN  # of the program; the sketches depend on the language
        self._picture = SketchPanel(theme, lambda _word: None, lambda _point: None, self)

    def update_code(self) -> CodeBookEntry | None:
        """Look up the code at the cursor and return its entry, or None if no code is there."""
        field = self._field
        self._codes.update_for_cursor(
            self._proof.current_findings.code_book, field.cursor_line_text, field.cursor_column
        )
        return self._codes.current_entry

    def open_choices(self) -> bool:
        """Open the list for the code at the cursor, and return whether the list opened.

        The list cannot open before a text has been proved.
        """
        self.update_code()
        return self._codes.open_choices()

    def _insert_code(self) -> None:
        """Insert the selected code into the text."""
        chosen = self._codes.selected_entry
        if chosen is not None:
            self._field.insert_text(chosen.written, self._codes.start_column)
        self._back()

    def refresh(self) -> None:
        """Update the sketch and the list.

        This method is called once per frame.
        """
        super().refresh()
        chosen = self._codes.selected_entry
        drawn = make_code_sketch(chosen.head, self.dialect) if chosen is not None else None
        self._picture.setVisible(drawn is not None)
        if drawn is not None:
            self._picture.displayed_sketch = (
                drawn,
                tuple((d.field_label, d.field_label) for d in drawn.dimensions),
                "",
                frozenset(),
            )
            u, foot = self.theme.unit_px, self._find_foot_height()
            self._picture.setGeometry(
                round(0.8 * u),
                round(self.height() - foot),
                round(self.width() - 1.6 * u),
                round(SKETCH_HEIGHT * u),
            )

    def _find_foot_height(self) -> float:
        """Return the height in pixels of the area below the list for the example and the sketch."""
        return super()._find_foot_height() + self._find_sketch_height()

    def _find_sketch_height(self) -> float:
        """Return the height of the sketch in pixels, or 0 while the sketch is hidden."""
        return SKETCH_HEIGHT * self.theme.unit_px if not self._picture.isHidden() else 0.0

    def make_function_keys(self) -> dict[int, FunctionKey]:
        """Return the function keys that apply while the list is open."""
        shown = self._codes
        return {
            2: FunctionKey("WRITE", self._insert_code),
            4: FunctionKey("UP", lambda: shown.mark(shown.marked - 1)),
            5: FunctionKey("DOWN", lambda: shown.mark(shown.marked + 1)),
            6: FunctionKey("CHAPTER -", partial(shown.move_chapters, -1)),
            7: FunctionKey("CHAPTER +", partial(shown.move_chapters, 1)),
        }

    def make_arrow_actions(self) -> dict[int, Callable[[], None]]:
        """Return the actions of the arrow and page keys, Home, End and Enter."""
        by = {number: key.action for number, key in self.make_function_keys().items()}
        return {
            Qt.Key.Key_Up: by[4],
            Qt.Key.Key_Down: by[5],
            Qt.Key.Key_PageUp: partial(self.scroll_by, -self.rows),
            Qt.Key.Key_PageDown: partial(self.scroll_by, self.rows),
            Qt.Key.Key_Home: partial(self.scroll_by, -WHOLE_LIST),
            Qt.Key.Key_End: partial(self.scroll_by, WHOLE_LIST),
            Qt.Key.Key_Left: by[6],
            Qt.Key.Key_Right: by[7],
            Qt.Key.Key_Return: by[2],
            Qt.Key.Key_Enter: by[2],
        }
