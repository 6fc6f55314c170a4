"""What a SINUMERIK line is made of: words with a number, an R parameter, or a target in brackets."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from core.language.diagnostics import Diagnostic

LONGEST_LINE = 512


class Form(StrEnum):
    """How a position is meant, for one word and one block; plain: as G90 or G91 says."""

    PLAIN = ""
    AC = "AC"
    IC = "IC"
    DC = "DC"
    ACP = "ACP"
    ACN = "ACN"


class Word(NamedTuple):
    """One word. ``name`` is upper case; ``value`` its number, or None where an R parameter ``r`` gives it.

    ``column`` is that of its first sign, from 1; ``text`` as written, without blanks.
    """

    name: str
    value: float | None
    column: int
    text: str
    form: Form = Form.PLAIN
    r: int | None = None


class Line(NamedTuple):
    """One block of source; ``number`` is its line, from 1.

    ``block`` is what alarms call it: its N or : number, its label, or its line. ``skip`` is the level of
    ``/`` (0 for a bare one), None without. ``call`` names a subprogram, run ``passes`` times. ``text`` is the
    code as written without number, label and comment. ``errors`` tells what could not be read; such a line
    must not run.
    """

    number: int
    block: str
    words: tuple[Word, ...] = ()
    label: str = ""
    skip: int | None = None
    call: str = ""
    call_column: int = 0
    passes: int = 1
    comment_column: int = 0
    text: str = ""
    errors: tuple[Diagnostic, ...] = ()

    @property
    def executable(self) -> bool:
        """Whether there is anything to do in it."""
        return bool(self.words or self.call or self.errors)
