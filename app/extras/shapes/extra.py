"""Registration of the optional feature for shapes and calculators in the program editor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature, Subcommand

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.desk.programs.program_loading import LoadingSteps
    from app.extras.shapes.shapes_model import ShapesModel
    from core.json_keys import JsonOutput
    from core.machine.machine_model import Machine


class ShapesExtra(OptionalFeature):
    """Optional feature with the shapes and calculators of the editor, and ``turndesk shapes``."""

    subcommands = {
        "shapes": Subcommand("setup", "make a program from the shapes that a file defines"),
    }
    editor_panel_class = "app.extras.shapes.shapes_view.ShapesView"

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Register the shapes model, which is created when it is first used."""
        desk.page_registry.attach_lazy_model(
            "app.extras.shapes.shapes_model.ShapesModel", partial(_shapes, desk, machine)
        )

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk shapes`` for the reference page."""
        from app.extras.shapes.shapes_command import OUTPUTS

        return {"store verify --json": OUTPUTS}

    def words(self) -> Sequence[str]:
        """Return the screen texts of all shapes and calculators in every dialect."""
        from app.extras.shapes.shape_form import list_translatable_texts
        from core.extras.shapes.shape_table import CALCULATORS_BY_DIALECT, SHAPES_BY_DIALECT

        tables = (*SHAPES_BY_DIALECT.values(), *CALCULATORS_BY_DIALECT.values())
        return list_translatable_texts(shape for table in tables for shape in table.values())


def _shapes(desk: Desk, machine: Machine) -> ShapesModel:
    from app.extras.shapes.shapes_setup import make_shapes_model

    return make_shapes_model(desk, machine)


EXTRA = ShapesExtra()
