"""Everything that a path view shows, from back to front."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter

from app.desk import formats
from app.desk.drawing.apart import Apart
from app.desk.words import tr
from app.screen.look import LEFT, put
from app.screen.path import furniture
from app.screen.path.approach import draw_approach
from app.screen.path.aspects import Aspect

if TYPE_CHECKING:
    from app.screen.path.pane import Pane
    from app.screen.pathview import PathView


def draw_view(painter: QPainter, view: PathView) -> None:
    """Panes, title, buttons, legend; a sentence where there is nothing."""
    look = view.look
    if not view.panes:
        why = tr("The path is shown when a program is loaded.")
        furniture.draw_nothing(painter, look, view.inside(), why)
        return
    for pane in view.panes:
        _pane(painter, view, pane)
    if view.ruler is not None:  # beside what is measured, where there is another pane
        beside = next((pane for pane in view.panes if pane is not view.ruler.pane), view.ruler.pane)
        view.ruler.draw_figures(painter, beside.room, view.in_mm)
    _title(painter, view)
    furniture.draw_buttons(painter, look, view.room(), _buttons(view), view.place)
    legend = furniture.compared_legend(look) if view.comparing else furniture.run_legend(look)
    furniture.draw_legend(painter, look, view.panes[0].room, legend)
    apart = view.panes[0].apart
    if apart is not None:
        furniture.draw_words(painter, look, view.panes[0].room, _apart_words(apart, view.in_mm))


def _pane(painter: QPainter, view: PathView, pane: Pane) -> None:
    painter.save()
    painter.setClipRect(pane.room)
    painter.translate(pane.room.topLeft())
    pane.draw(painter)
    if view.legs and pane.aspect is Aspect.PATH:
        draw_approach(painter, view.look, pane, view.legs)
    if view.ruler is not None and view.ruler.pane is pane:
        view.ruler.draw(painter)
    painter.restore()
    if pane.frame is not None:
        furniture.draw_scale(painter, view.look, pane.room, pane.frame, view.in_mm)
    if pane.aspect is not Aspect.PATH:
        furniture.draw_words(painter, view.look, pane.room, _name_of(pane, view.in_mm))
        if pane is not view.panes[0]:
            furniture.draw_border(painter, view.look, pane.room)


def _apart_words(apart: Apart, in_mm: bool) -> str:
    if not apart.distance:
        return tr("NOTHING THAT IS CUT HAS CHANGED")
    length = formats.length(apart.distance, in_mm)
    return tr("AT MOST {length} {unit} APART  ·  AT THE CIRCLE").format(
        length=length, unit="mm" if in_mm else "in"
    )


def _name_of(pane: Pane, in_mm: bool) -> str:
    if pane.aspect is Aspect.FACE:
        return tr("FACE  ·  SEEN FROM THE TAILSTOCK")
    diameter = formats.length(pane.trail.round * 360.0 / math.pi, in_mm)
    return tr("SIDE  ·  UNROLLED AT Ø {diameter}").format(diameter=diameter)


def _buttons(view: PathView) -> list[furniture.Button]:
    button = furniture.Button
    found = [
        button("+", lambda: view.zoom(1)),
        button("−", lambda: view.zoom(-1)),
        button(tr("FIT"), view.fit),
        button(tr("MEAS"), view.measure, view.ruler is not None),
    ]
    if view.several:
        found.append(button(tr("VIEW"), view.next_view))
    return found


def _title(painter: QPainter, view: PathView) -> None:
    """The panes have covered the lower half of it."""
    look, u = view.look, view.look.u
    wide = view.width() - 4 * u
    painter.setFont(look.fit(view.title, 1.7, wide, bold=True))
    painter.setPen(look.colour("soft"))
    put(painter, QRectF(2.2 * u, 0, wide, 2.0 * u), LEFT, view.title)
