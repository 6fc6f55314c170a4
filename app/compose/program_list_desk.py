"""Assembly of the program list with its preview, import and export."""

from __future__ import annotations

from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps
from app.programs.import_export import ProgramTransfer
from app.programs.program_list_model import ProgramListModel
from app.programs.program_rows import DrawThumbnail, ProgramPreview
from app.programs.removable_media import FolderChooser
from core.message import Message


def create_program_list(
    desk: Desk,
    persistence: Persistence,
    loading_steps: LoadingSteps,
    folder: Path,
    draw_thumbnail: DrawThumbnail | None,
) -> ProgramListModel:
    """Return the list of programs in ``folder``.

    Imported programs are proved with the offsets at the time of the import.
    """

    def prove_imported_program(path: Path) -> str:
        job = loading_steps.make_job(loading_steps.read_source(path), False)
        proved = loading_steps.prove_job(job, lambda _count: None)
        errors = proved.proof.errors
        result = (
            Message("{errors_count} ERRORS: {errors}", errors_count=len(errors), errors=errors[0])
            if errors
            else "PROVED"
        )
        planned = None if errors else proved.proof.cycle_time_s
        persistence.runs.record_proof(path.name, result, planned, job.source.text)
        return errors[0] if errors else ""

    worker = LatestRequestWorker("editing-programs")
    chooser = FolderChooser(Path.home(), accepts_name=desk.program_choice.program_folders.accepts_file_name)
    transfer = ProgramTransfer(desk, folder, persistence, worker, prove_imported_program, chooser)
    return ProgramListModel(
        desk, folder, persistence, worker, ProgramPreview(loading_steps, draw_thumbnail), transfer
    )
