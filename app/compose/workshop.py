"""What loading needs: programs read, made jobs of, proved and drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.journal import Journal
from app.compose.machine import setup_for
from app.compose.offsets import Offsets
from app.compose.zero_offsets import Zero, stored_zero
from app.desk.data_folder import data_folder
from app.desk.latest import Watch
from app.desk.program_loading import LoadingSteps, Proved
from core.executor.job import Job, make_job
from core.interpreter.modal_state import Modal
from core.language.source import Dialect, Source, SourceError, load_source
from core.machine.model import Machine

if TYPE_CHECKING:
    from app.path.path_picture import Picture


def samples() -> Path:
    """The folder of the sample programs and their tool offsets."""
    return Path(str(files("resources"))) / "programs"


def workshop(
    machine: Machine,
    offsets: Callable[[], Offsets],
    journal: Journal | None = None,
    *,
    zero: Callable[[], Zero] = stored_zero,
    left: Callable[[], Modal] | None = None,
) -> LoadingSteps:
    """What loading needs; offsets, and unit and rapid rate that the job before has ``left``, are those of
    the moment of loading."""

    def new_job(source: Source, block_delete: bool) -> Job:
        if journal is not None:
            journal.keep(source)
        tools, secondary = offsets()
        setup = setup_for(machine, tools=tools, secondary=secondary, zero=zero(), block_delete=block_delete)
        if left is not None:
            modal = left()
            setup = replace(setup, metric=modal.metric, last_rapid=modal.rapid_rate)
        return make_job(_whole(source), setup)

    def prove_job(job: Job, watch: Watch) -> Proved:
        from app.compose.proof import proof_of
        from core.proving.prove_program import prove

        report = prove(job.reading, job.setup, machine, watch)
        return Proved(proof_of(job, report), report.diagnostics)

    def draw(job: Job, watch: Watch) -> Picture:
        from app.path.path_picture import sketched
        from core.proving.program_timeline import Timeline, timed_series

        return sketched(timed_series(Timeline.of(job.reading, job.setup, machine)), watch)

    def renewed(job: Job) -> Job:
        tools, secondary = offsets()
        setup = replace(job.setup, tools=tools, secondary=secondary, zero=zero())
        return replace(make_job(job.source, setup), reading=job.reading)

    return LoadingSteps(_read, new_job, prove_job, draw, renewed)


def _read(path: Path) -> Source:
    try:
        return _whole(load_source(path), path.parent)
    except SourceError as error:
        raise ValueError(str(error)) from error


def _whole(source: Source, *folders: Path) -> Source:
    """With the subprograms that it calls: from beside it, or from where programs are kept."""
    if source.dialect is not Dialect.SINUMERIK or source.subprograms:
        return source
    from core.language.sinumerik.subprogram_files import with_subprograms

    return with_subprograms(source, [*folders, data_folder() / "programs", samples()])
