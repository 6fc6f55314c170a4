"""Every key on every page in every state of the machine: what it changes is what the page offers.

What a key posts to the control or does at the station is recorded and not carried out, so the machine stays
in its state. Keys arrive as the platform sends them, through the keyboard layer.
"""

from __future__ import annotations

import string
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.editor import Stage
from app.editor.editor_view import EditorPage
from app.screen import page_table
from app.screen.page_table import pages_of
from core.executor.commands import (
    ConfirmStart,
    CycleStart,
    FeedHold,
    GiveProof,
    LoadJob,
    Prepare,
    Renew,
    SetSwitch,
    UseOffsets,
)
from core.executor.executor import Executor
from core.executor.snapshot import State
from drivers.lookalikes.plant_hands import PlantHands
from tests.screen.chapters import drives_on
from tests.screen.day import Day, Key, begun

TEXT = "G90G94F1\nX1Z1\nX0Z0\nM30\n"
NONE = Qt.KeyboardModifier.NoModifier
SIGNS = "+-,./ *()0123456789"
FUNCTION_KEYS = tuple(Key(Key.Key_F1 + n) for n in range(10))
STATION = ("press_estop", "press_hold", "set_spindle_auto", "press_left", "press_right")
QUIET = (ConfirmStart, Prepare, GiveProof, LoadJob, Renew, UseOffsets)  # of pages that open, and of workers


@dataclass
class Typist:
    """Types single keys, and notes what each of them does."""

    day: Day
    done: list[object] = field(default_factory=list)

    def press(self, key: int, text: str = "") -> list[object]:
        """Press and release a key where the platform sends keys; return what it did."""
        self.done.clear()
        self.day.desk.hands.estop_pressed = False  # it was recorded, and is not pressed
        knobs = self._knobs()
        for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
            QCoreApplication.sendEvent(self.day.window.windowHandle(), QKeyEvent(kind, key, NONE, text))
        found = [each for each in self.done if not isinstance(each, QUIET)]
        return found + [name for name, now in self._knobs().items() if now != knobs[name]]

    def character(self, text: str) -> list[object]:
        """Type a character."""
        return self.press(ord(text.upper()), text)

    def _knobs(self) -> dict[str, object]:
        hands, desk = self.day.desk.hands, self.day.desk
        return {
            "feed_pot": hands.feed_pot.wanted,
            "spindle_pot": hands.spindle_pot.wanted,
            "settings": desk.settings.now,
            "block_delete": desk.session.now.block_delete,
        }

    def opens(self, name: str) -> bool:
        """Open a page afresh; False where it does not open in this state."""
        frame = self.day.frame
        self.day.desk.clear()
        if isinstance(frame.page, EditorPage):
            self._leaves_editor(frame.page)
        elif frame.page.NAME != page_table.AUTOMATIC:
            frame.page.escape()
            frame.go(page_table.AUTOMATIC)
        frame.log.hide()
        frame.automatic.files.dismiss()
        opened = frame.page.NAME == page_table.AUTOMATIC and frame.go(name)
        self.day.window.refresh()
        return opened

    def _leaves_editor(self, page: EditorPage) -> None:
        """Leave without saving what was typed."""

        def left() -> bool:
            editor = page.editor
            if editor.stage is Stage.OFFERED:
                editor.abort()
            elif editor.stage is Stage.NAMING:
                editor.keep_no_name()
            elif editor.stage is Stage.OPEN:
                page.abandon()
                page.answer()
            return self.day.frame.page is not page

        self.day.sees(left)

    def fresh(self, name: str, has_field: bool) -> None:
        """Make up for what the last key opened."""
        frame = self.day.frame
        self.day.desk.clear()
        if (frame.page.NAME, frame.has_field()) != (name, has_field):
            self.opens(name)


def record(monkeypatch: pytest.MonkeyPatch, typists: list[Typist]) -> None:
    """Have everything recorded and not carried out from the moment on in which somebody types."""
    for kind, name in ((Executor, "post"), *((PlantHands, each) for each in STATION)):
        monkeypatch.setattr(kind, name, _recorded(getattr(kind, name), name, typists))


def _recorded(does: Callable[..., None], name: str, typists: list[Typist]) -> Callable[..., None]:
    def call(this: object, *values: object) -> None:
        if typists:
            typists[0].done.append(values[0] if name == "post" else name)
        else:
            does(this, *values)

    return call


def at_rest(day: Day) -> None:
    drives_on(day)


def loaded(day: Day) -> None:
    drives_on(day)
    day.key(Key.Key_F2)
    day.type("slow")
    day.key(Key.Key_Return)
    day.sees(lambda: day.prompt.endswith("(F11 + F12)"))


def running(day: Day) -> None:
    loaded(day)
    day.palms()
    day.reaches(State.RUN)


def in_hold(day: Day) -> None:
    running(day)
    day.key(Key.Key_Pause)
    day.desk.feed_hold()
    day.reaches(State.HOLD)


def stopped(day: Day) -> None:
    running(day)
    day.desk.estop()
    day.reaches(State.ESTOP)


def off(day: Day) -> None:
    day.reaches(State.DISABLED)


STATES = {"off": off, "rest": at_rest, "run": running, "hold": in_hold, "estop": stopped}
PAGES = tuple(entry.name for entry in pages_of("omniturn"))


@pytest.fixture
def typists(monkeypatch: pytest.MonkeyPatch) -> list[Typist]:
    """Who types; nothing reaches the machine while there is one."""
    found: list[Typist] = []
    record(monkeypatch, found)
    return found


@pytest.fixture
def day(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, typists: list[Typist]
) -> Iterator[Day]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot, "slow.nc", TEXT) as day:
        day.sees(lambda: QApplication.focusWindow() is day.window.windowHandle())
        yield day
        typists.clear()


def changes_a_cycle(done: list[object]) -> list[object]:
    """Of what a key did, that which changes how a cycle runs."""
    found = ("feed_pot", "spindle_pot", "block_delete", *STATION)
    return [each for each in done if isinstance(each, SetSwitch | CycleStart) or each in found]


def faults_of_characters(typist: Typist, name: str) -> list[str]:
    """What is wrong about letters, figures and signs on this page."""
    faults: list[str] = []
    frame = typist.day.frame
    has_field = frame.has_field()
    if frame.look.caret is not frame.page.has_field():
        faults.append(f"{name}: a caret without an entry, or an entry without its caret")
    for text in string.ascii_lowercase + SIGNS:
        typist.fresh(name, has_field)
        done = typist.character(text)
        stop = {"h": FeedHold, " ": FeedHold, "e": "press_estop"}.get(text)
        if has_field and (done or name != frame.page.NAME):
            faults.append(f"{name}: {text!r} is no text: {done} {frame.page.NAME}")
        elif not has_field and stop is not None and not _does(done, stop):
            faults.append(f"{name}: {text!r} stops nothing")
        elif name != page_table.AUTOMATIC and (text.isalpha() or text == "/") and _switches(done):
            faults.append(f"{name}: {text!r} changes the cycle: {done}")
    typist.fresh(name, has_field)
    return faults


def _switches(done: list[object]) -> bool:
    return bool([each for each in changes_a_cycle(done) if each not in {"press_estop", "press_hold"}])


def _does(done: list[object], what: object) -> bool:
    return what in done or any(isinstance(what, type) and isinstance(each, what) for each in done)


def faults_of_keys(typist: Typist, name: str, state: str) -> list[str]:
    """What is wrong about function keys, Esc and the two keys that stop."""
    faults: list[str] = []
    frame, has_field = typist.day.frame, typist.day.frame.has_field()
    for number, key in enumerate(FUNCTION_KEYS):
        typist.fresh(name, has_field)
        offered = frame.page.labels()[number]
        done = typist.press(key)
        if not offered and (done or name != frame.page.NAME):
            faults.append(f"{name}: F{number + 1} has no label and does {done}, {frame.page.NAME}")
        if _does(done, FeedHold) or _does(done, CycleStart) or "press_estop" in done:
            faults.append(f"{name}: F{number + 1} does {done}")
    for key, stop in ((Key.Key_Pause, FeedHold), (Key.Key_ScrollLock, "press_estop")):
        typist.fresh(name, has_field)
        if not _does(typist.press(key), stop):
            faults.append(f"{name}: {key} does not stop")
    typist.fresh(name, has_field)
    offers = "ESC" in frame.page.prompt().upper().replace("ESC FOR FEED HOLD", "")
    held = _does(typist.press(Key.Key_Escape), FeedHold)
    if held and (offers or state != "run"):
        faults.append(f"{name}: Esc holds, offered is {frame.page.prompt()}")
    if held and name != frame.page.NAME:
        faults.append(f"{name}: Esc holds and leaves the page")
    return faults


@pytest.mark.parametrize("state", STATES)
def test_every_key_does_what_the_page_offers(day: Day, state: str, typists: list[Typist]) -> None:
    STATES[state](day)
    typist = Typist(day)
    typists.append(typist)
    faults: list[str] = []
    seen: list[str] = []
    for name in PAGES:
        if not typist.opens(name):
            continue
        seen.append(name)
        faults += faults_of_characters(typist, name)
        if typist.opens(name):
            faults += faults_of_keys(typist, name, state)
    typist.opens(page_table.AUTOMATIC)
    assert faults == [], "\n".join(faults)
    assert {page_table.JOG, *({page_table.EDITOR} if day.shot.program else ())} <= set(seen)
    assert {page_table.PROGRAMS, page_table.SECCMP, page_table.TOOLS, page_table.SPECIAL} < set(seen)
