"""The prompt for the present state, the reason why no cycle starts, and the remaining cycle time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from app.desk.programs.program_loading import Loaded
from app.desk.status import prompt_line
from app.desk.status.machine_status import how_it_ends
from app.desk.translation import tr
from core.executor.snapshot import Snapshot, Starts, State
from core.message import Message, join_messages

if TYPE_CHECKING:
    from app.desk.desk import Desk


def prompt(desk: Desk, snapshot: Snapshot, loaded: Loaded, page: str = "") -> str:
    """Return the prompt for the present state. Question and message have their own places.

    ``page`` is the prompt of the current page. An alarm or an E-stop replaces it.
    """
    desk.answers.expire(snapshot)
    if desk.control.silence.is_silent:
        return prompt_line.CONTROL_SILENT if desk.control.restart is None else prompt_line.RESTART_CONTROL
    if desk.window.keyboard_away and snapshot.state in prompt_line.MOVING:
        return prompt_line.KEYBOARD_AWAY
    announced = prompt_line.announced(snapshot, starts_here=desk.window.starts_here)
    return join_messages(" · ", filter(None, (*announced, _prompt(desk, snapshot, loaded, page))))


def _prompt(desk: Desk, snapshot: Snapshot, loaded: Loaded, page: str) -> str:
    if page:
        return prompt_line.alarm_of(snapshot, desk.release_words, field_open=desk.window.has_field()) or page
    words = desk.start_words, desk.release_words
    standing = prompt_line.prompt(snapshot, loaded, *words, field_open=desk.window.has_field())
    if snapshot.state is State.DISABLED and desk.changes.barred:
        standing = desk.changes.barred
    elif refusal := desk.first_move_refusal(snapshot):
        standing = Message("{no_start}: {refusal}", no_start=prompt_line.NO_START, refusal=refusal)
    elif desk.first_move is not None and desk.first_move.checking and snapshot.state is State.IDLE:
        standing = tr("CHECKING THE FIRST MOVE FOR COLLISION WITH THE PART")
    if snapshot.state is State.WAIT:
        standing = how_it_ends(snapshot, desk.control.set_input is not None) or standing
    return join_messages(" · ", filter(None, (_due(desk, snapshot, standing), standing)))


def _due(desk: Desk, snapshot: Snapshot, standing: str) -> str:
    """Return the reminders of the watchers. Empty during an alarm, an interrupted job or a refusal."""
    waits = snapshot.state in {State.ESTOP, State.FAULT} or snapshot.interrupted_line
    if waits or standing.startswith(prompt_line.NO_START):
        return ""
    return join_messages(" · ", filter(None, (watcher.due() for watcher in desk.pages.run_watchers)))


def start_refusal(desk: Desk, snapshot: Snapshot) -> str:
    """Return why the start buttons have no effect now. Empty if they can start a cycle."""
    refused = desk.barred() or desk.first_move_refusal(snapshot)
    if refused or snapshot.state is not State.IDLE or snapshot.starts is not Starts.PROGRAM:
        return refused
    return prompt_line.lacking(snapshot, desk.session.now)


def time_left(snapshot: Snapshot, loaded: Loaded) -> float:
    """Return the time to the end of the cycle at the present override in seconds; inf if unknown."""
    picture = loaded.picture
    if picture is None or loaded.proof is None:
        return float("inf")
    to_go = math.dist(snapshot.block_end[:2], snapshot.actual[:2])
    left = picture.time_left(snapshot.block, to_go)
    return left / snapshot.feed_override if snapshot.feed_override > 0 else float("inf")
