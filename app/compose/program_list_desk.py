"""Assembly of the list of programs with its preview, import and export."""

from __future__ import annotations

from pathlib import Path

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadingSteps
from app.programs.import_export import ImportExport
from app.programs.program_list import ProgramList
from app.programs.program_rows import DrawThumbnail, Preview
from app.programs.removable_media import FolderChooser
from core.message import Message


def program_list(
    desk: Desk, persistence: Persistence, workshop: LoadingSteps, own: Path, thumbnail: DrawThumbnail | None
) -> ProgramList:
    """Return the list of programs in the folder ``own``.

    Imported programs are proved with the offsets at that time.
    """

    def check(path: Path) -> str:
        job = workshop.make_job(workshop.read(path), False)
        proved = workshop.prove(job, lambda _count: None)
        errors = proved.proof.errors
        result = (
            Message("{errors_count} ERRORS: {errors}", errors_count=len(errors), errors=errors[0])
            if errors
            else "PROVED"
        )
        planned = None if errors else proved.proof.cycle_time
        persistence.runs.record_proof(path.name, result, planned, job.source.text)
        return errors[0] if errors else ""

    worker = Latest("editing-programs")
    chooser = FolderChooser(Path.home(), takes=desk.programs.folders.takes)
    transfer = ImportExport(desk, own, persistence, worker, check, chooser)
    return ProgramList(desk, own, persistence, worker, Preview(workshop, thumbnail), transfer)
