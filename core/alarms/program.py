"""Alarms of the program: lines that cannot be run, moves beyond the travel."""

from __future__ import annotations

from core.alarms.entry import STOP, Entries, Entry

PROGRAM: Entries = {
    "program": Entry(
        401,
        STOP,
        "program error",
        (
            "this line cannot be run as it stands",
            "an input or a counter led to a line that was never run before",
        ),
        "correct the line in the editor (F3), load the program again",
        tells=True,
    ),
    "travel": Entry(
        402,
        STOP,
        "end of travel",
        (
            "the offset of the tool, or the zero of the part, is wrong",
            "the program was started at another place than it was proved from",
        ),
        "check the tool's offset and where the slides stood at the start; Reset",
        tells=True,
    ),
    "no-end": Entry(
        403,
        STOP,
        "the program ends without M30 or M02",
        ("the last line is missing: cut off when it was sent or copied",),
        "compare the end of the program with the original, add M30, load it again",
    ),
}
