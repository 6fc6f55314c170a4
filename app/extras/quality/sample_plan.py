"""Sampling plan: the features to measure on each part, and whether the next part must wait."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.translation import tr
from app.extras.quality.parts_data import PartsData, get_loaded_parts_data
from app.production.parts_watch import ProductionMonitor
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_errors import StoreError


def find_due_parts(data: PartsData, parts_made: int) -> dict[str, int]:
    """Return the number of the part to measure for each feature whose measurement is due.

    A measurement is due if neither the latest planned part nor a later part has a reading of the feature.
    """
    found = {}
    for row in data.features:
        planned = parts_made // row.every * row.every if row.every else 0
        if planned and not any(each.part >= planned for each in data.select_readings(row.id)):
            found[row.name] = planned
    return found


def make_due_notice(due_parts: dict[str, int]) -> str:
    """Return the prompt text that names the part and the features to measure.

    The result is an empty string if no measurement is due.
    """
    part, names = _newest(due_parts)
    return tr(Message("MEASURE PART {part}: {names}", part=part, names=names)) if due_parts else ""


def find_wait_reason(due_parts: dict[str, int]) -> str:
    """Return the reason why the next part must wait for measurements, or else an empty string."""
    part, names = _newest(due_parts)
    return (
        Message("part {part} must be measured before the next part starts: {names}", part=part, names=names)
        if due_parts
        else ""
    )


def _newest(due_parts: dict[str, int]) -> tuple[int, str]:
    """Return the number of the latest part to measure, and the names of its due features."""
    part = max(due_parts.values(), default=0)
    return part, ", ".join(name for name, planned in due_parts.items() if planned == part)


@dataclass(slots=True)
class SamplePlan:
    """Sampling plan of the loaded program. It can block the next part until measurements are entered."""

    desk: Desk
    parts_watch: ProductionMonitor
    # measurements by number of parts made, valid for ``_planned_of``
    _plans: dict[int, dict[str, int]] = field(default_factory=dict)
    _planned_of: object = None
    _waits: tuple[str, bool] = ("", False)  # program, and whether its parts wait for measurements

    def find_lock_reason(self, snapshot: Snapshot) -> str:
        """Return the reason why the next part must wait for measurements, or else an empty string.

        The part in progress counts as made.
        """
        if not self.is_measurement_wait_enabled:
            return ""
        made = self.desk.program_runs.part_counter.part_count + (1 if snapshot.counts else 0)
        return find_wait_reason(self._planned(made))

    def find_reminder(self) -> str:
        """Return the prompt text that names the features to measure, or an empty string if none is due."""
        return make_due_notice(self._planned(self.desk.program_runs.part_counter.part_count))

    def _planned(self, made: int) -> dict[str, int]:
        """Return the measurements that are due after ``made`` parts.

        The result is cached until the data change.
        """
        data = get_loaded_parts_data(self.parts_watch.production_records)
        if made not in self._plans or self._planned_of is not data:
            kept = self._plans if self._planned_of is data else {}
            self._plans, self._planned_of = {**kept, made: find_due_parts(data, made)}, data
        return self._plans[made]

    @property
    def is_measurement_wait_enabled(self) -> bool:
        """Return whether the next part of this program waits until the required measurements are done."""
        program = self.parts_watch.program_name
        if self._waits[0] != program:
            try:
                kept = self.desk.program_runs.part_counter.persistence.read_setting(_key(program)) is True
            except StoreError:
                kept = False
            self._waits = program, kept
        return self._waits[1]

    def toggle_measurement_wait(self) -> None:
        """Turn waiting for required measurements on or off for the loaded program.

        The setting is saved in the background. Raises StoreError if it cannot be queued for saving. A later
        write error is not raised.
        """
        on, program = not self.is_measurement_wait_enabled, self.parts_watch.program_name
        self._waits = program, on
        persistence = self.desk.program_runs.part_counter.persistence
        persistence.save_setting(_key(program), on or None)
        template = (
            "program {program}: the next part cannot start before the required parts are measured"
            if on
            else "program {program}: the next part can start before the required parts are measured"
        )
        persistence.log_change(Message(template, program=program))


def _key(program: str) -> str:
    return f"measuring:{program}"
