"""The sample plan: which features of the part just made are to be measured, and whether parts wait for it."""

from __future__ import annotations

from app.desk.translation import tr
from app.quality.parts_book import PartsData
from core.message import Message


def due(data: PartsData, made: int) -> dict[str, int]:
    """By feature the part that is to be measured: the last of its plan that was made and not read yet."""
    found = {}
    for row in data.features:
        planned = made // row.every * row.every if row.every else 0
        if planned and not any(each.part >= planned for each in data.readings_of(row.id)):
            found[row.name] = planned
    return found


def notice(found: dict[str, int]) -> str:
    """What to measure, for the prompt line; empty where nothing is due."""
    part, names = _newest(found)
    return tr(Message("MEASURE PART {part}: {names}", part=part, names=names)) if found else ""


def bar(found: dict[str, int]) -> str:
    """Why no other part begins where parts wait for the plan; empty where nothing is due."""
    part, names = _newest(found)
    return (
        Message("part {part} must be measured before the next part starts: {names}", part=part, names=names)
        if found
        else ""
    )


def _newest(found: dict[str, int]) -> tuple[int, str]:
    """The newest of the parts, and the names of what is due of it."""
    part = max(found.values(), default=0)
    return part, ", ".join(name for name, planned in found.items() if planned == part)
