"""A desk on the scripted machine, loading real programs with the real interpreter and prover."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from app.compose.desk_pages import (
    PageSetup,
    get_program_folder,
    register_extras,
    register_pages,
    register_production,
    register_programs,
    register_scope_page,
    register_sounds,
    register_special_functions,
)
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.optional_features import list_drawing_suffixes
from app.compose.program_proving import create_path_drawer, create_proof
from app.compose.runs.journal import Journal
from app.desk.background_work import ProgressCallback
from app.desk.desk import Desk
from app.desk.pages.attached_parts import ClosingSequence
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import LoadingSteps, ProgramLoader, ProvedJob
from app.desk.state.desk_clock import DeskClock
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.editor.editor_model import EditorModel
from app.editor.version_history import NullVersionArchive, VersionArchive
from app.jog.manual_functions import ManualFunctions
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_effect import OffsetEffectWorker
from app.path.path_picture import ProgramPicture, build_picture
from app.scope.scope_curves import LiveSamples
from core.executor.job import Job
from core.executor.snapshot import Snapshot
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource, load_source
from core.proving.program_timeline import Timeline, iter_timed_blocks
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
    archive: VersionArchive | None = None,
    keep: Persistence | None = None,
    live: LiveSamples | None = None,
    book: OffsetBook | None = None,
    closing: ClosingSequence | None = None,
) -> Desk:
    """A desk with the simulated station, on these folders or on the samples."""
    lathe = load_machine(None)

    built: list[Desk] = []

    def make_job(source: ProgramSource, block_delete: bool) -> Job:
        setup = create_power_up_setup(
            lathe, tool_offsets=TOOLS, secondary_offsets=_secondary(built[0]), block_delete=block_delete
        )
        return Job(source, setup, f"{source.name}{block_delete}", SharedProgram(source), frozenset(TOOLS))

    def proved(job: Job, watch: ProgressCallback) -> ProvedJob:
        report = prove(job.source, job.setup, lathe, watch)
        return ProvedJob(create_proof(job, report), report.diagnostics)

    def draw(job: Job, watch: ProgressCallback) -> ProgramPicture:
        machine.blocks = list(iter_timed_blocks(Timeline.from_program(job.source, job.setup, lathe)))
        return build_picture(machine.blocks, watch)

    def renewed(job: Job) -> Job:
        setup = replace(job.setup, secondary=_secondary(built[0]))
        return replace(job, setup=setup, digest=f"{job.digest} {sorted(setup.secondary.items())}")

    work = LoadingSteps(load_source, make_job, proved, draw, renewed)
    archive = archive or NullVersionArchive()
    own = folders[0] if folders else None
    persistence = keep or Persistence()
    desk = Desk(
        DeskControl(machine.post, machine.snapshot, machine),
        ProgramLoader(work, machine.post),
        ProgramFolders(folders or (SAMPLES,), list_drawing_suffixes()),
        machine=DeskMachine(
            "GT-75 SIMULATED", lathe, has_two_hand_start=two_hand, allows_one_hand_start=one_hand
        ),
        persistence=persistence,
        offset_book=book,
        clock=DeskClock(format_local_time=lambda: "09:41:07"),
        closing_sequence=closing,
    )
    desk.page_registry.attach_model(OffsetEffectWorker(create_path_drawer(lathe)))
    desk.page_registry.attach_model(EditorModel(work, archive, own or Path("/dev/null"), SAMPLES))
    hand = ManualFunctions(desk, lathe, unproved)
    desk.page_registry.attach_model(hand)
    desk.page_registry.add_start_handler(hand)
    setup = PageSetup(
        desk=desk,
        machine=lathe,
        persistence=persistence,
        journal=keep if isinstance(keep, Journal) else None,
        program_folder=own or get_program_folder(),
        loading_steps=work,
        proof_steps=work,
        live_samples=live,
    )
    register_pages(setup, PAGES)
    built.append(desk)
    machine.hear = desk.hear
    return desk


def unproved(text: str, _snapshot: Snapshot, _watch: ProgressCallback) -> tuple[Job, ProvedJob]:
    """No line is chosen by hand on this desk."""
    raise AssertionError(f"{text} was to be proved")


def _secondary(desk: Desk) -> dict[int, SecondaryOffset]:
    return {n: SecondaryOffset(*values) for n, values in desk.offset_book.secondary_offsets.items()}
