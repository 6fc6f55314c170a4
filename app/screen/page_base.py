"""What a page of the main window is, and where another one is plugged in.

A page is a ``Page`` (a QWidget) that fills the room between the always visible parts: title, position, feed,
spindle, lamps, dock, prompt and function keys belong to the ``Frame``. To plug one in, add an entry to
``PAGES`` in ``app.screen.page_table``. It is made when it is first opened. What a page gives:

``NAME``      its name in ``app.screen.page_table``; the title line shows it.
``LABELS``    ten labels of up to eight characters for the function keys; an empty one is no key. F1 is MENU.
``labels()``  the same, where they change with what the page is doing.
``barred()``  the function keys that would be refused now: they are drawn dim, and say why when pressed.
``STARTS``    whether cycles are started while it is shown; only the Automatic page's palms start anything.
``key_actions()``  what its keys do, by the names of ``app.screen.window.keys``. They go before those of the
              frame; H, E, D, R and the pots work on every page without a caret, F1 on all pages.
``key_down``  sees every key that goes down (also a repeating one) before all else; True takes it.
``pressed()`` is told before any other key or finger acts: what is held on the page ends then.
``key_up``    sees every key that comes up; ``let_go()``: no release will arrive any more, let go of all.
``typed(k)``  takes a key before it means anything else: one character, or ``Enter Back Delete Tab Up Down``,
              ``Page up``, ``Page down``; True when it was taken. A stock widget
              that has the focus takes its keys by itself.
``takes(k)``  whether it takes that character as text: the lamps then do not show it as their key.
``has_field()`` whether an entry has the keyboard. Exactly then a caret is drawn, and every character is the
              entry's: one that it does not take means nothing.
``asks()``    a question of its own: it goes before anything else on the prompt line.
``prompt()``  what stands on the prompt line when the desk has no answer and no alarm to show there.
``opens()``   whether it may come up now; when not, it says why by ``desk.say`` and the page before stays.
``opened()``  it has come up; it may take the focus (the window has it otherwise).
``leave()``   it is about to go, or the window is about to close; False keeps it (it then says why by
              ``desk.say``).
``esc_holds()`` whether Esc holds the feed while something moves; not where the page offers Esc for something.
``escape()``  Esc; False when nothing was closed by it: then the desk takes its question back or holds, and
              where it has neither the Automatic page comes up.
``ahead()``   makes one slice of what takes long, while the page is not shown yet; False: nothing is left.
``lively()``  whether something on it moves by itself, so that it is shown 60 times a second at rest, too.
``refresh``   once a frame while it is shown: snapshot, view and loaded program of the same instant.
``dress()``   the colours have changed; painted parts are updated by the frame anyway.

``host.go(name)`` opens another page, ``host.press(key)`` does what a key does (for fingers), and
``host.desk`` is the model. Geometry: the frame sets it; lay out in ``resizeEvent``, in units of ``look.u``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.pages.editor_panel import PanelModel
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.screen.look import Look
from core.executor.snapshot import Snapshot

_LABELS: Mapping[str, Mapping[str, str]] = {
    "klartext": {"SECCMP": "PRESETS", "ZERO": "PRESETS"},
    "sinumerik": {"SECCMP": "ZERO"},
}


def label_on(language: str, label: str) -> str:
    """The label of a key on a machine of this language."""
    return _LABELS.get(language, {}).get(label, label)


KeyActions = Mapping[str, Callable[[], object]]  # by the name of the key; what they answer is not used


@dataclass(frozen=True, slots=True)
class Host:
    """What the frame gives to its pages."""

    look: Look
    desk: Desk
    press: Callable[[str], None]
    go: Callable[[str], bool]
    clear_away: Callable[[], None]  # close the log that lies over the page


class Page(QWidget):
    """A page that does nothing yet; see the module for what each part means."""

    NAME: ClassVar[str]
    LABELS: ClassVar[tuple[str, ...]] = ("MENU", "", "", "", "", "", "ALARMS", "", "", "")
    STARTS: ClassVar[bool] = False

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(parent)
        self.host, self.look, self.desk = host, host.look, host.desk
        self.hide()

    @property
    def part_name(self) -> str:
        """The name for assistive technology."""
        return self.NAME

    def labels(self) -> tuple[str, ...]:
        """The labels of this moment; asked for once a frame."""
        return tuple(label_on(self.desk.machine.language, label) for label in self.LABELS)

    def barred(self) -> frozenset[str]:
        """Return the function keys that would be refused now; asked for once a frame."""
        return frozenset()

    def key_actions(self) -> KeyActions:
        """Keys of this page alone."""
        return {}

    def key_down(self, _event: QKeyEvent) -> bool:
        """Take a key as it goes down; False lets it mean what it means elsewhere."""
        return False

    def key_up(self, _event: QKeyEvent) -> None:
        """See a key come up."""

    def pressed(self) -> None:
        """A key or a finger is about to do something else, here or beside the page."""

    def let_go(self) -> None:
        """The keyboard has gone elsewhere."""

    def typed(self, _key: str) -> bool:
        """Take a typed key; False leaves it to the window."""
        return False

    def touched(self, key: str) -> None:
        """A finger on a drawn key: Esc is the window's, any other is typed here."""
        if key == "Esc":
            self.host.press(key)
        else:
            self.typed(key)

    def takes(self, _key: str) -> bool:
        """Whether a character is text here."""
        return False

    def has_field(self) -> bool:
        """Whether an entry of the page has the keyboard."""
        return False

    def ahead(self) -> bool:
        """Make one slice more of its charts, some milliseconds, before it is shown; False: nothing left."""
        return False

    def lively(self) -> bool:
        """Whether something on it moves by itself: played, or measured."""
        return False

    def asks(self) -> str:
        """A question of the page's own, which nothing hides; empty without one."""
        return ""

    def prompt(self) -> str:
        """Empty: the desk's standing prompt."""
        return ""

    def opens(self) -> bool:
        """Whether it may come up now."""
        return True

    def opened(self) -> None:
        """It is in front now."""

    def leave(self) -> bool:
        """Whether another page may take its place; where not, it says why on the prompt line."""
        return True

    def esc_holds(self) -> bool:
        """Return whether Esc holds the feed while something moves; an entry takes Esc for itself."""
        return not self.has_field()

    def escape(self) -> bool:
        """Whether Esc has closed something here."""
        return False

    def refresh(self, snapshot: Snapshot, view: MachineStatus, loaded: Loaded) -> None:
        """Show snapshot, status and loaded program of this instant; called once a frame."""

    def dress(self) -> None:
        """Other colours are in force."""


class PageModel(Protocol):
    """What such a page asks of its model; ``escape`` is False where nothing was taken back by it."""

    def typed(self, key: str) -> bool: ...

    def takes(self, key: str) -> bool: ...

    def opened(self) -> None: ...

    def escape(self) -> bool: ...


class ModelPage(Page):
    """The model decides, this only shows it and hands the keys on."""

    model: PageModel

    def typed(self, key: str) -> bool:
        """To the entry, the list or whatever is open."""
        return self.model.typed(key)

    def takes(self, key: str) -> bool:
        """Whether a character is text of what is open."""
        return self.model.takes(key)

    def opened(self) -> None:
        """The page comes up."""
        self.model.opened()

    def escape(self) -> bool:
        """One step back."""
        return self.model.escape()


class HeadKey(NamedTuple):
    """A place over the text that opens the panel: its text, and the name of the key that does the same."""

    label: str
    name: str


class EditorPanel(QWidget):
    """Nothing; a feature registers its subclass as ``Extra.editor_panel``.

    ``KEYS`` are the names of the keys that open it, from ``app.screen.window.keys``.
    """

    KEYS: Sequence[str] = ()
    model: PanelModel

    def __init__(self, host: Host, page: Page) -> None:  # noqa: ARG002
        super().__init__(page)
        self.model = PanelModel()
        self.hide()

    def head_keys(self, name: str) -> Sequence[HeadKey]:  # noqa: ARG002
        """Return the places over the text of a program of this name, from the right to the left."""
        return ()

    def open_at(self, key: str, name: str, text: str, line: int) -> str:  # noqa: ARG002
        """Open the panel for this text; the cursor stands on ``line``, from 1. Return why not, else nothing.

        ``key`` is the name of the key that was pressed; empty: a program is to be made of a file.
        """
        return ""

    def refresh(self) -> None:
        """Show what the model says now; called once a frame."""
