"""A drawing at the form: while its process reads, the screen counts and Esc or F6 ends it."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt

from app.editor.editor_modes import EditorMode
from app.extras.drawings.drawing_form import AdditionalDrawingForm
from core.extras.drawings import drawing_process
from tests.extras.drawings.hand import chain, dxf
from tests.extras.shapes.screen.panel import shapes_of
from tests.screen.editor.writer import Writer
from tests.screen.hands import Key
from tests.texts import text as wording

SHIFT = Qt.KeyboardModifier.ShiftModifier
STEP = ((0, 0), (0, 4), (-10, 4), (-10, 6), (-20, 6), (-20, 0))


def labels(writer: Writer) -> dict[int, str]:
    """The function keys of the form."""
    return {number: key.label for number, key in shapes_of(writer).model.make_function_keys().items()}


@pytest.mark.parametrize("key", [Key.Key_Escape, Key.Key_F6])
def test_a_process_that_hangs_is_canceled(
    writer: Writer, key: Key, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "part.dxf"
    path.write_text("hang")
    monkeypatch.setattr(drawing_process, "_CHILD", "tests.extras.drawings.hostile_child")
    writer.new("shaped")
    model, drawing = shapes_of(writer).model, AdditionalDrawingForm(lambda: {"part.dxf": path})
    model.additional_forms = (drawing,)
    writer.key(Key.Key_F3, SHIFT)
    writer.sees(lambda: writer.editor.mode is EditorMode.PANEL)
    writer.type("x")
    writer.sees(lambda: writer.editor.prompt_text() == wording("shapes.being-read", seconds=0))
    assert labels(writer)[6] == "CANCEL"
    writer.key(key)
    writer.sees(lambda: writer.editor.prompt_text() == wording("shapes.reading-canceled"))
    writer.sees(lambda: not drawing.planner.is_reading)  # its process has ended
    model._have_shop(model.shop_data)  # tool data that were read only now do not begin it again
    assert writer.editor.prompt_text() == wording("shapes.reading-canceled")
    monkeypatch.undo()
    dxf(path, chain(*STEP))
    assert labels(writer)[6] == "READ"
    writer.key(Key.Key_F6)
    writer.sees(lambda: model.form is not None and bool(model.form.program_lines))
    assert 6 not in labels(writer)


def test_the_drawing_is_seen_when_its_form_opens(writer: Writer) -> None:
    """The number pad of the form before lay over it at 1024x600, where the contour is to be picked."""
    writer.new("shaped")
    shapes_of(writer).model.additional_forms = (AdditionalDrawingForm(dict),)
    writer.key(Key.Key_F3, SHIFT)
    writer.sees(lambda: writer.editor.mode is EditorMode.PANEL)
    writer.key(Key.Key_F9)
    assert shapes_of(writer).model.is_number_pad_visible
    writer.type("x")
    writer.sees(lambda: shapes_of(writer).model.form is not None)
    assert not shapes_of(writer).model.is_number_pad_visible
