"""Notices above the page that remain until the operator acts, with their keys."""

from __future__ import annotations

from dataclasses import replace

from app.desk.desk import Desk
from app.desk.pages.page_entry import find_program_refusal
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.interrupted_notice import (
    NoticeRow,
    can_restart_program,
    make_interrupted_notice,
    make_unknown_values_notice,
)
from app.desk.translation import tr
from app.screen.window.key_table import RELOAD_KEY
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message

_SEARCHTO, _FROM_LINE_1, _RELOAD = ("F6", "SEARCHTO"), ("Y", "FROM LINE 1"), (RELOAD_KEY, "RELOAD")


def make_notices(
    desk: Desk, snapshot: Snapshot, loaded: LoadedProgram, *, here: bool
) -> tuple[NoticeRow, ...]:
    """Return the notices that remain until the operator acts.

    A caption is the only notice while it is shown, so that the viewer reads only the caption. ``here`` is
    True while the Automatic page, on which the keys of the notices work, is open.
    """
    card = desk.page_registry.make_guidance_row()
    if card is not None and card.is_caption:
        return (card,)
    rows = []
    unheard = make_unknown_values_notice(snapshot)
    if unheard is not None:
        rows.append(unheard)
    found = make_interrupted_notice(snapshot, loaded, desk.settings_store.display_units)
    if found is not None:
        rows.append(replace(found, keys=_make_prompt_keys(desk, snapshot, loaded) if here else ()))
    if card is not None:
        rows.append(card)
    elif here and desk.settings_store.current_settings.first_job:
        rows.append(desk.program_runs.first_job_card.notice_row)
    differs = desk.storage_state.describe_file_difference()
    if differs:
        rows.append(NoticeRow(differs, keys=_make_reload_keys(desk, snapshot) if here else ()))
    offered_job = desk.page_registry.find_notice(snapshot) if here else None
    if offered_job is not None:
        rows.append(offered_job)
    if desk.storage_state.read_storage_problem():
        held = desk.storage_state.read_unsaved_text()
        waits = tr(Message("NOT SAVED YET: {what}. DO NOT EXIT TURNDESK NOW", what=held)) if held else ""
        rows.append(
            NoticeRow(tr(Message("NOT SAVED: {why}", why=desk.storage_state.read_storage_problem())), waits)
        )
    return tuple(rows)


def _make_reload_keys(desk: Desk, snapshot: Snapshot) -> tuple[tuple[str, str], ...]:
    """Return the key that reloads a changed program. A program that runs cannot be reloaded."""
    can_reload = desk.storage_state.can_reload_file() and not find_program_refusal(snapshot)
    return (_RELOAD,) if can_reload else ()


def _make_prompt_keys(desk: Desk, snapshot: Snapshot, loaded: LoadedProgram) -> tuple[tuple[str, str], ...]:
    """Return the keys of the notice about an interrupted job.

    A start that would be rejected gets no key.
    """
    if snapshot.state is not MachineState.IDLE or not snapshot.interrupted_line:
        return ()
    searchto = (_SEARCHTO,) if can_restart_program(loaded) else ()
    return searchto if desk.find_first_move_refusal(snapshot) else (*searchto, _FROM_LINE_1)
