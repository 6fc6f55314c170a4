"""Notices about an interrupted job, and about parts of the machine that do not respond.

The notice of an interrupted job contains the program, the line, the tool's position at the stop and its
current position. The other notice appears if the connection is lost, because the machine may continue to
move.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.desk.programs.program_loading import LoadedProgram
from app.desk.screen_settings import DisplayUnits
from app.desk.status import formats
from app.desk.translation import tr
from core.executor.snapshot import POWER_LOST_REASON, InterruptedJob, MachineState, Snapshot, StartAction
from core.language.source import Dialect
from core.message import Message
from core.ports import UnknownPart

_POSITION_TOLERANCE = 0.05  # Tolerance in mm or degrees within which the position counts as unchanged.


@dataclass(frozen=True, slots=True)
class NoticeRow:
    """A notice that remains until the operator acts.

    It has a text, values below the text, and labeled keys. ``color_name`` is the name of the background
    color. ``is_caption`` makes the text as large as the prompt line; such a row has no keys.
    """

    text: str
    values_text: str = ""
    keys: tuple[tuple[str, str], ...] = ()
    color_name: str = "pause"
    is_caption: bool = False


def make_interrupted_notice(
    snapshot: Snapshot, loaded: LoadedProgram, units: DisplayUnits
) -> NoticeRow | None:
    """Return the notice about the interrupted job, or None if no job was interrupted."""
    found = snapshot.interrupted
    if found is None:
        return None
    words = tr(
        Message(
            "INTERRUPTED: {program} LINE {line}{passed}, T{tool}, PART {part}, {position}: {why}{changed}",
            program=found.program,
            line=found.line,
            passed=_describe_pass(found, loaded),
            tool=found.tool,
            part=found.part,
            position=formats.format_wall_time(found.at),
            why=tr(found.why),
            changed=tr(" (PROGRAM CHANGED SINCE THEN)") if _changed(found, loaded) else "",
        )
    )
    return NoticeRow(words, _describe_positions(found, snapshot, units) + _describe_uncertainty(found))


def make_interrupted_prompt(snapshot: Snapshot, loaded: LoadedProgram, start_instruction: str) -> str:
    """Return the prompt for an interrupted job on the Automatic page.

    The prompt is empty if the loaded program was not interrupted. ``start_instruction`` is the instruction
    for starting a cycle.
    """
    line = snapshot.interrupted_line
    if not line or snapshot.state is not MachineState.IDLE or snapshot.starts is not StartAction.PROGRAM:
        return ""
    if snapshot.confirmed:
        words = tr("STARTS AT LINE 1 ({text}) FROM CURRENT T{tool} POSITION. {start}. ESC: CANCEL")
        return tr(Message(words, text=_first(loaded), tool=snapshot.modal.tool, start=start_instruction))
    if not can_restart_program(loaded):
        return tr(Message("STOPPED IN LINE {line}. JOG THE TOOL CLEAR. Y: START OVER", line=line))
    words = tr("STOPPED IN LINE {line}. F6: RETRACT AND RESUME. Y: START OVER")
    return tr(Message(words, line=line))


def can_restart_program(loaded: LoadedProgram) -> bool:
    """Return whether SEARCHTO supports the language of this program."""
    return loaded.source is None or loaded.source.dialect is Dialect.OMNITURN


def make_replace_question(interrupted_job: InterruptedJob, name: str) -> str:
    """Return the question that the screen asks before a program replaces an interrupted job."""
    words = tr(
        "T{tool} MAY BE IN THE PART ({program}, LINE {line}). PRESS Y TO CANCEL THE "
        "INTERRUPTED JOB AND LOAD {name}, N TO KEEP THE INTERRUPTED JOB"
    )
    return tr(
        Message(
            words,
            tool=interrupted_job.tool,
            program=interrupted_job.program,
            line=interrupted_job.line,
            name=name,
        )
    )


def _first(loaded: LoadedProgram) -> str:
    lines: Sequence[str] = loaded.source.lines if loaded.source is not None else ()
    return next((line.strip() for line in lines if line.strip()), "")


def _changed(found: InterruptedJob, loaded: LoadedProgram) -> bool:
    job = loaded.job
    return job is not None and job.source.name == found.program and job.text_digest != found.text


def _describe_pass(found: InterruptedJob, loaded: LoadedProgram) -> str:
    """Return a text that states in which repetition of its line the job was interrupted.

    The text is empty if the line runs only once per part.
    """
    picture, job = loaded.picture, loaded.job
    if picture is None or job is None or job.text_digest != found.text:
        return ""
    passes = picture.find_block_ranges(found.line)
    now = next((n for n, (a, b) in enumerate(passes, 1) if a <= found.block <= b), 0)
    return (
        tr(Message(" REPETITION {now} OF {all}", now=now, all=len(passes))) if now and len(passes) > 1 else ""
    )


def _describe_positions(found: InterruptedJob, snapshot: Snapshot, units: DisplayUnits) -> str:
    """Return the tool's position at the stop and its current position as text.

    The positions are measured from home, as in the readout FROM HOME.
    """
    stood = _format_positions(found.axes, found.where, snapshot, units)
    if not all(snapshot.homed):
        return tr(Message("POSITION WAS {position} FROM HOME, NOW UNKNOWN UNTIL HOMED", position=stood))
    if snapshot.axes != found.axes:
        return tr(Message("POSITION WAS {position} FROM HOME", position=stood))
    if max(abs(a - b) for a, b in zip(found.where, snapshot.actual, strict=True)) <= _POSITION_TOLERANCE:
        return tr(Message("POSITION UNCHANGED: {position} FROM HOME", position=stood))
    now = _format_positions(snapshot.axes, snapshot.actual, snapshot, units)
    return tr(Message("POSITION WAS {position}, IS NOW {now} FROM HOME", position=stood, now=now))


def _describe_uncertainty(found: InterruptedJob) -> str:
    """Return a warning that the last second before the control failed was not recorded.

    The job's state is written once per second. After any other kind of interruption, the result is an empty
    string.
    """
    if found.why != POWER_LOST_REASON:
        return ""
    return tr(
        ". THE LAST SECOND BEFORE THE STOP WAS NOT RECORDED. CUT MAY BE INCOMPLETE. CHECK TOOL AND PART"
    )


def _format_positions(
    axes: Sequence[str], where: Sequence[float], snapshot: Snapshot, units: DisplayUnits
) -> str:
    """Return the positions of the linear axes as text, without the position of C."""
    metric, twice = units.metric(snapshot.modal.metric), snapshot.shows_diameter
    found = [
        Message(
            "{name} {ending}{position}",
            name=name,
            ending="Ø" if twice else "R",
            position=formats.format_length(2 * at if twice else at, metric),
        )
        if name == "X" and "Y" not in axes
        else Message("{name} {position}", name=name, position=formats.format_length(at, metric))
        for name, at in zip(axes, where, strict=False)
        if name in "XYZ"
    ]
    return " ".join(found)


def make_unknown_values_notice(snapshot: Snapshot) -> NoticeRow | None:
    """Return the notice about unknown values of a snapshot, or None if all values are known."""
    unknown = snapshot.unknown
    if not unknown:
        return None
    named = {
        UnknownPart.AXES: tr("POSITIONS"),
        UnknownPart.SPINDLE: tr("SPINDLE"),
        UnknownPart.OUTPUTS: tr("OUTPUTS"),
        UnknownPart.INPUTS: tr("INPUTS"),
    }
    what = ", ".join(words for which, words in named.items() if which in unknown)
    head = tr(Message("{what} UNKNOWN: NO RESPONSE FROM THE MACHINE", what=what))
    if UnknownPart.SPINDLE in unknown:
        head = tr("SPINDLE UNKNOWN – SPINDLE MAY BE TURNING: PRESS E-STOP")
    below = tr(Message("UNKNOWN: {what} · LAST KNOWN VALUES ARE SHOWN", what=what))
    return NoticeRow(head, below, color_name="alarm")
