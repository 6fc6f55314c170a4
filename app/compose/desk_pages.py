"""Table of the functions that register the pages of the operator screen.

Each function takes a ``PageSetup`` and registers with ``desk.pages`` one model, or a model that is created on
its first use.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.desk_part import KeptOfProgram, nothing_kept
from app.compose.extra import extras
from app.compose.runs.journal import Journal
from app.compose.scope_desk import register_scope
from app.compose.stored_offsets import Offsets, shapes_at_hand, stored_offsets
from app.compose.workshop import drawer, line_prover, part_comparer, rebuilt, samples, workshop
from app.desk.background_work import Watch
from app.desk.data_folder import data_folder
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps, Proved
from app.desk.status.busy_notice import BusyNotice
from app.jog.hand_functions import HandFunctions
from app.mdi.mdi_model import MdiLine, MdiModel
from app.offsets.offset_effect import Effect
from app.part.part_sheet import PartSheet
from app.production.parts_book import PartsBook, tools_of
from app.production.parts_watch import PartsWatch
from app.production.tool_life_watch import ToolLifeWatch
from app.searchto.searchto_model import SearchtoModel
from app.special.lamps_and_sound import DeskSounds
from core.access.access_table import Act
from core.executor.job import Job
from core.interpreter.dialects import code_book
from core.interpreter.restart.restart_approach import Choices
from core.language.source import Dialect, usual_ending
from core.machine.machine_model import Machine
from core.store.store_rows import Kind

if TYPE_CHECKING:
    from app.editor.editor import Editor
    from app.programs.program_list import ProgramList
    from app.programs.program_rows import DrawThumbnail
    from app.scope.scope_curves import LiveSamples
    from app.special.special_functions import SpecialFunctions

_MODEST = 0.2  # fraction of the manual rapid, for moves inside the part


@dataclass(frozen=True, slots=True, kw_only=True)
class PageSetup:
    """Objects from which the pages are made.

    ``own`` is the folder of the operator's programs. ``work`` reads and proves programs with the present
    offsets and saves nothing; ``proving`` does the same without pictures. ``thumbnail`` draws the part of a
    program. ``live`` are samples for the scope, or None for those of the control. Nothing is saved if
    ``journal`` is None.
    """

    desk: Desk
    machine: Machine
    persistence: Persistence
    journal: Journal | None
    own: Path
    work: LoadingSteps
    proving: LoadingSteps
    offsets: Callable[[], Offsets] = stored_offsets
    kept: KeptOfProgram = nothing_kept
    thumbnail: DrawThumbnail | None = None
    live: LiveSamples | None = None


RegisterPage = Callable[[PageSetup], None]


def register_pages(setup: PageSetup, pages: Iterable[RegisterPage]) -> None:
    """Register these pages in order."""
    for register in pages:
        register(setup)


# --- Programs ---------------------------------------------------------------------------------------------


def _register_effect(setup: PageSetup) -> None:
    compare = part_comparer(setup.machine, shapes_at_hand, setup.kept)
    setup.desk.pages.attach(Effect(drawer(setup.machine), compare))


def _register_editor(setup: PageSetup) -> None:
    setup.desk.pages.attach_later("app.editor.editor.Editor", partial(_editor, setup))


def _editor(setup: PageSetup) -> Editor:
    """Return the editor, which proves the edited text without saving a version for each key press."""
    from app.editor.editor import Editor
    from app.editor.versions import NoArchive

    desk, machine = setup.desk, setup.machine
    work = workshop(
        machine,
        setup.offsets,
        left=lambda: desk.snapshot().modal,
        shapes=shapes_at_hand,
        kept=setup.kept,
    )
    ending = usual_ending(Dialect(machine.language))
    editor = Editor(work, setup.journal or NoArchive(), setup.own, samples(), usual_ending=ending)
    editor.may_save = lambda: desk.access.refusal(Act.PROGRAMS)
    return editor


def register_programs(setup: PageSetup) -> None:
    """Register the list of programs."""
    setup.desk.pages.attach_later("app.programs.program_list.ProgramList", partial(_programs, setup))


def _programs(setup: PageSetup) -> ProgramList:
    from app.compose.program_list_desk import program_list

    return program_list(setup.desk, setup.persistence, setup.work, setup.own, setup.thumbnail)


def _register_part(setup: PageSetup) -> None:
    """Register the page with findings and stock."""
    from core.proving.checks.part_checks import CHECKS

    machine = setup.machine
    held, of_machine = machine.clamping, frozenset(machine.silenced)
    checks, holds = frozenset(CHECKS), bool(held.diameter)
    sheet = PartSheet(setup.desk, setup.persistence, checks, of_machine, held.stick_out, holds=holds)
    setup.desk.pages.attach(sheet)


# --- Operation --------------------------------------------------------------------------------------------


def _register_lines(setup: PageSetup) -> None:
    """Register MDI, and the functions of the Jog page that use MDI lines."""
    desk, machine = setup.desk, setup.machine
    prove_line = line_prover(machine, setup.offsets)
    if desk.first_move is not None:
        prove_line = desk.first_move.with_lines(prove_line)
    codes = partial(code_book, Dialect(machine.language))
    line = MdiLine(setup.persistence)
    mdi = MdiModel(prove_line, desk.post, desk.snapshot, desk.say, desk.clear, codes, line)
    for each in (mdi, HandFunctions(desk, machine, prove_line)):
        desk.pages.attach(each)
        desk.pages.add_start(each)


def _register_mill_touch(setup: PageSetup) -> None:
    if setup.machine.kind == "mill":
        from app.compose.machine.kinematics_chain import kinematics_of
        from app.offsets.mill_touch import MillTouch

        setup.desk.pages.attach(MillTouch(setup.desk, kinematics_of(setup.machine)))


def _register_searchto(setup: PageSetup) -> None:
    """Register SEARCHTO, which moves at the manual rapid, and slower inside the part."""
    desk, rapid = setup.desk, setup.machine.limits.manual_rapid
    choices = Choices(rapid=rapid, modest=_MODEST * rapid)

    def prove(job: Job, watch: Watch) -> Proved:
        proved = desk.session.workshop.prove(job, watch)
        if desk.first_move is None:
            return proved
        return desk.first_move.checked(job, proved, desk.snapshot(), watch)

    searchto = SearchtoModel(
        desk.session, desk.post, desk.snapshot, desk.say, desk.clear, rebuilt, prove, choices
    )
    desk.pages.attach(searchto)
    desk.pages.add_start(searchto)


# --- Production and special functions ---------------------------------------------------------------------


def register_sounds(setup: PageSetup) -> None:
    """Register the sounds of the screen, which the special functions need."""
    sounds = DeskSounds(setup.desk, setup.persistence)
    setup.desk.pages.attach(sounds)
    setup.desk.pages.add_frame_watcher(sounds.see)


def register_special_functions(setup: PageSetup) -> None:
    """Register the special functions (F10)."""
    make = partial(_special_functions, setup)
    setup.desk.pages.attach_later("app.special.special_functions.SpecialFunctions", make)


def _special_functions(setup: PageSetup) -> SpecialFunctions:
    from app.compose.special_functions_desk import special_functions

    sounds = setup.desk.pages.find(DeskSounds)
    assert sounds is not None
    return special_functions(setup.desk, setup.machine, setup.persistence, setup.work, setup.own, sounds)


def register_production(setup: PageSetup) -> None:
    """Register the models that count and store production data."""
    desk, tools = setup.desk, tools_of(setup.machine.kind)
    book = setup.journal.parts_book(tools) if setup.journal is not None else PartsBook(tools=tools)
    book.access = desk.access
    watch = PartsWatch(desk, book, ToolLifeWatch(book, desk.control.identity))
    desk.pages.attach(watch)
    desk.pages.add_run_watcher(watch)
    if tools is Kind.MILL_TOOL:
        from app.offsets.mill_touch import MillLives

        lives = watch.lives
        lives_of_mill = MillLives(lives.lives, lambda number, cut: lives.set_used(number, cut, desk.say))
        desk.pages.attach(lives_of_mill)


def register_extras(setup: PageSetup) -> None:
    """Register the pages of the optional features."""
    for extra in extras().values():
        extra.attach(setup.desk, setup.machine, setup.journal, setup.proving)


def _register_busy_notice(setup: PageSetup) -> None:
    setup.desk.pages.add_frame_watcher(BusyNotice(setup.desk.say).see)


def register_scope_page(setup: PageSetup) -> None:
    """Register the SCOPE page."""
    register_scope(setup.desk, setup.live)


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
"""All pages of a desk. A page comes after the pages that it needs."""


def own_folder() -> Path:
    """Return the folder of the operator's programs."""
    return data_folder() / "programs"
