"""Whether the editor may be entered now.

The control cancels the spindle-on command when its editor is entered, so that nobody writes beside a turning
chuck. No command of the executor does just that (Reset gives the program up as well), so entering is refused
until the spindle stands.
"""

from __future__ import annotations

from functools import partial

from app.desk import prompt_line
from app.desk.desk import Desk
from app.desk.readouts import TURNING
from app.desk.translation import tr
from app.editor import messages
from app.editor.editor import Editor, Left
from core.executor.snapshot import Snapshot

UNDER_WAY = prompt_line.MOVING | prompt_line.INTERRUPTED


def refusal(snapshot: Snapshot) -> str:
    """Why not, in the words of the prompt line; empty when the editor may be entered."""
    if snapshot.state in UNDER_WAY:
        return messages.UNDER_WAY
    if snapshot.rpm_command:
        return messages.SPINDLE_ON
    return messages.COASTING if abs(snapshot.rpm_actual) > TURNING else ""


def enter(desk: Desk, editor: Editor) -> bool:
    """Go into the editor: with the program of the name that was typed, or else with that on the desk.

    A name that no program has is offered as a new file. False when it is refused; the desk says why.
    """
    why = refusal(desk.snapshot())
    name, now = editor.wanted.strip(), desk.session.now
    editor.wanted = ""
    path = desk.shelf.find(name) if name else now.path
    if why or not (name or path):
        desk.say(why or messages.NO_PROGRAM)
        return False
    desk.clear()
    editor.left = partial(_take_up, desk)
    if path is None:
        editor.offer(name)
    else:
        editor.open(path, now.block_delete)
    return True


def _take_up(desk: Desk, left: Left) -> None:
    """The program on the desk is read and proved anew when its text has changed.

    Another one comes there only when it was written and left for that; to look at it changes nothing.
    """
    path, now = left.path, desk.session.now
    if path != now.path and not (left.to_desk and (left.changed or now.path is None)):
        stays = messages.SAVED_ONLY if left.changed else messages.LOOKED
        if now.path is None:
            stays = messages.SAVED_NONE
        desk.say(tr(stays).format(name=path.name, other=now.name))
    elif path == now.path and not left.changed:
        return
    elif desk.snapshot().state in UNDER_WAY:
        desk.say(tr(messages.RELOAD))  # somebody started a cycle at the station meanwhile
    elif path == now.path:
        desk.session.load(path, now.block_delete)
    else:
        desk.put_on_desk(path)
