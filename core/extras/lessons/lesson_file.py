"""Reader of lesson files.

A lesson file in TOML has these keys:

- ``number``, ``title``, ``goal``, ``minutes``: shown in the list of lessons.
- ``program``: name of the program that the lesson loads. ``program_text`` creates this program.
- ``[[steps]]``: ``instruction``, and one or more parts of its condition. These are the attributes of
  ``StepCondition``; ``offset`` is a table with ``table``, ``number``, ``field`` and ``difference_mm``.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from core.executor.snapshot import MachineState
from core.extras.lessons.lesson import Lesson, LessonStep, OffsetDifference, OffsetField, StepCondition
from core.input_file import parse_toml, read_input_text
from core.message import CodedError, Message

LESSONS_FOLDER = Path(__file__).with_name("files")
MAX_LESSON_BYTES = 64 * 1024
OFFSET_TABLES = frozenset({"tool", "secondary"})
OFFSET_FIELDS = frozenset({"x", "z"})
RUN_SWITCHES = frozenset({"single_block", "optional_stop", "block_delete", "cycle_repeat", "no_count"})
_LESSON_KEYS: Mapping[str, type] = {
    "number": int,
    "title": str,
    "goal": str,
    "minutes": int,
    "program": str,
    "program_text": str,
    "steps": list,
}
_CONDITION_KEYS: Mapping[str, type] = {
    "page": str,
    "state": str,
    "switch_on": str,
    "switch_off": str,
    "proved_program": str,
    "program_text": str,
    "finding": str,
    "min_line": int,
    "counted_parts": int,
    "finished_runs": int,
    "mdi_lines": int,
    "is_interrupted": bool,
    "is_start_rejected": bool,
    "offset": dict,
}
_OFFSET_KEYS: Mapping[str, type] = {"table": str, "number": int, "field": str, "difference_mm": float}
_KNOWN_VALUES: Mapping[str, frozenset[str]] = {
    "state": frozenset(MachineState),
    "switch_on": RUN_SWITCHES,
    "switch_off": RUN_SWITCHES,
}
_COUNT_KEYS = ("min_line", "counted_parts", "finished_runs", "mdi_lines")


class LessonFileError(CodedError):
    """An error raised if a lesson file cannot be used. The text names the file, the fault and the remedy."""


def list_lesson_files(folder: Path = LESSONS_FOLDER) -> list[Path]:
    """Return the paths of the lesson files in a folder, sorted by name."""
    return sorted(folder.glob("*.toml"))


def read_lesson(path: Path) -> Lesson:
    """Return the lesson in a file. Raises LessonFileError if the file is damaged or cannot be read."""
    try:
        tables = parse_toml(read_input_text(path, MAX_LESSON_BYTES))
        return _make_lesson(tables)
    except (OSError, ValueError) as error:
        raise LessonFileError(
            Message(
                "{file} cannot be used: {error}. Install TurnDesk again", file=path.name, error=error.args[-1]
            ),
            "lesson-file",
        ) from error


def _make_lesson(tables: Mapping[str, object]) -> Lesson:
    """Return the lesson of the parsed tables. Raises ValueError with the fault."""
    values = _check_keys(tables, _LESSON_KEYS, optional_keys={"program_text"})
    _check_counts(values, ("number", "minutes"))
    if not values["steps"]:
        raise ValueError(Message("the lesson has no steps"))
    steps = tuple(_make_step(number, each) for number, each in enumerate(values["steps"], 1))
    return Lesson(**{**values, "steps": steps})


def _make_step(number: int, table: object) -> LessonStep:
    try:
        keys = {"instruction": str, **_CONDITION_KEYS}
        values = _check_keys(table, keys, optional_keys=_CONDITION_KEYS)
        return LessonStep(values.pop("instruction"), _make_condition(values))
    except ValueError as error:
        raise ValueError(Message("step {number}: {error}", number=number, error=error.args[0])) from error


def _make_condition(values: dict[str, Any]) -> StepCondition:
    """Return the condition with these values. Raises ValueError if it is empty or has an unknown value."""
    if not values:
        raise ValueError(Message("the step has no condition"))
    for key, known_values in _KNOWN_VALUES.items():
        if values.get(key) not in {None, *known_values}:
            raise _make_value_error(key, values[key])
    _check_counts(values, _COUNT_KEYS)
    if "offset" in values:
        values["offset"] = _make_offset(values["offset"])
    return StepCondition(**values)


def _make_offset(table: object) -> OffsetDifference:
    values = _check_keys(table, _OFFSET_KEYS)
    _check_counts(values, ("number",))
    if values["table"] not in OFFSET_TABLES:
        raise _make_value_error("table", values["table"])
    if values["field"] not in OFFSET_FIELDS:
        raise _make_value_error("field", values["field"])
    offset = OffsetField(values["table"], values["number"], values["field"])
    return OffsetDifference(offset, values["difference_mm"])


def _check_keys(
    table: object, types: Mapping[str, type], *, optional_keys: Collection[str] = ()
) -> dict[str, Any]:
    """Return a copy of a table. Raises ValueError for an unknown, missing or empty key or a wrong type."""
    if not isinstance(table, dict):
        raise ValueError(Message("a table is missing"))  # noqa: TRY004  one kind of error for damaged files
    if unknown := sorted(table.keys() - types.keys()):
        raise ValueError(Message("the key {key} is unknown", key=unknown[0]))
    if missing := sorted(types.keys() - table.keys() - set(optional_keys)):
        raise ValueError(Message("the key {key} is missing", key=missing[0]))
    for key, value in table.items():
        if type(value) is not types[key] or value == "":
            raise _make_value_error(key, value)
    return dict(table)


def _check_counts(values: Mapping[str, Any], keys: Collection[str]) -> None:
    """Raise ValueError if one of these values is less than 1."""
    for key in keys:
        if values.get(key, 1) < 1:
            raise _make_value_error(key, values[key])


def _make_value_error(key: str, value: object) -> ValueError:
    return ValueError(Message("{value} is not a valid value of {key}", key=key, value=value))
