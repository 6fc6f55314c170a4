"""A page on which keys and fingers are held to move a slide: what counts as held, and what ends it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.translation import tr
from app.jog.held_jog import HeldJog
from app.jog.jog_cross_view import JogCross
from app.jog.jog_speeds import JogDirection
from app.screen.page_base import Host, ModelPage, PageModel

Key = Qt.Key
CHORDS = (
    Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier
)


class HeldModel(PageModel, Protocol):
    """What such a page asks of its model. ``active``: something is held, or may move by itself."""

    @property
    def hold(self) -> HeldJog: ...

    @property
    def directions(self) -> Sequence[JogDirection]: ...

    @property
    def active(self) -> bool: ...

    def let_go(self) -> None: ...


class HeldKeysPage(ModelPage):
    """The model decides what a press means; this knows whether it is one. ``pad`` is its cross."""

    model: HeldModel
    pad: JogCross

    def __init__(self, host: Host, model: HeldModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self._arrows = {
            Key.__members__[f"Key_{each.key}"]: (each.axis, each.sign) for each in model.directions
        }
        self._was_active = False  # the window, before anything was held

    # --- keys ----------------------------------------------------------------------------------------

    def key_down(self, event: QKeyEvent) -> bool:
        """The arrows are this page's; any other key ends what is held and then means what it means."""
        key, model = Key(event.key()), self.model
        if key not in self._arrows:
            if not event.isAutoRepeat():
                model.hold.other_key()
            return self.other_key(event)
        if event.isAutoRepeat():
            model.hold.repeated(key.name)
        elif event.modifiers() & CHORDS:
            model.hold.other_key()
        elif event.modifiers() & Qt.KeyboardModifier.KeypadModifier:
            model.hold.other_key()
            self.desk.say(tr("NUM LOCK IS OFF. NUMBER PAD ARROWS DO NOT JOG"))
        else:
            axis, sign = self._arrows[key]
            rapid = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            model.hold.press(key.name, axis, sign, rapid=rapid)
        return True

    def other_key(self, _event: QKeyEvent) -> bool:
        """A key that is no direction; True takes it."""
        return False

    def key_up(self, event: QKeyEvent) -> None:
        """An arrow comes up, or the Shift of a rapid. Releases that a repeating key makes are none."""
        if event.isAutoRepeat():
            return
        key = Key(event.key())
        if key in self._arrows:
            self.model.hold.release(key.name)
        elif key == Key.Key_Shift:
            self.model.hold.shift_released()

    def pressed(self) -> None:
        """Whoever reaches for something else does not look at the slide."""
        self.model.hold.other_key()

    def let_go(self) -> None:
        """The keyboard or the window is gone."""
        self.pad.let_go()
        self.model.let_go()

    def _has_keyboard(self) -> bool:
        """Whether keys still come here: no dialog, no menu, no other window in front.

        A screen without a window manager never becomes active; there only the loss of it counts.
        """
        active = self.window().isActiveWindow()
        if not self.model.active:
            self._was_active = active
        covered = QApplication.activeModalWidget() or QApplication.activePopupWidget()
        return covered is None and (active or not self._was_active)

    def let_go_if_held(self) -> None:
        """Something lies in front that would take the release."""
        if self.model.active:
            self.let_go()
