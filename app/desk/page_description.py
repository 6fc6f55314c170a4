"""Description of a page of the main window by class names, without importing the classes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from core.language.source import ProgramSource

LATHES, MILLS = frozenset({"omniturn", "sinumerik"}), frozenset({"klartext"})
ALL_LANGUAGES = LATHES | MILLS


@dataclass(frozen=True, slots=True)
class PageDescription:
    """Description of one page of the main window.

    - ``view_class`` and ``model_class`` are dotted class names, imported when the page first opens.
      The model must be attached to TurnDesk. A view without a model gets its data from ``Desk``.
    - A page without a key is not in the main menu.
    - ``deferred_modules`` are dotted names of modules that are imported after the page has opened.
    """

    name: str
    view_class: str
    model_class: str = ""
    key: str = ""
    menu_label: str = ""
    use: str = ""
    program_languages: frozenset[str] = (
        ALL_LANGUAGES  # Programming languages of the machines that have this page.
    )
    deferred_modules: tuple[str, ...] = ()
    preceding_page: str = ""  # Page of an optional feature: the page that precedes it in the main menu.
    shortcut_key: str = (
        ""  # Key that opens this page from any page, by its name in app.screen.window.key_table.
    )


@dataclass(frozen=True, slots=True)
class ProgramKey:
    """Function key of the program list that opens ``page_name``.

    ``use`` is called with the name of the selected program.
    """

    label: str
    page_name: str
    use: Callable[[str], None]


@dataclass(frozen=True, slots=True)
class ProgramConversion:
    """Conversion of programs of other controls, which an optional feature adds.

    - ``page_name`` is the page that shows the conversion.
    - ``recognize_control`` returns the name of the control for which lines were written, or an empty string
      for a program of this machine. Workers call it.
    - ``convert_text`` is called with an edited program and its path after the page has opened.
    """

    page_name: str
    recognize_control: Callable[[Sequence[str]], str]
    convert_text: Callable[[ProgramSource, Path], None]
