"""Keys of the JSON that ``turndesk shapes`` prints, for the reference and its tests."""

from __future__ import annotations

from core.json_key import Output, keys

SHAPES = Output(
    "shapes FORM.toml --json",
    "One object.",
    keys(
        """
file | string | | The file with the steps.
out | string or null | | File of --out.
program | string | | Text of the program.
steps | list | | Kinds of the steps.
words | list | | Choices and observations of TurnDesk, as sentences.
errors | list | | Errors of the program; the exit status is then 1.
cycle_time_s | number | s | Cycle time.
"""
    ),
)
SHAPES_LIST = Output(
    "shapes --list --json", "One object.", keys("* | list | | Keys that a step of this kind can have.")
)
OUTPUTS = (SHAPES, SHAPES_LIST)
