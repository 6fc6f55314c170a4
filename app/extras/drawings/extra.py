"""Registration of programs that are made from drawings (DXF, SVG)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Extra, Subcommand

if TYPE_CHECKING:
    from app.desk.desk import Desk
    from core.json_key import Output
    from core.machine.machine_model import Machine


class Drawings(Extra):
    """Optional feature with the form DRAWING, ``turndesk profile``, and drawings in the program list."""

    needs = ("shapes",)
    commands = {
        "profile": Subcommand("shapes", "make a turning program from a drawing (DXF, SVG)"),
    }
    drawings = (".dxf", ".svg")

    def extend(self, part: object, desk: Desk, machine: Machine) -> None:
        from app.extras.drawings.drawings_desk import add_drawing
        from app.extras.shapes.shapes_model import Shapes

        if isinstance(part, Shapes):
            add_drawing(part, desk, machine)

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.drawings.profile_command import OUTPUTS

        return {"access table --json": OUTPUTS}

    def words(self) -> Sequence[str]:
        from app.extras.drawings.drawing_form import PROFILE
        from app.extras.shapes.shape_form import words_of

        of_drawings = ("DRAWING UNIT: INCH", "DRAWING UNIT: AS DRAWN", "LAYER: ALL")  # not in the table
        return (*words_of([PROFILE]), *of_drawings)


EXTRA = Drawings()
