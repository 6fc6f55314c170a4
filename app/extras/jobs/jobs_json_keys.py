"""Keys of the JSON that ``turndesk jobs`` prints, for the reference and its tests."""

from __future__ import annotations

from core.json_key import Output, keys

JOBS = Output(
    "jobs list --json",
    "One object.",
    keys(
        """
jobs | list | | The job queue, in order.
jobs[].place | integer | | Position, from 1.
jobs[].program | string | | File name of the program.
jobs[].parts | integer | | Parts to make.
jobs[].made | integer | | Parts made.
jobs[].left | integer | | Parts that remain to be made.
jobs[].state | string | | waiting, in progress or done.
jobs[].note | string | | Note.
jobs[].added | string | UTC | Time at which the job was added.
"""
    ),
)
OUTPUTS = {"shift --json": (JOBS,)}
