"""Code help of the editor: the meaning and picture of the code at the cursor, and a list of codes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from app.desk.pages.code_help import CodeHelp
from app.desk.pages.sheet import Key
from app.editor.live_proof import LiveProof
from app.editor.text_view import TextField
from app.screen.code_choices_view import CodeChoices, write_entry
from app.screen.drawings import SketchPanel
from app.screen.look import Look, Painter
from app.screen.panel import Panel, Shown
from core.language.code_book import Entry
from core.language.source import Dialect
from core.sketch import Dim, Outline, Sketch, cut, part, sketch
from core.tool_edges import TIP_DIRECTIONS

Point = tuple[float, float]


def picture_of(head: str, dialect: Dialect = Dialect.OMNITURN) -> Sketch | None:
    """Return the sketch of a lathe code, Z to the right and radius up, or None without a sketch."""
    return _PICTURES.get(dialect, {}).get(head)


def _arc(centre: Point, radius: float, begin: float, end: float) -> tuple[Point, ...]:
    angles = [math.radians(begin + (end - begin) * k / 12) for k in range(13)]
    return tuple((centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles)


def _with_arc(words: str, *, convex: bool) -> Sketch:
    """Return a sketch from the face to the chuck with an arc: a rounded shoulder or a filled corner."""
    corner = _arc((-4, 4), 4, 0, 90) if convex else _arc((0, 8), 4, 270, 180)
    solid = part((0, 0), *corner, (-16, 8), (-16, 0))
    return sketch(solid, cut(*corner), _arrow(corner[5], corner[7]), dims=(Dim(words, (2, 10)),))


def _arrow(a: Point, b: Point) -> Outline:
    """Return an arrow in the direction of tool motion."""
    angle = math.atan2(b[1] - a[1], b[0] - a[0])
    ends = [(b[0] - 1.4 * math.cos(angle + s), b[1] - 1.4 * math.sin(angle + s)) for s in (0.5, -0.5)]
    return Outline((ends[0], b, ends[1]), "tool")


def _roughing(deep: str, left: str, *points: str) -> Sketch:
    """Return a sketch of a roughing cycle.

    ``deep`` and ``left`` are the words for the depth of cut and the allowance, and ``points`` are those for
    the start and end points.
    """
    profile = ((0, 3), (-6, 3), (-9, 6), (-14, 6), (-14, 9))
    passes = [
        cut((1, r), (z, r)) for r, z in ((8.0, -13.7), (7.0, -13.7), (6.3, -9.0), (5.0, -7.7), (4.0, -6.7))
    ]
    solid = part((0, 0), *profile, (-20, 9), (-20, 0))
    places = ((2.0, 10.0), (0.0, 3.0), (-14.0, 9.0))
    named = (Dim(name, at) for name, at in zip(points, places, strict=False))
    return sketch(solid, *passes, dims=(Dim(deep, (1.5, 7.5)), Dim(left, (-11, 6.2)), *named))


def _threading(lead: str, start: str, last: str, end: str) -> Sketch:
    """Return a sketch of a threading cycle with the words for lead, start, last pass and end."""
    teeth = [(-float(k), 7.0 if k % 2 else 5.6) for k in range(13)]
    depths = [cut((3, 7.0 - 0.7 * math.sqrt(k)), (-12, 7.0 - 0.7 * math.sqrt(k))) for k in (1, 2, 3, 4)]
    solid = part((0, 0), *teeth, (-20, 7), (-20, 0))
    dims = (Dim(lead, (-4, 8.4)), Dim(start, (4, 6.5)), Dim(last, (-14, 5)), Dim(end, (-12, 9)))
    return sketch(solid, *depths, dims=dims)


def _beside(*, outside: bool) -> Sketch:
    """Return a sketch of the tool nose along the outside or inside contour, moving to the chuck."""
    solid = part((0, 0), (0, 5), (-8, 5), (-12, 8), (-18, 8), (-18, 0))
    off = 1.2 if outside else -1.2
    path = cut((2, 5 + off), (-8, 5 + off), (-12, 8 + off), (-18, 8 + off))
    nose = Outline(_arc((-4, 5 + off), 1.2, 0, 360), "tool", closed=True)
    return sketch(
        solid, path, nose, _arrow((-14, 8 + off), (-16, 8 + off)), dims=(Dim("D R", (-4, 5 + 2 * off)),)
    )


def _quadrants() -> Sketch:
    """Return a sketch of the tip quadrants around the nose center.

    The radius points up, to the operator.
    """
    nose = Outline(_arc((0, 0), 3, 0, 360), "tool", closed=True)
    tips = tuple(Dim(str(n), (6.0 * z, 6.0 * x)) for n, (z, x) in TIP_DIRECTIONS.items() if n)
    cross = (Outline(((-4, 0), (4, 0)), "part"), Outline(((0, -4), (0, 4)), "part"))
    return Sketch((nose, *cross), tips)


_PICTURES: dict[Dialect, dict[str, Sketch]] = {
    Dialect.OMNITURN: {
        "G02": _with_arc("G02 R", convex=True),
        "G03": _with_arc("G03 R", convex=False),
        "G33": _threading("K", "I", "X", "Z"),
        "G75": _roughing("I", "U", "S", "A", "B"),
        "G78": _roughing("I", "U", "S", "A", "B"),
        "G41": _beside(outside=True),
        "G42": _beside(outside=False),
        "T": _quadrants(),
    },
    # X points up in this language, so left and right, and clockwise and counterclockwise, are swapped.
    Dialect.SINUMERIK: {
        "G3": _with_arc("G3 CR=", convex=True),
        "G2": _with_arc("G2 CR=", convex=False),
        "CYCLE97": _threading("PIT", "APP", "ROP", "FPL"),
        "CYCLE95": _roughing("MID", "FAL"),
        "G42": _beside(outside=True),
        "G41": _beside(outside=False),
        "D": _quadrants(),
    },
}


PICTURE = 17.0  # units: height of a sketch


class CodeStrip(Panel):
    """Line with one code, its syntax and meaning. A press opens the list."""

    ground = "panel"
    entry: Shown[Entry | None] = Shown(None)

    def __init__(self, look: Look, press: Callable[[], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press = press

    def draw(self, painter: Painter) -> None:
        self.place(self.area(), self._press)
        box = self.area().adjusted(1.2 * self.look.u, 0.3 * self.look.u, -0.6 * self.look.u, 0)
        if self.entry is None:
            painter.write(box, "CODES", 1.8, "accent", fit=False)
            return
        write_entry(painter, box, self.entry, "accent", "text")


class CodeList(CodeChoices):
    """List of codes.

    For the selected code, the list shows its description, examples and sketch.
    """

    def __init__(
        self, look: Look, field: TextField, proof: LiveProof, back: Callable[[], None], parent: QWidget
    ) -> None:
        """Create the list. ``back`` closes the list and returns to the text."""
        self._codes = CodeHelp()
        super().__init__(look, self._codes, self._take, parent)
        self._field, self._proof, self._back = field, proof, back
        self.dialect = Dialect.OMNITURN  # of the program; the sketches depend on the language
        self._picture = SketchPanel(look, lambda _word: None, lambda _point: None, self)

    def follow(self) -> Entry | None:
        """Update the code under the cursor and return its entry."""
        field = self._field
        self._codes.follow(self._proof.now.book, field.textCursor().block().text(), field.column)
        return self._codes.entry

    def ask(self) -> bool:
        """Open the list for the typed text. Return False if no text has been proved yet."""
        self.follow()
        return self._codes.ask()

    def _take(self) -> None:
        """Insert the selected code into the text."""
        chosen = self._codes.chosen
        if chosen is not None:
            self._field.write(chosen.written, self._codes.begin)
        self._back()

    def refresh(self) -> None:
        """Update the sketch and the list; called once per frame."""
        super().refresh()
        chosen = self._codes.chosen
        drawn = picture_of(chosen.head, self.dialect) if chosen is not None else None
        self._picture.setVisible(drawn is not None)
        if drawn is not None:
            self._picture.shown = drawn, tuple((d.word, d.word) for d in drawn.dims), "", frozenset()
            u, foot = self.look.u, self._foot()
            self._picture.setGeometry(
                round(0.8 * u), round(self.height() - foot), round(self.width() - 1.6 * u), round(PICTURE * u)
            )

    def _foot(self) -> float:
        """Return the height of the example and the sketch in pixels."""
        return super()._foot() + self._drawn()

    def _drawn(self) -> float:
        """Return the height of the sketch in pixels."""
        return PICTURE * self.look.u if not self._picture.isHidden() else 0.0

    def keys(self) -> dict[int, Key]:
        """Return the function keys while the list is open."""
        shown = self._codes
        return {
            2: Key("WRITE", self._take),
            4: Key("UP", lambda: shown.mark(shown.marked - 1)),
            5: Key("DOWN", lambda: shown.mark(shown.marked + 1)),
            6: Key("CHAPTER -", partial(shown.turn, -1)),
            7: Key("CHAPTER +", partial(shown.turn, 1)),
        }

    def arrows(self) -> dict[int, Callable[[], None]]:
        """Return the actions of the arrow keys and of Enter."""
        by = {number: key.action for number, key in self.keys().items()}
        return {
            Qt.Key.Key_Up: by[4],
            Qt.Key.Key_Down: by[5],
            Qt.Key.Key_Left: by[6],
            Qt.Key.Key_Right: by[7],
            Qt.Key.Key_Return: by[2],
            Qt.Key.Key_Enter: by[2],
        }
