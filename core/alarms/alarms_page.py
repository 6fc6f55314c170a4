"""Generator of the alarm catalog page: ``python -m core.alarms.alarms_page docs/alarms.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from core.alarms import ALARM_SUBJECTS
from core.alarms.alarm_entry import AlarmEntry, AlarmReaction
from core.message import Message
from core.page_contents import make_table_of_contents

_HEAD = """\
# Alarms, holds and stops

This page lists all alarms. `turndesk alarms` prints the same list, and `turndesk alarms 102` prints
one alarm. For the steps after a stop, see [guide/read-an-alarm.md](guide/read-an-alarm.md). For the
alarm that each broken wire or device raises, see [integrator/failures.md](integrator/failures.md).

{contents}
This page is generated from `core/alarms` by
`python -m core.alarms.alarms_page docs/alarms.md`. Do not edit it. The alarm number is shown on the
screen, in `F7` with the time, in the event log and in `status.json`. The alarm also shows the axis,
the program line and the drive's own text if they are known. Technical details are in
`logs/turndesk.log`.

The address of an alarm on this page ends in its number, for example `alarms.html#102`. The help of
the screen (`?`) shows it.

The kind in parentheses is what the alarm does:
"""
_KINDS = {
    AlarmReaction.DRIVES_OFF: "alarm that switches the drives off",
    AlarmReaction.STOP: "alarm",
    AlarmReaction.HOLD: "hold",
    AlarmReaction.REQUESTED: "stop",
    AlarmReaction.NOTICE: "notice",
}


def get_alarm_kind(reaction: AlarmReaction) -> str:
    """Return the kind of alarm (such as hold or stop) that has the given reaction."""
    return _KINDS[reaction]


def render_page() -> str:
    """Return the alarm catalog page as text."""
    head = _HEAD.format(contents=make_table_of_contents(title for title, _ in ALARM_SUBJECTS))
    return "\n".join([head, *_legend(), *_subjects()]) + "\n"


def _legend() -> Iterator[str]:
    for reaction, word in _KINDS.items():
        yield f"- **{word}**: {reaction.value}."


def _subjects() -> Iterator[str]:
    for title, entries in ALARM_SUBJECTS:
        yield from ("", f"## {title}", "")
        for entry in sorted(entries.values(), key=lambda each: each.number):
            yield from _entry(entry)


def _entry(entry: AlarmEntry) -> Iterator[str]:
    anchor = f'<a id="{entry.number}"></a>'
    yield f"{anchor}**{entry.number} {entry.text.upper()}** ({get_alarm_kind(entry.reaction)})  "
    yield Message("Likely causes: {causes}.  ", causes="; ".join(entry.causes))
    yield f"Remedy: {entry.remedy}."
    yield ""


def main(argv: list[str]) -> int:
    """Write the page to the file named in ``argv[0]``."""
    Path(argv[0]).write_text(render_page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
