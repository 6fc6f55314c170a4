"""Messages and questions of the prompt line never cover what the machine asks for."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QApplication

from app.desk.status.prompt_line import MessageKind
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts
from app.screen.text_sizes import make_screen_resolution
from app.screen.window.window_bars import PromptLine
from app.screen.window_layout import make_automatic_layout
from core.executor.snapshot import MachineState
from tests.screen.hands import Hands
from tests.screen.test_text_sizes import PANELS

STATE = "CYCLE START TO CONTINUE"
# 124 letters: longer than one line on every panel of less than 27 inches.
LONG = (
    "THE SPINDLE SPEED CANNOT BE CHANGED DURING A THREAD PASS: WAIT FOR THE END OF THE PASS OR STOP THE "
    "PROGRAM WITH FEED HOLD, H"
)


@pytest.fixture
def line(qapp: QApplication) -> PromptLine:
    """The prompt line while a program is stopped."""
    assert qapp is not None
    load_fonts()
    prompt = PromptLine(ScreenTheme(DARK_PALETTE), lambda _key: None)
    prompt.show_state(STATE)
    return prompt


def place(line: PromptLine, name: str) -> None:
    """Give the prompt line its size on a panel."""
    width, height, *_ = PANELS[name]
    line.theme.set_window_size(width, height)
    line.theme.screen = make_screen_resolution(*PANELS[name])
    at = make_automatic_layout(width, height, True, line.theme.screen)
    line.resize(at.prompt.w, at.prompt.h)


def painted(line: PromptLine) -> dict[str, QRectF]:
    """The painted texts and their rectangles."""
    line.read_painted_texts()  # From now on, painted texts are recorded.
    line.grab()
    return {text: box for box, text in line.read_painted_texts()}


@pytest.mark.parametrize("name", PANELS)
@pytest.mark.parametrize("asks", [False, True])
def test_long_message_or_question_does_not_cover_state(line: PromptLine, name: str, asks: bool) -> None:
    place(line, name)
    if asks:
        line.show_question(LONG, "Y")
    else:
        line.show_message(LONG, kind=MessageKind.REFUSAL)
    texts = painted(line)
    state = texts.pop(STATE)
    notice = [box for text, box in texts.items() if len(text) > 10 and text in LONG]
    assert len(notice) == (1 if name == "27" and not asks else 2)
    assert all(box.bottom() <= state.top() + 1 for box in notice)
    assert state.bottom() <= line.height()
    assert state.height() >= line.height() / 3


def test_long_message_uses_the_whole_line_while_the_machine_is_at_rest(line: PromptLine) -> None:
    place(line, "10")
    line.must_show_state = False
    line.show_message(LONG, kind=MessageKind.REFUSAL)
    texts = painted(line)
    assert STATE not in texts
    assert sum(box.height() for text, box in texts.items() if text in LONG) == pytest.approx(line.height())


def test_short_message_leaves_room_for_state_at_rest(line: PromptLine) -> None:
    place(line, "10")
    line.must_show_state = False
    line.show_message("NO PROGRAM", kind=MessageKind.REFUSAL)
    texts = painted(line)
    assert texts["NO PROGRAM"].bottom() <= texts[STATE].top()


@pytest.mark.parametrize(
    ("state", "shown"),
    [
        (MachineState.IDLE, False),
        (MachineState.DISABLED, False),
        (MachineState.RUN, True),
        (MachineState.HOLD, True),
        (MachineState.JOG, True),
        (MachineState.FAULT, True),
    ],
)
def test_state_is_always_shown_unless_the_machine_is_at_rest(
    hands: Hands, state: MachineState, shown: bool
) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)
    hands.window.refresh()
    assert hands.frame.prompt_line.must_show_state is shown
