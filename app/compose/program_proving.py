"""Proving of programs, MDI lines and restarts on this machine.

The module also draws the tool path. After a change of offsets, it compares the new part with the old part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.part_prover import PartProver, ReadShapes, ReadStoredPart, get_empty_stored_part
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import Offsets, create_setup_with_offsets
from app.compose.thumbnails import HIGH, WIDE, ThumbnailCache
from app.desk.background_work import ProgressCallback
from app.desk.data_folder import find_data_folder
from app.desk.programs.prepared_line import ProveLine
from app.desk.programs.program_loading import LoadingSteps, PartProof, ProvedJob
from core.executor.job import Job, Proof, make_job
from core.executor.snapshot import Snapshot
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import Diagnostic
from core.language.source import Dialect, ProgramSource, SourceError, load_source
from core.machine.machine_model import Machine
from core.proving.proof_report import ProofReport

if TYPE_CHECKING:
    from app.desk.background_work import ProgressCallback
    from app.offsets.offset_effect import ComparePart, DrawPaths
    from app.path.path_picture import ProgramPicture, TimedBlocks
    from app.programs.program_rows import DrawThumbnail
    from app.searchto.restart_finder import RestartSearch
    from core.proving.program_timeline import MotionSpan, RestSpan


def get_samples_folder() -> Path:
    """Return the folder with the sample programs and their tool offsets."""
    return Path(str(files("resources"))) / "programs"


def create_loading_steps(
    machine: Machine,
    read_offsets: Callable[[], Offsets],
    journal: Journal | None = None,
    *,
    read_modal_state: Callable[[], ModalState] | None = None,
    read_shapes: ReadShapes = dict,
    read_stored_part: ReadStoredPart = get_empty_stored_part,
    draw_pictures: bool = True,
) -> LoadingSteps:
    """Return the functions that load a program.

    Offsets, tool shapes and the stored part data of a program are read at the time of loading. The unit and
    the rapid rate of the previous job are read from ``read_modal_state``, also at the time of loading. If
    ``draw_pictures`` is true, programs are drawn and their parts proved.
    """

    def make_new_job(source: ProgramSource, block_delete: bool) -> Job:
        if journal is not None:
            journal.keep(source)
        setup = create_setup_with_offsets(machine, read_offsets(), block_delete=block_delete)
        if read_modal_state is not None:
            modal = read_modal_state()
            setup = replace(setup, metric=modal.metric, last_rapid=modal.rapid_rate)
        return make_job(_read_complete(source), setup)

    def renew_job(job: Job) -> Job:
        now = create_setup_with_offsets(machine, read_offsets(), block_delete=job.setup.block_delete)
        setup = replace(now, metric=job.setup.metric, last_rapid=job.setup.last_rapid)
        return replace(make_job(job.source, setup), shared_program=job.shared_program)

    parts = PartProver(machine, read_shapes, read_stored_part, _read)
    passes = _ProofAndPicture(machine, parts, pictures=draw_pictures)
    return LoadingSteps(
        _read, make_new_job, passes.prove_job, passes.draw_picture, renew_job, passes.prove_part
    )


class _ProofAndPicture:
    """Proof and picture of a program, made in a single pass. The picture is stored until it is requested."""

    def __init__(self, machine: Machine, parts: PartProver, *, pictures: bool) -> None:
        self._machine, self._parts = machine, parts
        self._pictures = pictures
        self._drawn: tuple[Job, ProgramPicture] | None = None  # picture of the job that was proved last
        self._trouble: Diagnostic | None = None  # finding about its stock, or None

    def prove_job(self, job: Job, report_progress: ProgressCallback) -> ProvedJob:
        from app.path.path_picture import PictureBuilder
        from core.proving.part_history import StepCollector
        from core.proving.prove_program import prove

        millimetres = job.setup.metric or job.source.dialect is not Dialect.OMNITURN
        self._drawn, sketch = None, PictureBuilder(millimetres)
        gathered, waits = None, False
        if self._pictures and self._machine.kind == "lathe":
            setting, self._trouble = self._parts.read_part_settings(job, report_progress)
            gathered = StepCollector(setting)

        def add_span(span: MotionSpan | RestSpan) -> None:
            for each in span.iter_group_times():
                sketch.add_timed_blocks(each)
            if gathered is not None:
                gathered.add_span(span)

        report = prove(
            job.shared_program,
            job.setup,
            self._machine,
            report_progress,
            on_span=add_span if self._pictures else None,
        )
        if self._pictures:
            part, why = (
                (gathered.make_program_steps(), gathered.overflow_reason)
                if gathered is not None
                else (None, "")
            )
            waits = part is not None and part.part_settings.can_refuse_start
            self._drawn = job, replace(sketch.build_picture(), part=part, no_part=why)
        return ProvedJob(create_proof(job, report), report.diagnostics, waits)

    def prove_part(self, picture: ProgramPicture, report_progress: ProgressCallback) -> PartProof | None:
        """Return the proof of the part in the picture, or None if the job does not make a part."""
        if picture.part is None:
            return PartProof(error_text=picture.no_part) if picture.no_part else None
        return self._parts.prove_part(picture.part, self._trouble, report_progress)

    def draw_picture(self, job: Job, report_progress: ProgressCallback) -> ProgramPicture:
        from app.path.path_picture import build_picture
        from core.proving.program_timeline import Timeline, iter_timed_series

        drawn, self._drawn = self._drawn, None
        if drawn is not None and drawn[0] is job:
            return drawn[1]
        return build_picture(
            iter_timed_series(Timeline.from_program(job.shared_program, job.setup, self._machine)),
            report_progress,
        )


def _read(path: Path) -> ProgramSource:
    try:
        return _read_complete(load_source(path), path.parent)
    except SourceError as error:
        raise ValueError(str(error)) from error


def _read_complete(source: ProgramSource, *folders: Path) -> ProgramSource:
    """Return the program with its subprograms, which are in its own folder or the program folders."""
    from core.language.called_files import load_called_files

    return load_called_files(source, [*folders, find_data_folder() / "programs", get_samples_folder()])


# --- Conversion of the proof report to the proof that the executor requires before a start.


def create_proof(job: Job, report: ProofReport) -> Proof:
    """Return the proof of this job for the executor.

    ``report`` must be from the same program text and setup as the job.
    """
    return Proof(
        digest=job.digest,
        errors=tuple(d.format_one_line(job.source.name) for d in report.errors),
        block_count=report.elementary_block_count,
        cycle_time_s=report.program_times.cycle_time_s,
        tool_numbers=report.tool_numbers,
        measured_tools=tuple(sorted({*report.tool_numbers} - {*report.missing_tool_numbers})),
        required_functions=report.required_functions,
    )


# --- Drawing a program with other offsets, to show the effect of an offset change on its path.


def create_part_comparer(
    machine: Machine, read_shapes: ReadShapes = dict, read_stored_part: ReadStoredPart = get_empty_stored_part
) -> ComparePart:
    """Return a function that compares the parts that a job makes with two sets of offsets."""
    return PartProver(machine, read_shapes, read_stored_part, _read).compare_parts


def create_thumbnail_drawer(
    machine: Machine,
    read_shapes: ReadShapes,
    read_stored_part: ReadStoredPart,
    size_px: tuple[int, int] = (WIDE, HIGH),
) -> DrawThumbnail:
    """Return a function that draws the finished part of a job and saves the drawing in the data folder.

    ``size_px`` is in pixels.
    """
    parts = PartProver(machine, read_shapes, read_stored_part, _read)
    return ThumbnailCache(find_data_folder() / "thumbnails", machine, parts, *size_px).get_thumbnail


def create_path_drawer(machine: Machine) -> DrawPaths:
    """Return a function that draws the tool path of a job with specified tool offsets."""

    def draw_path(job: Job, frame: Mapping[int, ToolOffset], watch: ProgressCallback) -> ProgramPicture:
        from app.path.path_picture import build_picture
        from core.proving.program_timeline import Timeline, iter_timed_blocks

        blocks = iter_timed_blocks(Timeline.from_program(job.shared_program, job.setup, machine))
        return build_picture(_shift_part_zero(blocks, frame), watch)

    return draw_path


def _shift_part_zero(blocks: Iterator[TimedBlocks], frame: Mapping[int, ToolOffset]) -> Iterator[TimedBlocks]:
    """Yield the blocks with part zero moved to the position that the tool offsets ``frame`` define."""
    for block, start, end in blocks:
        modal = block.modal
        offset = frame.get(modal.tool, ToolOffset())
        if (modal.tool_offset_x, modal.tool_offset_z) == (offset.x, offset.z):
            yield block, start, end
        else:
            yield (
                replace(block, modal=modal._replace(tool_offset_x=offset.x, tool_offset_z=offset.z)),
                start,
                end,
            )


# --- MDI: proof of its lines on this machine.


def make_checkpoint(snapshot: Snapshot) -> Checkpoint:
    """Return the current modal state of the machine, which the next MDI line inherits."""
    return Checkpoint(
        snapshot.modal, tool_line=-1 if snapshot.is_tool_move_pending else 0, kept=snapshot.kept
    )


def create_line_prover(machine: Machine, read_offsets: Callable[[], Offsets]) -> ProveLine:
    """Return a function that proves an MDI line as if it were a program.

    The line starts at the current position of the axes.
    """

    def prove_line(text: str, snapshot: Snapshot, watch: ProgressCallback) -> tuple[Job, ProvedJob]:
        from core.proving.prove_program import prove

        setup = replace(
            create_setup_with_offsets(machine, read_offsets()),
            start=snapshot.demand,
            begin=PassStart(make_checkpoint(snapshot), is_mdi_line=True),
        )
        job = make_job(ProgramSource("MDI", text, Dialect(machine.mdi_language)), setup)
        report = prove(job.shared_program, job.setup, machine, watch)
        return job, ProvedJob(create_proof(job, report), report.diagnostics)

    return prove_line


# --- SEARCHTO on this machine.


def create_restart_search(job: Job, report_progress: ProgressCallback) -> RestartSearch:
    """Return the search for restart lines in a job's program.

    The interpreter is loaded on first use.
    """
    if job.source.dialect is not Dialect.OMNITURN:
        from core.interpreter.restart.program_search import RestartLineSearch

        return RestartLineSearch(job.shared_program, job.setup, report_progress)
    from core.interpreter.restart.state_rebuild import OmniturnRestartSearch

    return OmniturnRestartSearch(job.source, job.setup, report_progress)
