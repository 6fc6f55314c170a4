"""Registration of the shapes and calculators of the editor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

from app.compose.extra import Extra, Subcommand

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.desk.programs.program_loading import LoadingSteps
    from app.extras.shapes.shapes_model import Shapes
    from core.json_key import Output
    from core.machine.machine_model import Machine


class ShapesAndCalculators(Extra):
    """Optional feature with the shapes and calculators of the editor and ``turndesk shapes``."""

    commands = {
        "shapes": Subcommand("setup", "make a program from the shapes that a file defines"),
    }
    editor_panel = "app.extras.shapes.shapes_view.ShapesView"

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        desk.pages.attach_later("app.extras.shapes.shapes_model.Shapes", partial(_shapes, desk, machine))

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.shapes.shapes_command import OUTPUTS

        return {"store verify --json": OUTPUTS}

    def words(self) -> Sequence[str]:
        from app.extras.shapes.shape_form import words_of
        from core.extras.shapes.shape_table import HELPERS_OF, SHAPES_OF

        tables = (*SHAPES_OF.values(), *HELPERS_OF.values())
        return words_of(shape for table in tables for shape in table.values())


def _shapes(desk: Desk, machine: Machine) -> Shapes:
    from app.extras.shapes.shapes_desk import shapes_of

    return shapes_of(desk, machine)


EXTRA = ShapesAndCalculators()
