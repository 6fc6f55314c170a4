"""Panel with the 3D view of a mill: table, workpiece, working plane and tool.

The module ``plane_drawing`` calculates the drawing.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QMouseEvent, QPainter, QPen, QPolygonF, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter, draw_raw_text

if TYPE_CHECKING:
    from app.working_plane.plane_drawing import Camera, DrawnFace, DrawnStroke, FloatArray
    from app.working_plane.plane_instant import SceneInstant
    from app.working_plane.plane_scene import MillScene

# For each face: fill color, opacity (0 to 255), edge color.
_FACE_COLORS = {
    "table": ("key", 255, "frame"),
    "table-under": ("key", 110, "frame"),  # the workpiece is visible through the table
    "blank": ("ghost", 215, "soft"),
    "blank-top": ("here", 225, "soft"),
    "plane": ("accent", 70, "accent"),
    "tool": ("pause", 235, "text"),
}
# For each stroke: color, width in units, dashed.
_STROKE_STYLES = {
    "rapid": ("rapid", 0.10, True),
    "cut": ("todo", 0.22, False),
    "done": ("done", 0.26, False),
    "x": ("alarm", 0.30, False),
    "y": ("run", 0.30, False),
    "z": ("wait", 0.30, False),
    "axis": ("soft", 0.10, True),
}
MAX_SMOOTH_POINTS = 2000  # maximum number of points of a line that is drawn wide and antialiased
_DRAG_STEP = 60.0  # pixels of a drag per panning step


class WorkingPlaneView(Panel):
    """Panel that shows a scene at an instant.

    A button, a key or a tap on the name of the view direction selects the next view direction.
    """

    title = "TABLE AND PLANE"
    words = RedrawingAttribute("")
    _instant: RedrawingAttribute[SceneInstant | None] = RedrawingAttribute(None)
    _camera: RedrawingAttribute[Camera | None] = RedrawingAttribute(None)

    def __init__(self, theme: ScreenTheme, parent: QWidget | None = None) -> None:
        super().__init__(theme, parent)
        self._scene: MillScene | None = None
        self._held: QPointF | None = None
        self.hide()

    @property
    def scene(self) -> MillScene | None:
        """Return the displayed scene, or None if there is no scene."""
        return self._scene

    @property
    def scene_instant(self) -> SceneInstant | None:
        """Return the displayed axis positions, plane and active block, or None if nothing is displayed."""
        return self._instant

    @property
    def camera(self) -> Camera | None:
        """Return the camera of the view, or None if no scene is displayed."""
        return self._camera

    def show_scene(self, scene: MillScene | None) -> None:
        """Show the scene of another program.

        The view direction does not change.
        """
        if scene is self._scene:
            return
        aspect = self._camera.view_direction_index if self._camera is not None else 0
        self._scene, self._instant = scene, None
        if scene is not None:
            from app.working_plane.plane_drawing import make_camera
            from app.working_plane.plane_instant import make_view_title

            self.title = make_view_title(scene.kinematics)
            self._camera = replace(make_camera(scene), view_direction_index=aspect)
        self.update()

    def show_instant(self, instant: SceneInstant, plane_text: str) -> None:
        """Show the mill at an instant, with a text that describes the working plane."""
        self._instant, self.words = instant, plane_text

    # --- navigation ----------------------------------------------------------------------------------

    def select_next_view(self) -> None:
        """Select the next view direction."""
        self._look(self._camera.with_next_view_direction() if self._camera else None)

    def fit_all_panes(self) -> None:
        """Zoom and pan so that the whole table is visible."""
        self._look(self._camera.with_full_view() if self._camera else None)

    def zoom_view(self, step_count: int) -> None:
        """Zoom in by a number of steps.

        Negative steps zoom out.
        """
        self._look(self._camera.with_zoom(step_count) if self._camera else None)

    def pan_view(self, steps_right: int, steps_down: int) -> None:
        """Move the visible area by a number of steps to the right and down."""
        self._look(self._camera.with_pan(steps_right, steps_down) if self._camera else None)

    def _look(self, camera: Camera | None) -> None:
        if camera is not None:
            self._camera = camera

    # --- Qt's calls ----------------------------------------------------------------------------------

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom with the mouse wheel."""
        self.zoom_view(1 if event.angleDelta().y() > 0 else -1)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Press a button of the view, or start a drag."""
        if not self.press_target_at(event.position()):
            self._held = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Pan in steps during a drag."""
        if self._held is None:
            return
        drag_offset_px = event.position() - self._held
        across, down = (int(side / _DRAG_STEP) for side in (drag_offset_px.x(), drag_offset_px.y()))
        if across or down:
            self._held = event.position()
            self.pan_view(-across, -down)

    def mouseReleaseEvent(self, _event: QMouseEvent) -> None:
        """End a drag."""
        self._held = None

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the faces and strokes of the scene at the selected instant, as seen by the camera.

        Nothing is drawn while the scene, the instant or the camera is missing.
        """
        room = self.inside()
        if self._scene is None or self._instant is None or self._camera is None:
            return
        from app.working_plane.plane_drawing import draw_scene

        made = draw_scene(self._scene, self._instant, self._camera, room.width(), room.height())
        painter.save()
        painter.setClipRect(room)
        painter.translate(room.topLeft())
        for face in made.faces:
            self._face(painter, face)
        for stroke in made.strokes:
            self._stroke(painter, stroke)
        painter.restore()
        self._words(painter, room)

    def _face(self, painter: ThemedPainter, face: DrawnFace) -> None:
        fill, share, edge = _FACE_COLORS[face.color_role]
        colour = self.theme.get_color(fill)
        colour.setAlpha(share)
        painter.setBrush(colour)
        painter.setPen(self.theme.make_pen(edge, 0.10))
        painter.drawPolygon(_polygon(face.points))

    def _stroke(self, painter: ThemedPainter, stroke: DrawnStroke) -> None:
        colour, width, dashed = _STROKE_STYLES[stroke.color_role]
        pen = QPen(self.theme.make_pen(colour, width))
        fine = (
            len(stroke.points) <= MAX_SMOOTH_POINTS
        )  # A wide, antialiased pen would take 0.1 s for longer lines.
        if not fine:
            pen.setWidth(1)
        elif dashed:
            pen.setStyle(Qt.PenStyle.DashLine)
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, fine)
        painter.drawPolyline(_polygon(stroke.points))
        if stroke.name:
            u = self.theme.unit_px
            x, y = stroke.points[-1].tolist()
            painter.setFont(self.theme.make_font(1.6, is_bold=True))
            draw_raw_text(painter, QRectF(x - 2 * u, y - 1.4 * u, 4 * u, 2.2 * u), ALIGN_CENTER, stroke.name)

    def _words(self, painter: ThemedPainter, room: QRectF) -> None:
        u = self.theme.unit_px
        foot = room.adjusted(0, room.height() - 2.4 * u, 0, 0)
        painter.draw_text_line(foot, self.words, 1.7, "text", raw=True)
        assert self._camera is not None
        button = QRectF(room.right() - 8 * u, room.top(), 8 * u, 3.4 * u)
        self.key(painter, button, tr(self._camera.view_direction.name), 1.6, self.select_next_view)


def _polygon(points: FloatArray) -> QPolygonF:
    from app.path.path_layers_view import make_polygon

    return make_polygon(points[:, 0], points[:, 1])
