"""What the RS-232 function shows: its settings, how far a transfer has come, a program that has come in."""

from __future__ import annotations

from pathlib import Path

from app.desk.special.sheet import Row, Sheet
from app.desk.transfer.form import ROWS
from app.desk.transfer.service import Reach, Received
from app.desk.view import Tone
from app.desk.words import tr
from core.machine.hardware.model import DncModel

TITLE = "RS-232"
SHOWN = 6  # findings


def settings_sheet(settings: DncModel, marked: int, chosen: Path | None, last: str) -> Sheet:
    """The line, and the program that would be sent."""
    rows = tuple(Row((tr(name), value(settings))) for name, value, _ in ROWS)
    program = chosen.name if chosen is not None else "—"
    notes = (tr("F4 sends: {program}").format(program=program), last)
    return Sheet(TITLE, ("SETTING", "VALUE"), (0.5, 0.5), rows, marked, notes=notes, raw=frozenset({0, 1}))


def progress_sheet(reach: Reach, settings: DncModel, sends: str) -> Sheet:
    """How far it has come."""
    share = f"{reach.done / reach.total:.0%}" if reach.total else "—"
    rows = (
        Row((tr("SENDING") if sends else tr("RECEIVING"), sends or settings.port), True, Tone.RUN),
        Row((tr("BYTES"), f"{reach.done}" + (f" / {reach.total}" if reach.total else ""))),
        Row((tr("LINES"), f"{reach.lines}")),
        Row((tr("DONE"), share)),
        Row((tr("WAITS"), _waits(reach.what)), bool(reach.what), Tone.WAIT),
    )
    words = f"{settings.port}  {settings.baud} {settings.bits}{settings.parity}{settings.stop}"
    return Sheet(TITLE, ("", ""), (0.35, 0.65), rows, notes=(words,), raw=frozenset({0, 1}))


def _waits(what: str) -> str:
    """For whom or what."""
    words = {
        "held": tr("HELD BY THE OTHER SIDE (XOFF)"),
        "dc1": tr("FOR DC1 FROM THE OTHER SIDE"),
        "sender": tr("FOR THE OTHER SIDE TO SEND"),
        "frame": tr("FOR THE FIRST %"),
    }
    return words.get(what, "—")


def received_sheet(received: Received, name: str) -> Sheet:
    """What came, whether it is whole, and what proving found."""
    code = tr("7 BITS, EVEN PARITY, FOUND OUT") if received.seven else tr("AS SET")
    errors = len(received.findings)
    result = tr("{count} ERRORS").format(count=errors) if errors else tr("NO ERROR")
    rows = (
        Row((tr("WHOLE"), tr("{count} LINES").format(count=received.lines)), True, Tone.RUN),
        Row((tr("PROVED"), result), True, Tone.ALARM if errors else Tone.RUN),
        Row((tr("CALLS ITSELF"), received.name or "—")),
        Row((tr("SHA-256"), received.digest[:32] + " …")),
        Row((tr("CHARACTERS"), code)),
        Row((tr("SKIPPED BEFORE IT"), f"{received.skipped}")),
        *(Row(("", text)) for text in received.findings[:SHOWN]),
    )
    return Sheet(
        TITLE,
        ("", ""),
        (0.25, 0.75),
        rows,
        question="NAME OF THE NEW PROGRAM?",
        text=name,
        notes=(*received.findings[:1], "It replaces nothing and starts nothing."),
        raw=frozenset({0, 1}),
    )
