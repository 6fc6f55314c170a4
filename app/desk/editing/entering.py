"""Whether the editor may be entered now.

The control cancels the spindle-on command when its editor is entered, so that nobody writes beside a turning
chuck. No command of the executor does just that (Reset gives the program up as well), so entering is refused
until the spindle stands.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

from app.desk import prompts
from app.desk.desk import Desk
from app.desk.editing import words
from app.desk.editing.editor import Editor
from app.desk.lamps import TURNING
from core.executor.snapshot import Snapshot

UNDER_WAY = prompts.MOVING | prompts.INTERRUPTED


def refusal(snapshot: Snapshot) -> str:
    """Why not, in the words of the prompt line; empty when the editor may be entered."""
    if snapshot.state in UNDER_WAY:
        return words.UNDER_WAY
    if snapshot.rpm_command:
        return words.SPINDLE_ON
    return words.COASTING if abs(snapshot.rpm_actual) > TURNING else ""


def enter(desk: Desk, editor: Editor) -> bool:
    """Go into the editor: with the program of the name that was typed, or else with that on the desk.

    A name that no program has is offered as a new file. False when it is refused; the desk says why.
    """
    why = refusal(desk.snapshot())
    name, now = editor.wanted.strip(), desk.session.now
    editor.wanted = ""
    path = desk.shelf.find(name) if name else now.path
    if why or not (name or path):
        desk.say(why or words.NO_PROGRAM)
        return False
    desk.clear()
    editor.left = partial(_reload, desk)
    if path is None:
        editor.offer(name)
    else:
        editor.open(path, now.block_delete)
    return True


def _reload(desk: Desk, path: Path) -> None:
    """What was edited becomes the program on the desk, read and proved anew."""
    if desk.snapshot().state in UNDER_WAY:
        desk.say(words.RELOAD)  # somebody started a cycle at the station meanwhile
    else:
        desk.session.load(path, desk.session.now.block_delete)
