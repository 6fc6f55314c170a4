"""Handling of keys that answer a question or enter text on the page, and the actions of all other keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

from app.desk.desk import Desk
from app.desk.translation import tr
from app.screen.window.key_table import (
    AUTOMATIC_KEYS,
    MODIFIER_KEYS,
    NO_KEY,
    PALM_BUTTON_KEYS,
    REPEATED_WHEN_TYPED,
    SEARCH_KEY,
    STOP_LETTERS,
    YES_KEY,
    find_key_code,
    find_key_name,
    find_letter,
    find_typed_text,
)
from app.screen.window.keyboard import KeyboardFilter
from app.screen.window.window_frame import WindowFrame
from core.message import Message

# Editing keys that have no function while the alarm log covers the page.
COVERED_KEYS = frozenset({"Enter", "Back", "Delete", "Tab", "Left", "Right"})


class TypedKeyHandler:
    """Handler of keys that a question or the current page uses, before the key actions are executed."""

    def __init__(
        self,
        keyboard_filter: KeyboardFilter,
        press_key: Callable[[str], None],
        refresh: Callable[[], None],
    ) -> None:
        self._keyboard_filter = keyboard_filter
        self._press_key, self._refresh = press_key, refresh
        self._rejected_text = ""  # Message about the last character that an input field rejected.

    def is_used_elsewhere(self, frame: WindowFrame, name: str) -> bool:
        """Return whether a key works only on the Automatic page while another page is open.

        If so, also show a message.
        """
        if (
            name not in AUTOMATIC_KEYS
            or frame.current_page is frame.automatic_page
            or name in frame.current_page.make_key_actions()
        ):
            return False
        frame.desk.say(tr(Message("{key} WORKS ON THE AUTOMATIC PAGE: PRESS F1, THEN F2", key=name)))
        self._refresh()
        return True

    def handle_priority_key(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the key was discarded or refused, answered a question or stopped something."""
        return (
            self.handle_stop_key(frame, event)
            or self._discard_search_text(frame, event)
            or self._is_palm_refused(frame, event)
            or self.handle_answer(frame, event)
        )

    def _is_palm_refused(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the key is a palm button that is refused because letters stop nothing now."""
        if event.key() not in PALM_BUTTON_KEYS or not frame.search_bar.is_open:
            return False
        frame.desk.say(tr("CLOSE THE SEARCH FIRST (ESC)"))
        self._refresh()
        return True

    def _discard_search_text(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the key is discarded because the search was closed while the operator typed.

        A question also closes the search. The stop keys of the page act. All other stop keys have already
        acted in the keyboard filter.
        """
        frame.search_bar.close_for_question()
        is_stop = find_typed_text(event) in frame.current_page.make_stop_key_actions()
        if is_stop or event.key() in MODIFIER_KEYS or event.key() == Qt.Key.Key_Escape:
            return False
        if not frame.search_bar.discard_key(is_repeat=event.isAutoRepeat()):
            return False
        self._refresh()
        return True

    def handle_answer(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the key answered a question.

        Yes is accepted only while no other key is pressed.
        """
        typed = {find_letter(event), find_typed_text(event)} - {""}
        if not frame.desk.confirmation_key or not typed & {frame.desk.confirmation_key, "N"}:
            return False
        if "N" in typed and frame.desk.confirmation_key != "N":
            self._press_key(NO_KEY)
        elif not event.isAutoRepeat() and self._keyboard_filter.is_only_key(event):
            self._press_key(YES_KEY)
        return True

    def handle_stop_key(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the key stopped something on a page that the alarm log or the help covers."""
        is_covered = frame.is_page_covered or frame.help_panel.isVisible()
        if event.isAutoRepeat() or not is_covered or frame.has_text_field():
            return False
        stop = frame.current_page.make_stop_key_actions().get(find_typed_text(event))
        if stop is None:
            return False
        frame.help_panel.close_help()
        stop()
        self._refresh()
        return True

    def is_character_rejected(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether an input field rejects a character.

        The character then has no other function. For example, Ctrl+H, Ctrl+Space and Ctrl+E do not stop the
        machine while an input field is active.
        """
        text, name = event.text(), find_key_name(find_key_code(event), event.modifiers())
        if not text.isprintable() or not text or not frame.has_text_field():
            return frame.has_text_field() and name in STOP_LETTERS
        if name == SEARCH_KEY:
            return False
        if not event.isAutoRepeat():
            self._rejected_text = tr(Message("{key} CANNOT BE ENTERED IN THIS FIELD", key=text))
            frame.desk.say(self._rejected_text)
            self._refresh()
        return True

    def _discard_text(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the key is text for an input field that the alarm log covers.

        Such text must not act as commands. Only the stop letters still act.
        """
        text = event.text()
        is_stop = find_key_name(find_key_code(event), event.modifiers()) in STOP_LETTERS
        if is_stop or not text or not text.isprintable() or not frame.covers_text_field:
            return False
        if not event.isAutoRepeat():
            frame.desk.say(tr("THE LIST OF ALARMS COVERS THE ENTRY. F7: CLOSE THE LIST"))
            self._refresh()
        return True

    def handle_typed_key(self, frame: WindowFrame, event: QKeyEvent) -> bool:
        """Return whether the alarm log or the page has handled the key as text input.

        A page that the alarm log covers handles no keys except its stop keys, so that no axis moves and no
        line runs unseen.
        """
        key = find_typed_text(event)
        is_used = bool(key) and (not event.isAutoRepeat() or key in REPEATED_WHEN_TYPED)
        if frame.search_bar.is_open:
            if is_used:
                frame.search_bar.handle_key(key)
                self._refresh()
            return bool(key)
        if frame.is_page_covered:
            if frame.alarm_list.move_selection(key):
                self._refresh()
                return True
            return key in COVERED_KEYS or self._discard_text(frame, event)
        if not is_used or not (frame.search_bar.move_selection(key) or frame.current_page.handle_key(key)):
            return False
        if frame.desk.prompt_notice == self._rejected_text:
            frame.desk.clear_prompt_line()  # The next key was accepted.
        self._refresh()
        return True


def make_key_actions(desk: Desk) -> dict[str, Callable[[], None]]:
    """Return the actions of the keys by key name."""
    return {
        "S": partial(desk.toggle_switch, "single_block"),
        "O": partial(desk.toggle_switch, "optional_stop"),
        "C": partial(desk.toggle_switch, "cycle_repeat"),
        "P": partial(desk.toggle_switch, "no_count"),
        "/": desk.program_choice.toggle_block_delete,
        "H": desk.start_feed_hold,
        "R": desk.reset_control,
        "D": desk.enable_drives,
        "E": desk.station_keys.press_estop,
        "U": desk.station_keys.release_estop,
        YES_KEY: desk.confirm_question_if_unchanged,
        NO_KEY: desk.reject_question,
        "A": desk.station_keys.toggle_spindle_switch,
        ",": partial(desk.station_controls.turn_spindle_pot, -1),
        ".": partial(desk.station_controls.turn_spindle_pot, 1),
        "+": partial(desk.station_keys.step_feed_override, 1),
        "-": partial(desk.station_keys.step_feed_override, -1),
        "Y": desk.confirm_question,
    }
