"""Setup of the drawing form: the available drawings, and the trial with the current tools."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from app.compose.stored_offsets import try_read_shapes
from app.desk.background_work import ProgressCallback
from app.desk.desk import Desk
from app.extras.drawings.drawing_form import AdditionalDrawingForm
from app.extras.drawings.drawing_plan import DrawingPlan
from app.extras.drawings.profile_trial import TrialStock, run_profile_trial
from app.extras.shapes.shapes_model import ShapesModel
from core.extras.drawings.part_comparison import DrawingComparison
from core.extras.drawings.profile_program import find_max_diameter
from core.machine.machine_model import Machine
from core.part.tool_shape import ToolShape


def add_drawing_form(shapes: ShapesModel, desk: Desk, machine: Machine) -> None:
    """Add the drawing form to the list of shapes."""

    def list_drawing_files() -> dict[str, Path]:
        return {each.name: each.path for each in desk.program_choice.program_folders.list_drawings()}

    shapes.additional_forms = (
        *shapes.additional_forms,
        AdditionalDrawingForm(list_drawing_files, partial(run_drawing_trial, machine, try_read_shapes)),
    )


def run_drawing_trial(
    machine: Machine,
    read_tool_shapes: Callable[[], Mapping[int, ToolShape]],
    program_text: str,
    plan: DrawingPlan,
    report_progress: ProgressCallback,
) -> tuple[DrawingComparison | None, tuple[str, ...]]:
    """Prove the program with the form's stock and the current tools, and compare the part.

    Returns the comparison of the part with the drawing, which may be None, and the errors of the proof.
    """
    made, chosen, mm = plan.program, plan.profile, plan.request.settings.mm
    if made is None or chosen is None:
        return None, ()

    def get_length_mm(word: str) -> float:
        value = plan.request.entered_values.get(word, plan.proposed_values.get(word, 0.0))
        return 0.0 if isinstance(value, str) else value * mm

    bar = get_length_mm("FROM") or 1.5 * find_max_diameter(chosen)
    stock = TrialStock(bar, get_length_mm("STOCK"), get_length_mm("HOLE"))
    trial = run_profile_trial(
        program_text,
        chosen,
        stock,
        made.nose_offset,
        machine,
        read_tool_shapes(),
        report_progress,
        plan.request.settings.dialect,
    )
    return trial.comparison, trial.errors
