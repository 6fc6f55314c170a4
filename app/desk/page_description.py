"""The description of a page of the main window. It names classes, and imports none of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

LATHES, MILLS = frozenset({"omniturn", "sinumerik"}), frozenset({"klartext"})
ALL_LANGUAGES = LATHES | MILLS


@dataclass(frozen=True, slots=True)
class PageEntry:
    """One page. ``view`` and ``model`` are dotted names of classes: imported when the page is first opened.

    The model is the one that is attached to the desk; a view without one makes what it needs of the desk. A
    page without a key is not in the main menu. ``later`` are dotted names of what it imports once it is open.
    """

    name: str
    view: str
    model: str = ""
    key: str = ""
    label: str = ""
    use: str = ""
    languages: frozenset[str] = ALL_LANGUAGES  # of the machines that have it
    later: tuple[str, ...] = ()
    after: str = ""  # of a page of an optional feature: the page that it follows in the main menu
    shortcut: str = ""  # key that opens it from any page, as app.screen.window.keys calls it


@dataclass(frozen=True, slots=True)
class ProgramKey:
    """A function key of the list of programs: it opens ``page``, and ``use`` gets the name of the program."""

    label: str
    page: str
    use: Callable[[str], None]
