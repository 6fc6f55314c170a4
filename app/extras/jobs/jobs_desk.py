"""Setup of the job queue, including the proof of the next job."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.compose.desk_part import PartDesk
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import shapes_at_hand
from app.desk.background_work import Watch
from app.desk.desk import Desk
from app.desk.kept_part import kept_part
from app.desk.page_description import ProgramKey
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps
from app.desk.translation import tr
from app.extras.jobs.jobs_model import JobsModel
from app.extras.jobs.jobs_watch import FEATURE, JobProofs, JobsWatch, ProvedJob
from app.production.parts_watch import PartsWatch
from core.machine.machine_model import Machine
from core.message import Message
from core.store.store_rows import ToolRow

Before = Callable[[str], tuple[str, dict[int, ToolRow]]]
"""When a program was started last, and its tools as they were then; on the worker."""


def attach_jobs(desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
    """Attach the job queue, its page and its key in the program list to TurnDesk."""
    parts = desk.pages.find(PartsWatch)
    if parts is None:
        return
    kept = partial(kept_part, (journal or Persistence()).read_setting)
    of_part = PartDesk(machine, shapes_at_hand, kept, work.read)
    before = journal.tools_of_last_run if journal is not None else _never
    parts.book.readers[FEATURE] = lambda store, _program: store.jobs.read_jobs()
    watch = JobsWatch(desk, parts, JobProofs(partial(_proved, desk, machine, work, of_part, before)))
    desk.pages.attach(watch)
    desk.pages.add_run_watcher(watch)
    model = JobsModel(desk, watch)
    desk.pages.attach(model)
    desk.pages.add_program_key("F10", ProgramKey("JOB", "JOBS", model.add_program))
    desk.pages.set_notice(watch.notice)


def _proved(
    desk: Desk,
    machine: Machine,
    steps: LoadingSteps,
    of_part: PartDesk,
    before: Before,
    program: str,
    watch: Watch,
) -> ProvedJob:
    """Return the setup sheet of a program with the present offsets and shapes.

    Runs on a worker. Raises ValueError if the program is not in the list.
    """
    from app.special.setup_sheet import setup_sheet
    from core.proving.program_tools import PartSetting

    path = desk.programs.folders.find(program)
    if path is None:
        raise ValueError(
            tr(Message("{name} IS NOT IN THE PROGRAM LIST. F1, THEN F6: CHECK LIST", name=program))
        )
    job = steps.make_job(steps.read(path), False)
    setting = of_part.setting(job, watch)[0] if machine.kind == "lathe" else PartSetting()
    return ProvedJob(setup_sheet(job.reading, job.setup, machine, setting, watch), *before(program))


def _never(_program: str) -> tuple[str, dict[int, ToolRow]]:
    return "", {}
