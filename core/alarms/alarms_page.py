"""The alarm catalogue as a page to read: ``python -m core.alarms.alarms_page docs/alarms.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from core.alarms import SUBJECTS
from core.alarms.alarm_entry import Entry, Reaction

_HEAD = """\
# Alarms, holds and stops

Written from `core/alarms` by `python -m core.alarms.alarms_page docs/alarms.md`; `turndesk alarms` prints the
same. The number stands on the screen, in `F7` with the time, in the event log and in `status.json`. Where an
axis, a line or a drive's own word is known it is told with the alarm; the technical side is in
`logs/turndesk.log`.

"""
_KINDS = {
    Reaction.OFF: "alarm, drives off",
    Reaction.STOP: "alarm",
    Reaction.HOLD: "hold",
    Reaction.ASKED: "stop",
}


def kind_of(reaction: Reaction) -> str:
    """In a word or two, what it makes of the machine."""
    return _KINDS[reaction]


def document() -> str:
    """The whole page."""
    return "\n".join([_HEAD.rstrip("\n"), "", *_legend(), *_subjects()]) + "\n"


def _legend() -> Iterator[str]:
    for reaction, word in _KINDS.items():
        yield f"- **{word}**: {reaction.value}."


def _subjects() -> Iterator[str]:
    for title, entries in SUBJECTS:
        yield from ("", f"## {title}", "")
        for entry in sorted(entries.values(), key=lambda each: each.number):
            yield from _entry(entry)


def _entry(entry: Entry) -> Iterator[str]:
    yield f"**{entry.number} {entry.text.upper()}** ({kind_of(entry.reaction)})  "
    yield f"Likely causes: {'; '.join(entry.causes)}.  "
    yield f"Do: {entry.remedy}."
    yield ""


def main(argv: list[str]) -> int:
    """Write the page to the file that is named."""
    Path(argv[0]).write_text(document(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
