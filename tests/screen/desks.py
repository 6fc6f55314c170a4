"""A desk on the scripted machine, loading real programs with the real interpreter and prover."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from app.compose.desk_pages import (
    PageSetup,
    own_folder,
    register_extras,
    register_pages,
    register_production,
    register_programs,
    register_scope_page,
    register_sounds,
    register_special_functions,
)
from app.compose.extra import drawing_endings
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import setup_for
from app.compose.runs.journal import Journal
from app.compose.workshop import drawer, proof_of
from app.desk.background_work import Watch
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import LoadingSteps, ProgramLoader, Proved
from app.desk.state.desk_clock import DeskClock
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.editor.editor import Editor
from app.editor.versions import Archive, NoArchive
from app.jog.hand_functions import HandFunctions
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_effect import Effect
from app.path.path_picture import Picture, picture_of
from app.scope.scope_curves import LiveSamples
from core.executor.job import Job
from core.executor.snapshot import Snapshot
from core.interpreter.dialects import ReadProgram
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import Source, load_source
from core.proving.program_timeline import Timeline, timed_blocks
from core.proving.prove_program import prove
from tests.screen.fake import FakeMachine

SAMPLES = Path(__file__).parents[2] / "resources" / "programs"
PAGES = (
    register_sounds,
    register_special_functions,
    register_programs,
    register_scope_page,
    register_production,
    register_extras,
)
TOOLS = {n: ToolOffset(x, z) for n, x, z in ((1, -12.7, -76.2), (2, 6.35, -63.5), (3, -25.4, -81.28))}


def desk_on(
    machine: FakeMachine,
    *folders: Path,
    two_hand: bool = True,
    one_hand: bool = False,
    archive: Archive | None = None,
    keep: Persistence | None = None,
    live: LiveSamples | None = None,
    book: OffsetBook | None = None,
) -> Desk:
    """A desk with the simulated station, on these folders or on the samples."""
    lathe = load_machine(None)

    built: list[Desk] = []

    def make_job(source: Source, block_delete: bool) -> Job:
        setup = setup_for(lathe, tools=TOOLS, secondary=_secondary(built[0]), block_delete=block_delete)
        return Job(source, setup, f"{source.name}{block_delete}", ReadProgram(source), frozenset(TOOLS))

    def proved(job: Job, watch: Watch) -> Proved:
        report = prove(job.source, job.setup, lathe, watch)
        return Proved(proof_of(job, report), report.diagnostics)

    def draw(job: Job, watch: Watch) -> Picture:
        machine.blocks = list(timed_blocks(Timeline.of(job.source, job.setup, lathe)))
        return picture_of(machine.blocks, watch)

    def renewed(job: Job) -> Job:
        setup = replace(job.setup, secondary=_secondary(built[0]))
        return replace(job, setup=setup, digest=f"{job.digest} {sorted(setup.secondary.items())}")

    work = LoadingSteps(load_source, make_job, proved, draw, renewed)
    archive = archive or NoArchive()
    own = folders[0] if folders else None
    persistence = keep or Persistence()
    desk = Desk(
        DeskControl(machine.post, machine.snapshot, machine),
        ProgramLoader(work, machine.post),
        ProgramFolders(folders or (SAMPLES,), drawing_endings()),
        machine=DeskMachine("GT-75 SIMULATED", lathe, two_hand=two_hand, one_hand=one_hand),
        persistence=persistence,
        book=book,
        clock=DeskClock(time_of_day=lambda: "09:41:07"),
    )
    desk.pages.attach(Effect(drawer(lathe)))
    desk.pages.attach(Editor(work, archive, own or Path("/dev/null"), SAMPLES))
    hand = HandFunctions(desk, lathe, unproved)
    desk.pages.attach(hand)
    desk.pages.add_start(hand)
    setup = PageSetup(
        desk=desk,
        machine=lathe,
        persistence=persistence,
        journal=keep if isinstance(keep, Journal) else None,
        own=own or own_folder(),
        work=work,
        proving=work,
        live=live,
    )
    register_pages(setup, PAGES)
    built.append(desk)
    machine.hear = desk.hear
    return desk


def unproved(text: str, _snapshot: Snapshot, _watch: Watch) -> tuple[Job, Proved]:
    """No line is chosen by hand on this desk."""
    raise AssertionError(f"{text} was to be proved")


def _secondary(desk: Desk) -> dict[int, SecondaryOffset]:
    return {n: SecondaryOffset(*values) for n, values in desk.book.secondary.items()}
