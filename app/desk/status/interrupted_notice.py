"""The interrupted job in words and figures for every page: which it is, where its tool stood and stands.

And the row that says of what nothing is heard any more: its wire is lost, the machine may go on without it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.desk.programs.program_loading import Loaded
from app.desk.screen_settings import Units
from app.desk.status import formats
from app.desk.translation import tr
from core.executor.snapshot import CONTROL_LOST, InterruptedJob, Snapshot, Starts, State
from core.language.source import Dialect
from core.message import Message
from core.ports import Unknown

_SAME = 0.05  # mm, degrees: nearer than this the tool still stands where it stood


@dataclass(frozen=True, slots=True)
class NoticeRow:
    """What stands until somebody acts: a text, figures under it, and keys beside it: name and label.

    ``tone`` is the colour that it is filled with.
    """

    text: str
    figures: str = ""
    keys: tuple[tuple[str, str], ...] = ()
    tone: str = "pause"


def notice_of(snapshot: Snapshot, loaded: Loaded, units: Units) -> NoticeRow | None:
    """Of the interrupted job; None when there is none."""
    found = snapshot.interrupted
    if found is None:
        return None
    words = tr(
        Message(
            "INTERRUPTED: {program} LINE {line}{passed}, T{tool}, PART {part}, {position}: {why}{changed}",
            program=found.program,
            line=found.line,
            passed=_pass(found, loaded),
            tool=found.tool,
            part=found.part,
            position=formats.wall_time(found.at),
            why=tr(found.why),
            changed=tr(" (PROGRAM CHANGED SINCE THEN)") if _changed(found, loaded) else "",
        )
    )
    return NoticeRow(words, _places(found, snapshot, units) + _uncertain(found))


def interrupted_prompt(snapshot: Snapshot, loaded: Loaded, start: str) -> str:
    """What can be done about it on the Automatic page; empty when the loaded program is none such."""
    line = snapshot.interrupted_line
    if not line or snapshot.state is not State.IDLE or snapshot.starts is not Starts.PROGRAM:
        return ""
    if snapshot.confirmed:
        words = tr("STARTS AT LINE 1 ({text}) FROM CURRENT T{tool} POSITION. {start}. ESC: CANCEL")
        return tr(Message(words, text=_first(loaded), tool=snapshot.modal.tool, start=start))
    if not may_go_on(loaded):
        return tr(Message("STOPPED IN LINE {line}. JOG THE TOOL CLEAR. Y: START OVER", line=line))
    words = tr("STOPPED IN LINE {line}. F6: RETRACT AND RESUME. Y: START OVER")
    return tr(Message(words, line=line))


def may_go_on(loaded: Loaded) -> bool:
    """Whether SEARCHTO reads the language of this program."""
    return loaded.source is None or loaded.source.dialect is Dialect.OMNITURN


def instead(found: InterruptedJob, name: str) -> str:
    """The question before another program takes the place of an interrupted one."""
    words = tr(
        "T{tool} MAY BE IN THE PART ({program}, LINE {line}). PRESS Y TO CANCEL THE "
        "INTERRUPTED JOB AND LOAD {name}, N TO KEEP THE INTERRUPTED JOB"
    )
    return tr(Message(words, tool=found.tool, program=found.program, line=found.line, name=name))


def _first(loaded: Loaded) -> str:
    lines: Sequence[str] = loaded.source.lines if loaded.source is not None else ()
    return next((line.strip() for line in lines if line.strip()), "")


def _changed(found: InterruptedJob, loaded: Loaded) -> bool:
    job = loaded.job
    return job is not None and job.source.name == found.program and job.text_digest != found.text


def _pass(found: InterruptedJob, loaded: Loaded) -> str:
    """Which time the line was gone through, where it is more than once in a part."""
    picture, job = loaded.picture, loaded.job
    if picture is None or job is None or job.text_digest != found.text:
        return ""
    passes = picture.blocks_of_line(found.line)
    now = next((n for n, (a, b) in enumerate(passes, 1) if a <= found.block <= b), 0)
    return (
        tr(Message(" REPETITION {now} OF {all}", now=now, all=len(passes))) if now and len(passes) > 1 else ""
    )


def _places(found: InterruptedJob, snapshot: Snapshot, units: Units) -> str:
    """From home, as the readout FROM HOME counts: where the tool stood, and where it stands by now."""
    stood = _figures(found.axes, found.where, snapshot, units)
    if not all(snapshot.homed):
        return tr(Message("POSITION WAS {position} FROM HOME, NOW UNKNOWN UNTIL HOMED", position=stood))
    if snapshot.axes != found.axes:
        return tr(Message("POSITION WAS {position} FROM HOME", position=stood))
    if max(abs(a - b) for a, b in zip(found.where, snapshot.actual, strict=True)) <= _SAME:
        return tr(Message("POSITION UNCHANGED: {position} FROM HOME", position=stood))
    now = _figures(snapshot.axes, snapshot.actual, snapshot, units)
    return tr(Message("POSITION WAS {position}, IS NOW {now} FROM HOME", position=stood, now=now))


def _uncertain(found: InterruptedJob) -> str:
    """What nobody knows of a job whose control was gone at once: its note was written once a second."""
    if found.why != CONTROL_LOST:
        return ""
    return tr(
        ". THE LAST SECOND BEFORE THE STOP WAS NOT RECORDED. CUT MAY BE INCOMPLETE. CHECK TOOL AND PART"
    )


def _figures(axes: Sequence[str], where: Sequence[float], snapshot: Snapshot, units: Units) -> str:
    """Slides only: where C stands is nothing that a hand can be in the way of."""
    metric, twice = units.metric(snapshot.modal.metric), snapshot.reads_diameter
    found = [
        Message(
            "{name} {ending}{position}",
            name=name,
            ending="Ø" if twice else "R",
            position=formats.length(2 * at if twice else at, metric),
        )
        if name == "X" and "Y" not in axes
        else Message("{name} {position}", name=name, position=formats.length(at, metric))
        for name, at in zip(axes, where, strict=False)
        if name in "XYZ"
    ]
    return " ".join(found)


def unheard_notice(snapshot: Snapshot) -> NoticeRow | None:
    """Of what the snapshot does not know; None when it knows all."""
    unknown = snapshot.unknown
    if not unknown:
        return None
    named = {
        Unknown.SLIDES: tr("POSITIONS"),
        Unknown.SPINDLE: tr("SPINDLE"),
        Unknown.OUTPUTS: tr("OUTPUTS"),
        Unknown.INPUTS: tr("INPUTS"),
    }
    what = ", ".join(words for which, words in named.items() if which in unknown)
    head = tr(Message("{what} UNKNOWN: NO RESPONSE FROM THE MACHINE", what=what))
    if Unknown.SPINDLE in unknown:
        head = tr("SPINDLE UNKNOWN – SPINDLE MAY BE TURNING: PRESS E-STOP")
    below = tr(Message("UNKNOWN: {what} · LAST KNOWN VALUES ARE SHOWN", what=what))
    return NoticeRow(head, below, tone="alarm")
