"""Setup of the job queue, including the proof of queued programs."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.compose.part_prover import PartProver
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import try_read_shapes
from app.desk.background_work import ProgressCallback
from app.desk.desk import Desk
from app.desk.page_description import ProgramKey
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps
from app.desk.stored_part import load_stored_part
from app.desk.translation import tr
from app.extras.jobs.jobs_model import JobsModel
from app.extras.jobs.jobs_watch import BOOK_KEY, JobProofs, JobWatch, ProvedJob
from app.production.parts_watch import ProductionMonitor
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store_rows import ToolOffsetRow

LastStartReader = Callable[[str], tuple[str, dict[int, ToolOffsetRow]]]
"""Function that returns the time of the last start of a program and its tools at that time.

It is called on the worker thread.
"""


def attach_jobs(desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps) -> None:
    """Attach the job queue to TurnDesk, with its page and its key in the program list."""
    parts = desk.page_registry.find_model(ProductionMonitor)
    if parts is None:
        return
    kept = partial(load_stored_part, (journal or Persistence()).read_setting)
    of_part = PartProver(machine, try_read_shapes, kept, loading_steps.read_source)
    before = journal.read_last_run_tools if journal is not None else _never
    parts.production_records.feature_readers[BOOK_KEY] = lambda store, _program: store.jobs.read_jobs()
    watch = JobWatch(desk, parts, JobProofs(partial(_proved, desk, machine, loading_steps, of_part, before)))
    desk.page_registry.attach_model(watch)
    desk.page_registry.add_run_watcher(watch)
    model = JobsModel(desk, watch)
    desk.page_registry.attach_model(model)
    desk.page_registry.add_program_key("F10", ProgramKey("JOB", "JOBS", model.start_job_entry))
    desk.page_registry.set_notice_finder(watch.make_notice)


def _proved(
    desk: Desk,
    machine: Machine,
    steps: LoadingSteps,
    of_part: PartProver,
    before: LastStartReader,
    program: str,
    watch: ProgressCallback,
) -> ProvedJob:
    """Return the proof and the setup sheet of a program with the current offsets and tool shapes.

    The result also contains the time and the tools of the program's last start. This function runs on a
    worker. Raises ValueError if the program is not in the program folders or cannot be read, and
    CommandError if the offsets cannot be read.
    """
    from app.special.setup_sheet import make_setup_sheet
    from core.proving.program_tools import PartSettings

    path = desk.program_choice.program_folders.find_path(program)
    if path is None:
        raise ValueError(
            tr(Message("{name} IS NOT IN THE PROGRAM LIST. F1, THEN F6: CHECK LIST", name=program))
        )
    job = steps.make_job(steps.read_source(path), False)
    setting = of_part.read_part_settings(job, watch)[0] if machine.kind == "lathe" else PartSettings()
    return ProvedJob(
        make_setup_sheet(job.shared_program, job.setup, machine, setting, watch), *before(program)
    )


def _never(_program: str) -> tuple[str, dict[int, ToolOffsetRow]]:
    return "", {}
