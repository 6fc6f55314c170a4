"""Pictures of the form of a drawing, and the drawing among the programs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import ezdxf

from app.compose.runs.journal import Journal
from app.desk.data_folder import find_data_folder
from app.desk.desk import Desk
from app.editor.editor_view import EditorPage
from app.extras.drawings.drawing_form import AdditionalDrawingForm
from app.extras.shapes.shapes_view import ShapesView
from app.screen.page_base import Page

SCENES = (("drawing", "F3 Shapes X", "calculators"),)
DRAWING = "spigot.dxf"
# Inches, Z to the right, the axis below: a nose of .5, a taper of 30 degrees, a flange of 1.
NOSE, FLANGE = ((0, 0), (0, 0.25), (-0.5, 0.25)), ((-1, 0.5), (-1.25, 0.5), (-1.25, 0))
OUTLINE = (*NOSE, (-0.7165, 0.375), (-1, 0.375), *FLANGE)
INCH = 1  # $INSUNITS
LOADING = 60.0  # s


def prepare(_desk: Desk, _journal: Journal, _folder: Path) -> None:
    """A DXF of one closed outline into the program folder."""
    folder = find_data_folder() / "programs"
    folder.mkdir(parents=True, exist_ok=True)
    drawing = ezdxf.filemanagement.new()
    drawing.header["$INSUNITS"] = INCH
    drawing.modelspace().add_lwpolyline(OUTLINE)
    drawing.saveas(folder / DRAWING)


def settle(page: Page | None, wait: Callable[[], None]) -> None:
    """Wait until a drawing has been read, and what was made of it proved."""
    if isinstance(page, EditorPage) and isinstance(page.editor_panel, ShapesView):
        for each in (
            page.editor_panel.model.additional_forms if page.editor_panel.model.form is not None else ()
        ):
            if isinstance(each, AdditionalDrawingForm):
                wait()
                each.plan_worker.wait_for_results(LOADING)
                wait()
                each.trial_worker.wait_for_results(LOADING)
