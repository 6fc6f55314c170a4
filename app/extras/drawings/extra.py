"""Registration of the optional feature that makes programs from drawings (DXF, SVG)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature, Subcommand

if TYPE_CHECKING:
    from app.desk.desk import Desk
    from core.json_keys import JsonOutput
    from core.machine.machine_model import Machine


class DrawingsExtra(OptionalFeature):
    """Optional feature with the DRAWING form, ``turndesk profile``, and drawings in the program list."""

    required_features = ("shapes",)
    subcommands = {
        "profile": Subcommand("shapes", "make a turning program from a drawing (DXF, SVG)"),
    }
    drawing_suffixes = (".dxf", ".svg")

    def extend_model(self, model: object, desk: Desk, machine: Machine) -> None:
        """Add the DRAWING form if ``model`` is the shapes model."""
        from app.extras.drawings.drawings_setup import add_drawing_form
        from app.extras.shapes.shapes_model import ShapesModel

        if isinstance(model, ShapesModel):
            add_drawing_form(model, desk, machine)

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk profile`` for the reference page."""
        from app.extras.drawings.profile_command import OUTPUTS

        return {"access table --json": OUTPUTS}

    def words(self) -> Sequence[str]:
        """Return the screen texts of the DRAWING form, including texts that are not in its field table."""
        from app.extras.drawings.drawing_form import DRAWING_SHAPE
        from app.extras.shapes.shape_form import list_translatable_texts

        of_drawings = ("DRAWING UNIT: INCH", "DRAWING UNIT: AS DRAWN", "LAYER: ALL")  # not in the table
        return (*list_translatable_texts([DRAWING_SHAPE]), *of_drawings)


EXTRA = DrawingsExtra()
