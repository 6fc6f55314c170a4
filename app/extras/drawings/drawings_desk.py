"""Setup of the drawing form: available drawings and the trial with the present tools."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from app.compose.stored_offsets import shapes_at_hand
from app.desk.background_work import Watch
from app.desk.desk import Desk
from app.extras.drawings.drawing_form import AddedDrawing
from app.extras.drawings.drawing_plan import Plan
from app.extras.drawings.profile_trial_desk import TrialStock, tried
from app.extras.shapes.shapes_model import Shapes
from core.extras.drawings.part_against_drawing import Comparison
from core.extras.drawings.profile_program import greatest_diameter
from core.machine.machine_model import Machine
from core.part.tool_shape import ToolShape


def add_drawing(shapes: Shapes, desk: Desk, machine: Machine) -> None:
    """Add the form of a drawing to the list of shapes."""

    def files() -> dict[str, Path]:
        return {each.name: each.path for each in desk.programs.folders.drawings()}

    shapes.added = (*shapes.added, AddedDrawing(files, partial(attempt, machine, shapes_at_hand)))


def attempt(
    machine: Machine, shapes: Callable[[], Mapping[int, ToolShape]], text: str, plan: Plan, watch: Watch
) -> tuple[Comparison | None, tuple[str, ...]]:
    """Prove the program with the stock of the form and the present tools, and compare the part."""
    made, chosen, mm = plan.made, plan.chosen, plan.asked.setting.mm
    if made is None or chosen is None:
        return None, ()

    def length(word: str) -> float:
        value = plan.asked.values.get(word, plan.proposals.get(word, 0.0))
        return 0.0 if isinstance(value, str) else value * mm

    bar = length("FROM") or 1.5 * greatest_diameter(chosen)
    stock = TrialStock(bar, length("STOCK"), length("HOLE"))
    trial = tried(text, chosen, stock, made.nose, machine, shapes(), watch, plan.asked.setting.dialect)
    return trial.comparison, trial.errors
