"""SEARCHTO of a desk on this machine."""

from __future__ import annotations

from app.desk.desk import Desk
from app.desk.searchto.search import SearchDesk
from core.interpreter.restart.approach import Choices
from core.machine.model import Machine

_LAST = 0.2  # of the manual rapid: the leg that comes to the part


def give_searchto(desk: Desk, machine: Machine) -> None:
    """Give the desk its SEARCHTO; the way back goes at the manual rapid, its last leg slower."""
    rapid = machine.manual_rapid
    choices = Choices(rapid=rapid, last=_LAST * rapid)
    desk.searchto = SearchDesk(desk.session, desk.post, desk.snapshot, desk.say, desk.clear, choices)
