"""Special function LESSONS, which lists the lessons and starts the selected one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.extras.lessons.lesson_card import LessonCard
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot
from core.extras.lessons.lesson import Lesson
from core.extras.lessons.lesson_file import LessonFileError, list_lesson_files, read_lesson
from core.message import Message


class LessonsFunction(SpecialFunction):
    """Special function that lists the lessons, and starts or ends a lesson.

    The files are read when the list is first shown. A damaged file is shown with its fault instead of its
    lesson. On a real machine, no lesson can be started.
    """

    name = "LESSONS"
    use = "learn TurnDesk step by step"

    def __init__(self, desk: Desk, card: LessonCard, *, is_simulated: bool) -> None:
        super().__init__(desk)
        self._card, self._is_simulated = card, is_simulated
        self._lessons: tuple[Lesson | LessonFileError, ...] | None = None

    # --- display -------------------------------------------------------------------------------------

    @property
    def lessons(self) -> tuple[Lesson | LessonFileError, ...]:
        """Return the lessons, with the error in place of each lesson that cannot be read."""
        if self._lessons is None:
            self._lessons = tuple(map(_read_lesson_or_error, list_lesson_files()))
        return self._lessons

    @property
    def _selected_lesson(self) -> Lesson | LessonFileError | None:
        return self.lessons[self.marked] if self.marked < len(self.lessons) else None

    @property
    def row_count(self) -> int:
        """Return the number of lessons."""
        return len(self.lessons)

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of lessons, with the goal of the selected lesson below."""
        selected = self._selected_lesson
        goal = selected.goal if isinstance(selected, Lesson) else ""
        rows = tuple(map(self._make_row, self.lessons))
        note = self._find_refusal() or goal
        return TableContent("LESSONS", ("", "", ""), (0.07, 0.63, 0.3), rows, self.marked, notes=(note,))

    def _make_row(self, lesson: Lesson | LessonFileError) -> TableRow:
        if isinstance(lesson, LessonFileError):
            return TableRow(("!", str(lesson), tr("DAMAGED")), tone=StatusTone.ALARM)
        progress = self._card.progress
        if progress is not None and progress.lesson == lesson:
            done, count = progress.completed_step_count, len(lesson.steps)
            status = tr(Message("{done} OF {count} STEPS", done=done, count=count))
        elif lesson.number in self._card.completed_lessons:
            status = tr("✓ DONE")
        else:
            status = tr(Message("{minutes} min", minutes=lesson.minutes))
        return TableRow((str(lesson.number), tr(lesson.title), status))

    def _find_refusal(self) -> str:
        return "" if self._is_simulated else "LESSONS NEED A SIMULATED MACHINE. START turndesk --demo"

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the keys that start and end a lesson."""
        return {
            "F2": FunctionKey("BEGIN", self.start_selected_lesson, barred=not self._is_simulated),
            "F4": FunctionKey("CLOSE", self.end_lesson, barred=self._card.progress is None),
        }

    def activate_selected_row(self) -> bool:
        """Start the selected lesson."""
        self.start_selected_lesson()
        return True

    def start_selected_lesson(self) -> None:
        """Start the selected lesson, or show the reason why it cannot be started."""
        self.desk.clear_prompt_line()
        lesson = self._selected_lesson
        if refusal := self._find_refusal():
            self.desk.show_refusal(refusal)
        elif isinstance(lesson, LessonFileError):
            self.desk.show_refusal(str(lesson))
        elif lesson is not None:
            self._card.start_lesson(lesson)

    def end_lesson(self) -> None:
        """End the started lesson, and remove its card."""
        if not self._card.close_card():
            self.desk.say("NO LESSON IS OPEN")

    def prompt_text(self) -> str:
        """Return the prompt that explains the keys."""
        return "ENTER: BEGIN LESSON   F4: CLOSE LESSON   ESC: BACK TO THE LIST"


def _read_lesson_or_error(path: Path) -> Lesson | LessonFileError:
    try:
        return read_lesson(path)
    except LessonFileError as error:
        return error
