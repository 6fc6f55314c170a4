"""Functions that register the pages of the operator screen.

Each function takes a ``PageSetup``. It registers a page model with ``desk.page_registry``, or a function
that creates the model on first use.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.optional_features import extras
from app.compose.part_prover import ReadStoredPart, get_empty_stored_part
from app.compose.program_proving import (
    create_line_prover,
    create_loading_steps,
    create_part_comparer,
    create_path_drawer,
    create_restart_search,
    get_samples_folder,
)
from app.compose.runs.journal import Journal
from app.compose.scope_desk import register_scope
from app.compose.stored_offsets import Offsets, read_stored_offsets, try_read_shapes
from app.desk.background_work import ProgressCallback
from app.desk.data_folder import find_data_folder
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps, ProvedJob
from app.desk.status.busy_notice import BusyNotice
from app.jog.manual_functions import ManualFunctions
from app.mdi.mdi_model import MdiInput, MdiModel
from app.offsets.offset_effect import OffsetEffectWorker
from app.part.part_model import PartPageModel
from app.production.parts_book import ProductionRecords, find_tool_table_kind
from app.production.parts_watch import ProductionMonitor
from app.production.tool_life_watch import ToolLifeMonitor
from app.searchto.searchto_model import RestartModel
from app.special.lamps_and_sound import EventSoundPlayer
from core.access.access_table import ProtectedChange
from core.executor.job import Job
from core.interpreter.dialects import get_code_book
from core.interpreter.restart.restart_approach import OperatorChoices
from core.language.source import Dialect, get_default_extension
from core.machine.machine_model import Machine
from core.store.store_rows import OffsetKind

if TYPE_CHECKING:
    from app.editor.editor_model import EditorModel
    from app.programs.program_list_model import ProgramListModel
    from app.programs.program_rows import DrawThumbnail
    from app.scope.scope_curves import LiveSamples
    from app.special.special_functions import SpecialFunctionsModel

_MODEST_FRACTION = 0.2  # fraction of the manual rapid, for moves inside the part


@dataclass(frozen=True, slots=True, kw_only=True)
class PageSetup:
    """Objects from which the pages are created.

    - ``program_folder`` is the folder of the operator's programs.
    - ``loading_steps`` reads and proves programs with the current offsets and saves nothing.
    - ``proof_steps`` does the same without pictures.
    - ``draw_thumbnail`` draws the part of a program.
    - ``live_samples`` are samples for the scope, or None to use the samples of the control.
    - ``journal`` saves data. If it is None, nothing is saved.
    """

    desk: Desk
    machine: Machine
    persistence: Persistence
    journal: Journal | None
    program_folder: Path
    loading_steps: LoadingSteps
    proof_steps: LoadingSteps
    read_offsets: Callable[[], Offsets] = read_stored_offsets
    read_stored_part: ReadStoredPart = get_empty_stored_part
    draw_thumbnail: DrawThumbnail | None = None
    live_samples: LiveSamples | None = None


RegisterPage = Callable[[PageSetup], None]


def register_pages(setup: PageSetup, pages: Iterable[RegisterPage]) -> None:
    """Register these pages in the given order."""
    for register in pages:
        register(setup)


# --- Programs ---------------------------------------------------------------------------------------------


def _register_effect(setup: PageSetup) -> None:
    compare = create_part_comparer(setup.machine, try_read_shapes, setup.read_stored_part)
    setup.desk.page_registry.attach_model(OffsetEffectWorker(create_path_drawer(setup.machine), compare))


def _register_editor(setup: PageSetup) -> None:
    setup.desk.page_registry.attach_lazy_model(
        "app.editor.editor_model.EditorModel", partial(_create_editor, setup)
    )


def _create_editor(setup: PageSetup) -> EditorModel:
    """Return the model of the editor, which proves the edited text.

    Proving does not save a version of the text after each key press.
    """
    from app.editor.editor_model import EditorModel
    from app.editor.version_history import NullVersionArchive

    desk, machine = setup.desk, setup.machine
    work = create_loading_steps(
        machine,
        setup.read_offsets,
        read_modal_state=lambda: desk.read_snapshot().modal,
        read_shapes=try_read_shapes,
        read_stored_part=setup.read_stored_part,
    )
    ending = get_default_extension(Dialect(machine.mdi_language))
    editor = EditorModel(
        work,
        setup.journal or NullVersionArchive(),
        setup.program_folder,
        get_samples_folder(),
        default_extension=ending,
    )
    editor.find_save_refusal = lambda: desk.user_access.find_refusal_reason(ProtectedChange.PROGRAMS)
    return editor


def register_programs(setup: PageSetup) -> None:
    """Register the list of programs on the screen model."""
    setup.desk.page_registry.attach_lazy_model(
        "app.programs.program_list_model.ProgramListModel", partial(_programs, setup)
    )


def _programs(setup: PageSetup) -> ProgramListModel:
    from app.compose.program_list_desk import create_program_list

    return create_program_list(
        setup.desk, setup.persistence, setup.loading_steps, setup.program_folder, setup.draw_thumbnail
    )


def _register_part(setup: PageSetup) -> None:
    """Register the page that shows the findings and the stock."""
    from core.proving.checks.part_checks import PART_CHECKS

    machine = setup.machine
    held, of_machine = machine.clamping, frozenset(machine.silenced_checks)
    checks, holds = frozenset(PART_CHECKS), bool(held.diameter)
    sheet = PartPageModel(
        setup.desk, setup.persistence, checks, of_machine, held.stick_out, has_workholding=holds
    )
    setup.desk.page_registry.attach_model(sheet)


# --- Operation --------------------------------------------------------------------------------------------


def _register_lines(setup: PageSetup) -> None:
    """Register the MDI page, and the functions of the Jog page that execute MDI lines."""
    desk, machine = setup.desk, setup.machine
    prove_line = create_line_prover(machine, setup.read_offsets)
    if desk.start_watch is not None:
        prove_line = desk.start_watch.wrap_line_proof(prove_line)
    codes = partial(get_code_book, Dialect(machine.mdi_language))
    line = MdiInput(setup.persistence)
    mdi = MdiModel(prove_line, desk.post, desk.read_snapshot, desk.say, desk.clear_prompt_line, codes, line)
    for each in (mdi, ManualFunctions(desk, machine, prove_line)):
        desk.page_registry.attach_model(each)
        desk.page_registry.add_start_handler(each)


def _register_mill_touch(setup: PageSetup) -> None:
    if setup.machine.kind == "mill":
        from app.compose.machine.kinematics_chain import build_kinematics
        from app.offsets.mill_touch import MillTouchCalculator

        setup.desk.page_registry.attach_model(
            MillTouchCalculator(setup.desk, build_kinematics(setup.machine))
        )


def _register_searchto(setup: PageSetup) -> None:
    """Register SEARCHTO, the restart of a program at a chosen line.

    The restart moves at the manual rapid rate, but more slowly inside the part.
    """
    desk, rapid = setup.desk, setup.machine.limits.manual_rapid
    choices = OperatorChoices(approach_speed_outside_mm_s=rapid, inside_speed_mm_s=_MODEST_FRACTION * rapid)

    def prove_job(job: Job, watch: ProgressCallback) -> ProvedJob:
        proved = desk.program_loader.loading_steps.prove_job(job, watch)
        if desk.start_watch is None:
            return proved
        return desk.start_watch.add_first_move_check(job, proved, desk.read_snapshot(), watch)

    searchto = RestartModel(
        desk.program_loader,
        desk.post,
        desk.read_snapshot,
        desk.say,
        desk.clear_prompt_line,
        create_restart_search,
        prove_job,
        choices,
    )
    desk.page_registry.attach_model(searchto)
    desk.page_registry.add_start_handler(searchto)


# --- Production and special functions ---------------------------------------------------------------------


def register_sounds(setup: PageSetup) -> None:
    """Register the sounds of the operator screen, which the special functions also need."""
    sounds = EventSoundPlayer(setup.desk, setup.persistence)
    setup.desk.page_registry.attach_model(sounds)
    setup.desk.page_registry.add_frame_watcher(sounds.play_new_event_sounds)


def register_special_functions(setup: PageSetup) -> None:
    """Register the list of special functions (F10)."""
    make = partial(_special_functions, setup)
    setup.desk.page_registry.attach_lazy_model("app.special.special_functions.SpecialFunctionsModel", make)


def _special_functions(setup: PageSetup) -> SpecialFunctionsModel:
    from app.compose.special_functions_desk import create_special_functions

    sounds = setup.desk.page_registry.find_model(EventSoundPlayer)
    assert sounds is not None
    return create_special_functions(
        setup.desk, setup.machine, setup.persistence, setup.loading_steps, setup.program_folder, sounds
    )


def register_production(setup: PageSetup) -> None:
    """Register the models that count and store production data."""
    desk, tools = setup.desk, find_tool_table_kind(setup.machine.kind)
    book = (
        setup.journal.create_parts_book(tools)
        if setup.journal is not None
        else ProductionRecords(tool_table_kind=tools)
    )
    book.user_access = desk.user_access
    watch = ProductionMonitor(desk, book, ToolLifeMonitor(book, desk.desk_control.read_control_identity))
    desk.page_registry.attach_model(watch)
    desk.page_registry.add_run_watcher(watch)
    if tools is OffsetKind.MILL_TOOL:
        from app.offsets.mill_touch import MillToolLives

        lives = watch.tool_life_monitor
        lives_of_mill = MillToolLives(
            lives.find_tool_lives, lambda number, cut: lives.set_cutting_time(number, cut, desk.say)
        )
        desk.page_registry.attach_model(lives_of_mill)


def register_extras(setup: PageSetup) -> None:
    """Register the pages of the optional features."""
    for extra in extras().values():
        extra.attach_models(setup.desk, setup.machine, setup.journal, setup.proof_steps)


def _register_busy_notice(setup: PageSetup) -> None:
    setup.desk.page_registry.add_frame_watcher(BusyNotice(setup.desk.say).check_snapshot)


def register_scope_page(setup: PageSetup) -> None:
    """Register the SCOPE page."""
    register_scope(setup.desk, setup.live_samples)


PAGES: tuple[RegisterPage, ...] = (
    _register_effect,
    _register_editor,
    register_sounds,
    register_special_functions,
    register_programs,
    _register_lines,
    _register_mill_touch,
    _register_part,
    _register_searchto,
    register_production,
    register_extras,
    _register_busy_notice,
    register_scope_page,
)
"""Register functions of all pages, ordered so that each page follows the pages that it needs."""


def get_program_folder() -> Path:
    """Return the folder of the operator's programs."""
    return find_data_folder() / "programs"
