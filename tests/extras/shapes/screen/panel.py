"""The panel of shapes in the editor."""

from __future__ import annotations

from app.extras.shapes.shapes_view import ShapesView
from tests.screen.editor.writer import Writer


def shapes_of(writer: Writer) -> ShapesView:
    """Return the panel of the editor in front."""
    found = writer.editor.editor_panel
    assert isinstance(found, ShapesView)
    return found
