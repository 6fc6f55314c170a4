"""Every alarm has room where it is told, on the smallest screen: nothing of it is cut off."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QFontMetricsF
from PySide6.QtWidgets import QApplication

from app.desk.status.machine_status import make_machine_status
from app.desk.status.prompt_line import describe_cause, make_alarm_prompt, reason
from app.desk.status.readouts import ReadoutKind
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts
from app.screen.window.run_row import describe_stop
from core.alarms import CATALOG, AlarmCode, AlarmReaction
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import MachineState, Snapshot
from tests.texts import text as wording

UNIT = 600 / 90  # pixels at 1024×600
ACROSS = 1024 - 3 * UNIT
LIST = ACROSS - 24 * UNIT - 17 * UNIT - 4 * UNIT  # beside the station, behind the column of times
CODES = pytest.mark.parametrize("code", sorted(CATALOG))


@pytest.fixture
def look(qapp: QApplication) -> ScreenTheme:
    assert qapp is not None
    load_fonts()
    return ScreenTheme(DARK_PALETTE, min(1024 / 160, UNIT))


def fits(look: ScreenTheme, text: str, size: float, width: float, *, bold: bool = False) -> bool:
    font = look.fit_font(text, size, width, is_bold=bold)
    return QFontMetricsF(font).horizontalAdvance(text) <= width + 1


def snapshot(code: AlarmCode) -> Snapshot:
    alarm = make_alarm(code, "", 1234, 0.0)
    if CATALOG[code].reaction in {AlarmReaction.DRIVES_OFF, AlarmReaction.STOP}:
        return Snapshot(state=MachineState.FAULT, alarms=(alarm,))
    return Snapshot(state=MachineState.HOLD, stop=alarm)


@CODES
def test_alarm_text_cause_and_remedy_fit_their_panels(look: ScreenTheme, code: AlarmCode) -> None:
    shot = snapshot(code)
    view = make_machine_status(shot, ReadoutKind.POSITION, True)
    assert fits(look, view.state_text, 2.5, 42 * look.unit_px, bold=True), view.state_text
    assert fits(look, describe_stop(view), 2.5, ACROSS - 24 * UNIT - 6 * UNIT, bold=True)
    assert fits(look, reason(view), 1.9, ACROSS), reason(view)
    assert fits(look, make_alarm_prompt(shot, wording("stories.release-by-u")), 2.1, ACROSS, bold=True)


@CODES
def test_alarm_texts_fit_list_of_stops(look: ScreenTheme, code: AlarmCode) -> None:
    alarm = make_alarm(code, "", 1234, 0.0)
    assert fits(look, f"{alarm.number}  ·  {alarm.text}", 2.0, LIST, bold=True)
    assert fits(look, describe_cause(alarm), 1.8, LIST), describe_cause(alarm)
    assert fits(look, alarm.remedy, 1.8, LIST), alarm.remedy
