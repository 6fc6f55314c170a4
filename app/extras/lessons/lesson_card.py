"""Card with the current step of a lesson, which every page shows above its contents."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.first_job import CLOSE_KEY
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.prompt_line import find_unmeasured_tools
from app.desk.translation import tr
from app.programs.atomic_files import write_new_file
from core.access.access_table import ProtectedChange
from core.executor.snapshot import CYCLE_STATES, Snapshot
from core.extras.lessons.lesson import Lesson, OffsetField, RunCounters, ScreenState
from core.extras.lessons.lesson_file import RUN_SWITCHES
from core.extras.lessons.lesson_progress import LessonProgress
from core.message import Message
from core.store.store_rows import OffsetKind

COMPLETED_SETTING = "completed_lessons"  # Name of the setting with the numbers of the completed lessons.
_OFFSET_KINDS = {"tool": OffsetKind.TOOL, "secondary": OffsetKind.SECONDARY}


class LessonCard:
    """Lesson that the operator is doing, with its card. The card closes with its key or with the lesson.

    The card only reads the state of the screen. It never moves the machine and never waits.
    """

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._progress: LessonProgress | None = None
        self._worker = LatestRequestWorker("lessons")
        self._completed: frozenset[int] = frozenset()
        desk.try_save(self._load_completed)

    # --- lesson --------------------------------------------------------------------------------------

    @property
    def progress(self) -> LessonProgress | None:
        """Return the progress of the started lesson, or None if no lesson is started."""
        return self._progress

    @property
    def completed_lessons(self) -> frozenset[int]:
        """Return the numbers of the lessons that were completed with this data store."""
        return self._completed

    def start_lesson(self, lesson: Lesson) -> None:
        """Start a lesson at its first step, and load its program.

        If the lesson creates its program, a worker writes the file unless it exists.
        """
        desk = self._desk
        if not desk.program_choice.can_choose_program():
            return
        if lesson.program_text and desk.is_refused(ProtectedChange.PROGRAMS):
            return
        self._progress = LessonProgress(lesson, self._read_state(desk.read_snapshot(), lesson))
        if lesson.program_text:
            path = desk.program_choice.program_folders.folders[0] / lesson.program
            work = partial(_write_program, path, lesson.program_text)
            self._worker.enqueue_work(work, desk.program_choice.load_path, desk.show_refusal)
        elif desk.program_loader.loaded_program.name != lesson.program and not (
            desk.program_choice.load_by_name(lesson.program)
        ):
            self._progress = None
            desk.say(Message("{name} IS MISSING IN THE PROGRAM FOLDER", name=lesson.program))

    def close_card(self) -> bool:
        """End the lesson, and return False if no lesson was started."""
        was_started, self._progress = self._progress is not None, None
        return was_started

    def close(self) -> None:
        """End the worker when TurnDesk closes."""
        self._worker.close()

    # --- every frame ---------------------------------------------------------------------------------

    def observe_frame(self, snapshot: Snapshot) -> None:
        """Complete the steps whose conditions the screen now meets."""
        self._worker.deliver_results()
        progress = self._progress
        if progress is None or progress.current_step is None:
            return
        if progress.update(self._read_state(snapshot, progress.lesson)):
            self._save_completed(progress.lesson.number)

    def make_row(self) -> NoticeRow | None:
        """Return the card with the current step, or None if no lesson is started."""
        progress = self._progress
        if progress is None:
            return None
        lesson, step = progress.lesson, progress.current_step
        keys = ((CLOSE_KEY, tr("CLOSE")),)
        values = {"number": lesson.number, "title": tr(lesson.title)}
        if step is None:
            words = tr(Message("LESSON {number}, {title}: ALL STEPS DONE ✓", **values))
            return NoticeRow(words, tr("NEXT LESSON: F1, F10, LESSONS"), keys, "run")
        done, count = progress.completed_step_count, len(lesson.steps)
        words = tr(
            Message("LESSON {number}, {title}: STEP {step} OF {count}", step=done + 1, count=count, **values)
        )
        return NoticeRow(f"{words} {'✓' * done}", tr(step.instruction), keys, "wait")

    def _read_state(self, snapshot: Snapshot, lesson: Lesson) -> ScreenState:
        loaded = self._desk.program_loader.loaded_program
        return ScreenState(
            page=self._desk.window_state.page_name,
            state=snapshot.state,
            switches_on=frozenset(name for name in RUN_SWITCHES if getattr(snapshot, name)),
            program=loaded.name,
            program_text=loaded.source.text if loaded.source is not None else "",
            is_proved=_is_proved(loaded),
            findings=frozenset(each.code for each in loaded.blocking_errors),
            line=snapshot.line if snapshot.state in CYCLE_STATES else 0,
            counters=RunCounters(snapshot.parts, snapshot.ends, snapshot.lines),
            is_interrupted=snapshot.interrupted is not None,
            is_start_rejected=bool(snapshot.start_refusal_reason),
            offsets={each: self._read_offset(each) for each in lesson.offset_fields},
        )

    def _read_offset(self, offset: OffsetField) -> float:
        """Return an offset in mm, with X as a radius, or 0 if the table has no such row."""
        row = self._desk.offset_book.get_rows(_OFFSET_KINDS[offset.table]).get(offset.number)
        return float(getattr(row, offset.name)) if row is not None else 0.0

    # --- completed lessons ---------------------------------------------------------------------------

    def _read_completed(self) -> frozenset[int]:
        stored = self._desk.settings_store.persistence.read_setting(COMPLETED_SETTING)
        return (
            frozenset(each for each in stored if type(each) is int)
            if isinstance(stored, list)
            else frozenset()
        )

    def _load_completed(self) -> None:
        self._completed |= self._read_completed()

    def _save_completed(self, number: int) -> None:
        """Save that a lesson is completed; the saved lessons are read again, so that none is lost."""
        self._completed |= {number}

        def save() -> None:
            self._load_completed()
            persistence = self._desk.settings_store.persistence
            persistence.save_setting(COMPLETED_SETTING, sorted(self._completed))

        self._desk.try_save(save)


def _is_proved(loaded: LoadedProgram) -> bool:
    """Return whether the proof is complete without an error and every tool has an offset."""
    return (
        loaded.phase is LoadingPhase.READY
        and loaded.proof is not None
        and not loaded.proof.errors
        and not find_unmeasured_tools(loaded)
    )


def _write_program(path: Path, text: str) -> Path:
    """Write the program of a lesson unless it exists, and return its path. Raises FileOperationError."""
    if not path.exists():
        write_new_file(path, text.encode("ascii"))
    return path
