"""Registration of the optional feature with lessons for beginners."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.background_work import LatestRequestWorker
    from app.desk.desk import Desk
    from app.desk.persistence import Persistence
    from app.desk.programs.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.machine.machine_model import Machine


class LessonsExtra(OptionalFeature):
    """Optional feature with the special function LESSONS and the card of the current step."""

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Attach the card of the lesson to TurnDesk, if the machine has lessons."""
        from app.extras.lessons.lesson_card import LessonCard

        if _has_lessons(machine):
            card = LessonCard(desk)
            desk.page_registry.attach_model(card)
            desk.page_registry.add_frame_watcher(card.observe_frame)
            desk.page_registry.set_guidance_card(card)

    def list_special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the special function LESSONS of an OmniTurn lathe, which follows ACCESS LEVELS."""
        from app.compose.backends.backend_entry import has_inverter, is_simulated
        from app.extras.lessons.lesson_card import LessonCard
        from app.extras.lessons.lessons_function import LessonsFunction

        card = desk.page_registry.find_model(LessonCard)
        if card is None:
            return ()
        is_played = is_simulated(machine) and not has_inverter(machine)
        return ((LessonsFunction(desk, card, is_simulated=is_played), "ACCESS LEVELS"),)

    def words(self) -> Sequence[str]:
        """Return the titles, goals and instructions of the lessons, which are translated."""
        from core.extras.lessons.lesson_file import list_lesson_files, read_lesson

        lessons = [read_lesson(path) for path in list_lesson_files()]
        texts = [text for lesson in lessons for text in (lesson.title, lesson.goal)]
        return [*texts, *(step.instruction for lesson in lessons for step in lesson.steps)]


def _has_lessons(machine: Machine) -> bool:
    return machine.kind == "lathe" and machine.mdi_language == "omniturn"


EXTRA = LessonsExtra()
