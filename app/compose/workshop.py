"""Proving on this machine: programs, MDI lines, restarts, and the effect of other offsets on a path."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.desk_part import KeptOfProgram, PartDesk, Shapes, nothing_kept
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import Offsets, setup_with
from app.compose.thumbnails import HIGH, WIDE, Thumbnails
from app.desk.background_work import Watch
from app.desk.data_folder import data_folder
from app.desk.programs.prepared_line import ProveLine
from app.desk.programs.program_loading import LoadingSteps, PartProved, Proved
from core.executor.job import Job, Proof, make_job
from core.executor.snapshot import Snapshot
from core.interpreter.shared.checkpoint import Begin, Checkpoint
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import Diagnostic
from core.language.source import Dialect, Source, SourceError, load_source
from core.machine.machine_model import Machine
from core.proving.proof_report import Report

if TYPE_CHECKING:
    from app.desk.background_work import Watch
    from app.offsets.offset_effect import ComparePart, Draw
    from app.path.path_picture import Picture, Timed
    from app.programs.program_rows import DrawThumbnail
    from app.searchto.searchto_finder import Search
    from core.proving.program_timeline import MotionSpan, RestSpan


def samples() -> Path:
    """Return the folder with the sample programs and their tool offsets."""
    return Path(str(files("resources"))) / "programs"


def workshop(
    machine: Machine,
    offsets: Callable[[], Offsets],
    journal: Journal | None = None,
    *,
    left: Callable[[], Modal] | None = None,
    shapes: Shapes = dict,
    kept: KeptOfProgram = nothing_kept,
    pictures: bool = True,
) -> LoadingSteps:
    """Return the functions that load a program.

    Offsets, tool shapes, and the unit and rapid rate that the previous job has ``left`` are read at the time
    of loading, and so are the stored data of a program's part. ``pictures`` means that programs are drawn and
    their parts proved.
    """

    def new_job(source: Source, block_delete: bool) -> Job:
        if journal is not None:
            journal.keep(source)
        setup = setup_with(machine, offsets(), block_delete=block_delete)
        if left is not None:
            modal = left()
            setup = replace(setup, metric=modal.metric, last_rapid=modal.rapid_rate)
        return make_job(_whole(source), setup)

    def renewed(job: Job) -> Job:
        now = setup_with(machine, offsets(), block_delete=job.setup.block_delete)
        setup = replace(now, metric=job.setup.metric, last_rapid=job.setup.last_rapid)
        return replace(make_job(job.source, setup), reading=job.reading)

    parts = PartDesk(machine, shapes, kept, _read)
    passes = _ProofAndPicture(machine, parts, pictures=pictures)
    return LoadingSteps(_read, new_job, passes.prove, passes.draw, renewed, passes.part)


class _ProofAndPicture:
    """Proof and picture of a program in one pass; the picture is stored until it is requested."""

    def __init__(self, machine: Machine, parts: PartDesk, *, pictures: bool) -> None:
        self._machine, self._parts = machine, parts
        self._pictures = pictures
        self._drawn: tuple[Job, Picture] | None = None  # picture of the job that was proved last
        self._trouble: Diagnostic | None = None  # finding about its stock, or None

    def prove(self, job: Job, watch: Watch) -> Proved:
        from app.path.path_picture import PictureBuilder
        from core.proving.part_history import PartGathering
        from core.proving.prove_program import prove

        millimetres = job.setup.metric or job.source.dialect is not Dialect.OMNITURN
        self._drawn, sketch = None, PictureBuilder(millimetres)
        gathered, waits = None, False
        if self._pictures and self._machine.kind == "lathe":
            setting, self._trouble = self._parts.setting(job, watch)
            gathered = PartGathering(setting)

        def seen(span: MotionSpan | RestSpan) -> None:
            for each in span.times_of_parts():
                sketch.add_timed(each)
            if gathered is not None:
                gathered.see(span)

        report = prove(job.reading, job.setup, self._machine, watch, seen=seen if self._pictures else None)
        if self._pictures:
            part, why = (gathered.moves(), gathered.too_many) if gathered is not None else (None, "")
            waits = part is not None and part.setting.may_refuse
            self._drawn = job, replace(sketch.picture(), part=part, no_part=why)
        return Proved(proof_of(job, report), report.diagnostics, waits)

    def part(self, picture: Picture, watch: Watch) -> PartProved | None:
        """Return the proof of the part of the job that was drawn last, or None without a part."""
        if picture.part is None:
            return PartProved(trouble=picture.no_part) if picture.no_part else None
        return self._parts.proved(picture.part, self._trouble, watch)

    def draw(self, job: Job, watch: Watch) -> Picture:
        from app.path.path_picture import picture_of
        from core.proving.program_timeline import Timeline, timed_series

        drawn, self._drawn = self._drawn, None
        if drawn is not None and drawn[0] is job:
            return drawn[1]
        return picture_of(timed_series(Timeline.of(job.reading, job.setup, self._machine)), watch)


def _read(path: Path) -> Source:
    try:
        return _whole(load_source(path), path.parent)
    except SourceError as error:
        raise ValueError(str(error)) from error


def _whole(source: Source, *folders: Path) -> Source:
    """Return the program with the subprograms that it calls, from its folder or the program folders."""
    from core.language.called_files import with_called_files

    return with_called_files(source, [*folders, data_folder() / "programs", samples()])


# --- Conversion of the proof report to the proof that the executor requires before a start.


def proof_of(job: Job, report: Report) -> Proof:
    """Return the proof of this job; the report must be of this job's text and context."""
    return Proof(
        digest=job.digest,
        errors=tuple(d.in_one_line(job.source.name) for d in report.errors),
        blocks=report.elementary,
        cycle_time=report.times.cycle,
        tools=report.tools,
        measured=tuple(sorted({*report.tools} - {*report.missing_tools})),
        needs=report.needs,
    )


# --- Drawing a program with other offsets, to show the effect of an offset change on its path.


def part_comparer(machine: Machine, shapes: Shapes = dict, kept: KeptOfProgram = nothing_kept) -> ComparePart:
    """Return a function that compares the parts of a job with two sets of offsets."""
    return PartDesk(machine, shapes, kept, _read).compared


def thumbnails(
    machine: Machine, shapes: Shapes, kept: KeptOfProgram, size: tuple[int, int] = (WIDE, HIGH)
) -> DrawThumbnail:
    """Return a function that draws the finished part of a job and stores it in the data folder.

    ``size`` is in pixels.
    """
    parts = PartDesk(machine, shapes, kept, _read)
    return Thumbnails(data_folder() / "thumbnails", machine, parts, *size).of


def drawer(machine: Machine) -> Draw:
    """Return a function that draws a job, each tool with the offset that is given for it."""

    def draw(job: Job, frame: Mapping[int, ToolOffset], watch: Watch) -> Picture:
        from app.path.path_picture import picture_of
        from core.proving.program_timeline import Timeline, timed_blocks

        blocks = timed_blocks(Timeline.of(job.reading, job.setup, machine))
        return picture_of(_seen(blocks, frame), watch)

    return draw


def _seen(blocks: Iterator[Timed], frame: Mapping[int, ToolOffset]) -> Iterator[Timed]:
    """Yield the blocks with part zero where the offsets of ``frame`` put it."""
    for block, start, end in blocks:
        modal = block.modal
        offset = frame.get(modal.tool, ToolOffset())
        if (modal.tool_x, modal.tool_z) == (offset.x, offset.z):
            yield block, start, end
        else:
            yield replace(block, modal=modal._replace(tool_x=offset.x, tool_z=offset.z)), start, end


# --- MDI: proof of its lines on this machine.


def point_of(snapshot: Snapshot) -> Checkpoint:
    """Return the modal state that the next line inherits from the machine now."""
    return Checkpoint(snapshot.modal, tool_line=-1 if snapshot.tool_open else 0, kept=snapshot.kept)


def line_prover(machine: Machine, offsets: Callable[[], Offsets]) -> ProveLine:
    """Return a function that proves an MDI line like a program, from the present position of the axes."""

    def prove_line(text: str, snapshot: Snapshot, watch: Watch) -> tuple[Job, Proved]:
        from core.proving.prove_program import prove

        setup = replace(
            setup_with(machine, offsets()),
            start=snapshot.demand,
            begin=Begin(point_of(snapshot), single=True),
        )
        job = make_job(Source("MDI", text, Dialect(machine.language)), setup)
        report = prove(job.reading, job.setup, machine, watch)
        return job, Proved(proof_of(job, report), report.diagnostics)

    return prove_line


# --- SEARCHTO on this machine.


def rebuilt(job: Job, watch: Watch) -> Search:
    """Return the search through the program of a job; the interpreter is loaded when it is first used."""
    if job.source.dialect is not Dialect.OMNITURN:
        from core.interpreter.restart.program_search import ProgramSearch

        return ProgramSearch(job.reading, job.setup, watch)
    from core.interpreter.restart.state_rebuild import StateRebuild

    return StateRebuild(job.source, job.setup, watch)
