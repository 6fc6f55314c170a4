"""Base class of the pages of the main window, with instructions on how to add a page.

A page is a ``Page`` (a QWidget) in the area that the fixed parts of the window do not cover. Title,
position, feed, spindle, lamps, station dock, prompt line and function keys belong to the ``WindowFrame``.
To add a page, add an entry to ``_OWN_PAGES`` in ``app.screen.page_table``. The page is created when it is
first opened. A page may override the following members:

- ``NAME``: its name in ``app.screen.page_table``, which the title line shows.
- ``LABELS``: ten labels of up to eight characters for the function keys. F1 is MENU.
  An empty label means that there is no key.
- ``make_key_labels()``: the labels, if they change.
- ``find_disabled_keys()``: the function keys that are disabled now. They are drawn dim, and show the reason
  when they are pressed.
- ``CAN_START_CYCLES``: whether the start buttons can start cycles while the page is shown.
- ``make_key_actions()``: its key actions, by the key names of ``app.screen.window.key_table``. They
  have priority over the actions of the frame. H, E, D, R and the pots work on every page without
  a caret, and F1 works on all pages.
- ``make_stop_key_actions()``: the actions of its characters that stop something. They also act while
  the alarm log or the help covers the page.
- ``handle_key_press``: receives every key press first, including repeats. True means that the page
  has handled the key.
- ``stop_held_key_actions()``: called before any other key or touch acts. Actions that need a key held down
  end.
- ``handle_key_release``: receives every key release.
- ``release_all_keys()``: called if no more key releases will arrive. All such actions end.
- ``handle_key(key)``: handles a key as text input: one character, or ``Enter Back Delete Tab Up
  Down``, ``Page up``, ``Page down``. True means that the page has handled the key. A standard
  widget with the focus handles its keys itself.
- ``accepts_key(key)``: whether this character is text input. Lamps then do not show it as their key.
- ``find_list()``: the list that the page keys, Home, End and the search use.
- ``has_text_field()``: whether an input field has the keyboard focus. Only then is a caret drawn, and
  every character belongs to the field.
- ``needs_height()``: whether large touch targets are shown, which a low window must have room for.
- ``find_pending_question()``: a question of the page, which has priority on the prompt line.
- ``prompt_text()``: the text of the prompt line if there is no message and no alarm.
- ``find_marked_help()``: help about the marked word, field or function, which the key ``?`` shows first.
- ``can_open()``: whether the page can be opened now. If not, it shows the reason with ``desk.say``.
- ``on_open()``: called when the page has opened. It may take the focus from the window.
- ``try_leave_page()``: called before the page or the window closes. False prevents closing. The page then
  shows the reason with ``desk.say``.
- ``is_esc_stop_key()``: whether Esc starts feed hold while the machine moves. False if Esc has another
  function.
- ``handle_escape()``: handles Esc. False means that the page closed nothing. The window then closes its
  question, starts feed hold, or opens the Automatic page.
- ``continue_preparation()``: prepares slow parts in slices before the page is shown. False means that no work
  remains.
- ``is_animating()``: whether the page shows an animation, so that it is drawn 60 times per second.
- ``refresh``: called once a frame with the snapshot, status and loaded program of one instant.
- ``apply_theme()``: called when the colors have changed. The frame redraws painted parts.

``host.open_page(name)`` opens another page, ``host.press_key(key)`` acts like a key press, and
``host.desk`` is the model. The frame sets the geometry of the page. Arrange the parts in ``resizeEvent``,
in units of ``theme.u``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.pages.editor_panel import EditorPanelModel
from app.desk.pages.guide_text import GuideBlock
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.screen.lists.searchable_list import SearchableList
from app.screen.screen_theme import ScreenTheme
from core.executor.snapshot import Snapshot

_LABELS: Mapping[str, Mapping[str, str]] = {
    "klartext": {"SECCMP": "PRESETS", "ZERO": "PRESETS"},
    "sinumerik": {"SECCMP": "ZERO"},
}


def find_key_label(language: str, label: str) -> str:
    """Return the text of a key label on a machine with the given programming language."""
    return _LABELS.get(language, {}).get(label, label)


KeyActions = Mapping[str, Callable[[], object]]  # Actions by key name. Their return values are not used.


@dataclass(frozen=True, slots=True)
class PageHost:
    """The objects and functions that the window frame provides to its pages."""

    theme: ScreenTheme
    desk: Desk
    press_key: Callable[[str], None]
    open_page: Callable[[str], bool]
    close_alarm_log: Callable[[], None]  # Closes the alarm log that covers the page.


class Page(QWidget):
    """Base class of all pages.

    The docstring of the module describes the members.
    """

    NAME: ClassVar[str]
    LABELS: ClassVar[tuple[str, ...]] = ("MENU", "", "", "", "", "", "ALARMS", "", "", "")
    CAN_START_CYCLES: ClassVar[bool] = False
    is_searching = False  # The search field is open. The page leaves the room of its entries to the list.
    has_enlarged_view = False  # The readouts are in one row, so that a view of the page has more room.

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(parent)
        self.host, self.theme, self.desk = host, host.theme, host.desk
        self.hide()

    @property
    def accessible_name(self) -> str:
        """Return the name for assistive technology."""
        return self.NAME

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the current labels of the function keys.

        This is called once a frame.
        """
        return tuple(find_key_label(self.desk.machine.program_language, label) for label in self.LABELS)

    def make_stop_key_actions(self) -> KeyActions:
        """Return the actions of the characters that stop something, by character.

        They also act while the alarm log or the help covers the page.
        """
        return {}

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the function keys that are currently disabled.

        This is called once a frame.
        """
        return frozenset()

    def make_key_actions(self) -> KeyActions:
        """Return the key actions of this page, by key name."""
        return {}

    def handle_key_press(self, _event: QKeyEvent) -> bool:
        """Handle a key press before the window and its other parts receive it.

        Return False to pass the key press on to them.
        """
        return False

    def handle_key_release(self, _event: QKeyEvent) -> None:
        """Handle a key release.

        The base class does nothing.
        """

    def stop_held_key_actions(self) -> None:
        """End the actions that last while a key is held down.

        This is called before another key or touch acts.
        """

    def release_all_keys(self) -> None:
        """End the actions that last while a key is held down.

        This is called when no key releases will arrive.
        """

    def handle_key(self, _key: str) -> bool:
        """Handle a key as text input.

        Return False to let the window handle the key.
        """
        return False

    def handle_touched_key(self, key: str) -> None:
        """Handle a touch on a key of the on-screen keyboard.

        Esc goes to the window, and any other key goes to this page, but not while a search is open.
        """
        if key == "Esc":
            self.host.press_key(key)
        elif self.is_searching:
            self.desk.say(tr("CLOSE THE SEARCH FIRST (ESC)"))
        else:
            self.handle_key(key)

    def accepts_key(self, _key: str) -> bool:
        """Return whether this character is text input for the page."""
        return False

    def has_text_field(self) -> bool:
        """Return whether an input field of the page has the keyboard focus."""
        return False

    def find_list(self) -> SearchableList | None:
        """Return the list that the page keys, Home, End and the search use, or None without a list."""
        return None

    def has_unfinished_entry(self) -> bool:
        """Return whether a typed value or text is neither saved nor discarded."""
        rows = self.find_list()
        return rows is not None and rows.has_typed_text

    def continue_preparation(self) -> bool:
        """Prepare one slice of the slow parts before the page is shown.

        Return False if no work remains.
        """
        return False

    def is_animating(self) -> bool:
        """Return whether the page shows an animation or live measurements."""
        return False

    def needs_height(self) -> bool:
        """Return whether large touch targets are shown, so that a low window has no large position."""
        return False

    def find_pending_question(self) -> str:
        """Return a question that must always be visible, or an empty string if there is none."""
        return ""

    def prompt_text(self) -> str:
        """Return the page's prompt, or an empty string to show the prompt for the machine state instead."""
        return ""

    def find_marked_help(self) -> Sequence[GuideBlock]:
        """Return help about the marked word, field or function, or an empty result if nothing is marked."""
        return ()

    def can_open(self) -> bool:
        """Return whether the page can be opened now. If not, show the reason."""
        return True

    def on_open(self) -> None:
        """Handle the opening of the page.

        The base class does nothing.
        """

    def try_leave_page(self) -> bool:
        """Prepare for closing, and return whether another page may replace this page.

        If not, show the reason on the prompt line.
        """
        return True

    def is_esc_stop_key(self) -> bool:
        """Return whether Esc starts feed hold while the machine moves.

        The result is False if an input field uses Esc.
        """
        return not self.has_text_field()

    def handle_escape(self) -> bool:
        """Handle Esc, and return whether something on the page was closed."""
        return False

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Show the snapshot, status and loaded program, which are all from the same instant.

        This is called once a frame.
        """

    def apply_theme(self) -> None:
        """Apply the current colors."""


class PageModel(Protocol):
    """Interface of the model of a page.

    ``handle_escape`` returns False if there was nothing to cancel.
    """

    def handle_key(self, key: str) -> bool:
        """Handle a key as text input, and return False if the model does not use the key."""
        ...

    def accepts_key(self, key: str) -> bool:
        """Return whether this character is text input for the page."""
        ...

    def on_open(self) -> None:
        """Prepare the model when the page opens."""
        ...

    def handle_escape(self) -> bool:
        """Cancel the last step, and return False if there was nothing to cancel."""
        ...


class ModelPage(Page):
    """A page that shows a model and passes keys to it."""

    model: PageModel

    def handle_key(self, key: str) -> bool:
        """Pass a key to the model."""
        return self.model.handle_key(key)

    def accepts_key(self, key: str) -> bool:
        """Return whether this character is text input for the model."""
        return self.model.accepts_key(key)

    def on_open(self) -> None:
        """Notify the model that the page has opened."""
        self.model.on_open()

    def handle_escape(self) -> bool:
        """Let the model go back one step."""
        return self.model.handle_escape()


class HeaderKey(NamedTuple):
    """Touch target above the editor's text. A touch opens the editor panel.

    ``label`` is the text of the target. ``name`` is the name of the equivalent key.
    """

    label: str
    name: str


class EditorPanel(QWidget):
    """Base class of the panels that features add to the editor.

    A feature registers a subclass as its ``editor_panel_class``. ``KEYS`` are the names of the keys that
    open the panel, from ``app.screen.window.key_table``.
    """

    KEYS: Sequence[str] = ()
    model: EditorPanelModel

    def __init__(self, host: PageHost, editor_page: Page) -> None:  # noqa: ARG002
        super().__init__(editor_page)
        self.model = EditorPanelModel()
        self.hide()

    def make_header_keys(self, program_name: str) -> Sequence[HeaderKey]:  # noqa: ARG002
        """Return the touch targets above the text of a program, from right to left."""
        return ()

    def open_for_text(self, key_name: str, program_name: str, text: str, line_number: int) -> str:  # noqa: ARG002
        """Open the panel for this program text.

        Return an empty string, or the reason if this is not possible. ``line_number`` is the line of the
        cursor, from 1. ``key_name`` is the name of the pressed key, or an empty string if a program is
        created from a file.
        """
        return ""

    def needs_height(self) -> bool:
        """Return whether the panel shows large touch targets, which a low window must have room for."""
        return False

    def refresh(self) -> None:
        """Update the panel from the model.

        This is called once a frame.
        """
