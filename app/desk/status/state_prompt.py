"""Prompt for the current state, reasons that prevent a cycle start, and the remaining cycle time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status import prompt_line
from app.desk.status.machine_status import make_wait_prompt
from app.desk.translation import tr
from core.executor.snapshot import MachineState, Snapshot, StartAction
from core.message import Message, join_messages

if TYPE_CHECKING:
    from app.desk.desk import Desk


def make_page_prompt(desk: Desk, snapshot: Snapshot, loaded: LoadedProgram, page_prompt: str = "") -> str:
    """Return the prompt for the current state, without questions and messages.

    ``page_prompt`` is the prompt of the current page. An alarm or an E-stop replaces this prompt.
    """
    desk.prompt_line.remove_expired_texts(snapshot)
    if desk.desk_control.silence_watch.is_silent:
        return (
            prompt_line.CONTROL_SILENT
            if desk.desk_control.restart_control is None
            else prompt_line.RESTART_CONTROL
        )
    if desk.window_state.is_keyboard_lost and snapshot.state in prompt_line.MOVING_STATES:
        return prompt_line.STOP_KEYS_INACTIVE
    announced = prompt_line.find_announcements(snapshot, can_start_here=desk.window_state.can_start_here)
    return join_messages(" · ", filter(None, (*announced, _prompt(desk, snapshot, loaded, page_prompt))))


def _prompt(desk: Desk, snapshot: Snapshot, loaded: LoadedProgram, page: str) -> str:
    if page:
        return (
            prompt_line.make_alarm_prompt(
                snapshot, desk.release_instruction, is_field_open=desk.window_state.has_text_field()
            )
            or page
        )
    words = desk.start_instruction, desk.release_instruction
    standing = prompt_line.make_prompt(
        snapshot, loaded, *words, is_field_open=desk.window_state.has_text_field()
    )
    if snapshot.state is MachineState.DISABLED and desk.changes.barred:
        standing = desk.changes.barred
    elif refusal := desk.find_first_move_refusal(snapshot):
        standing = Message("{no_start}: {refusal}", no_start=prompt_line.WILL_NOT_START, refusal=refusal)
    elif (
        desk.start_watch is not None and desk.start_watch.is_checking and snapshot.state is MachineState.IDLE
    ):
        standing = tr("CHECKING THE FIRST MOVE FOR COLLISION WITH THE PART")
    if snapshot.state is MachineState.WAIT:
        standing = make_wait_prompt(snapshot, desk.desk_control.set_input is not None) or standing
    return join_messages(" · ", filter(None, (_find_due_prompt(desk, snapshot, standing), standing)))


def _find_due_prompt(desk: Desk, snapshot: Snapshot, prompt: str) -> str:
    """Return the reminders of the run watchers that apply now, as one text.

    The result is an empty string during an alarm, an interrupted job or a refusal.
    """
    waits = snapshot.state in {MachineState.ESTOP, MachineState.FAULT} or snapshot.interrupted_line
    if waits or prompt.startswith(prompt_line.WILL_NOT_START):
        return ""
    return join_messages(
        " · ", filter(None, (watcher.find_reminder() for watcher in desk.page_registry.run_watchers))
    )


def find_start_refusal(desk: Desk, snapshot: Snapshot) -> str:
    """Return the reason why the start buttons are disabled, or an empty string if they are enabled."""
    refused = desk.barred() or desk.find_first_move_refusal(snapshot)
    if refused or snapshot.state is not MachineState.IDLE or snapshot.starts is not StartAction.PROGRAM:
        return refused
    return prompt_line.find_start_obstacle(snapshot, desk.program_loader.loaded_program)


def find_remaining_time_s(snapshot: Snapshot, loaded: LoadedProgram) -> float:
    """Return the remaining cycle time at the current override, in seconds.

    The time is inf if it is unknown.
    """
    picture = loaded.picture
    if picture is None or loaded.proof is None:
        return float("inf")
    to_go = math.dist(snapshot.block_end[:2], snapshot.actual[:2])
    left = picture.time_left(snapshot.block, to_go)
    return left / snapshot.feed_override if snapshot.feed_override > 0 else float("inf")
