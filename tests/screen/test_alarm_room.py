"""Every alarm has room where it is told, on the smallest screen: nothing of it is cut off."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QFontMetricsF
from PySide6.QtWidgets import QApplication

from app.desk.status.machine_status import status_of
from app.desk.status.prompt_line import alarm_of, exactly, reason
from app.desk.status.readouts import Readout
from app.screen.look import DARK, Look, load_fonts
from app.screen.window.readout_panels import stop_words
from core.alarms import CATALOGUE, Code, Reaction
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import Snapshot, State
from tests.texts import text as wording

UNIT = 600 / 90  # pixels at 1024×600
ACROSS = 1024 - 3 * UNIT
LIST = ACROSS - 24 * UNIT - 17 * UNIT - 4 * UNIT  # beside the station, behind the column of times
CODES = pytest.mark.parametrize("code", sorted(CATALOGUE))


@pytest.fixture
def look(qapp: QApplication) -> Look:
    assert qapp is not None
    load_fonts()
    return Look(DARK, min(1024 / 160, UNIT))


def fits(look: Look, text: str, size: float, width: float, *, bold: bool = False) -> bool:
    font = look.fit(text, size, width, bold=bold)
    return QFontMetricsF(font).horizontalAdvance(text) <= width + 1


def snapshot(code: Code) -> Snapshot:
    alarm = make_alarm(code, "", 1234, 0.0)
    if CATALOGUE[code].reaction in {Reaction.OFF, Reaction.STOP}:
        return Snapshot(state=State.FAULT, alarms=(alarm,))
    return Snapshot(state=State.HOLD, stop=alarm)


@CODES
def test_head_cause_and_remedy_are_whole(look: Look, code: Code) -> None:
    shot = snapshot(code)
    view = status_of(shot, Readout.POSITION, True)
    assert fits(look, view.state, 2.5, 42 * look.u, bold=True), view.state
    assert fits(look, stop_words(view), 2.5, ACROSS - 24 * UNIT - 6 * UNIT, bold=True)
    assert fits(look, reason(view), 1.9, ACROSS), reason(view)
    assert fits(look, alarm_of(shot, wording("stories.release-by-u")), 2.1, ACROSS, bold=True)


@CODES
def test_the_list_of_stops_has_room_for_it(look: Look, code: Code) -> None:
    alarm = make_alarm(code, "", 1234, 0.0)
    assert fits(look, f"{alarm.number}  ·  {alarm.text}", 2.0, LIST, bold=True)
    assert fits(look, exactly(alarm), 1.8, LIST), exactly(alarm)
    assert fits(look, alarm.remedy, 1.8, LIST), alarm.remedy
