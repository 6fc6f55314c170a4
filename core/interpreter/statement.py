"""One line ready to run: its words sorted by what they do."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.interpreter import codes
from core.language.omniturn import Word
from core.language.omniturn.plane import PlaneLine

PlainMove = tuple[float | None, float | None]
"""X and Z as written of a line that holds nothing else: most lines of a long program."""

CodedMove = tuple[float | None, float | None, bool, int, float | None]
"""X, Z, whether one of them has a fifth decimal, 0 or 1 for G00 or G01 (-1: none), F; all as written."""

_C_WORDS = frozenset({"C", "CA", "CI"})
UNREADABLE = "unreadable"
PLANE = "plane"


@dataclass(slots=True)
class Statement:
    """A line ready to run. ``words`` by letter (G and M apart); ``parts`` the texts of its blocks."""

    line: int
    text: str
    words: dict[str, Word] = field(default_factory=dict)
    modal: tuple[int, ...] = ()
    one_shot: int | None = None
    m: int | None = None
    code: Word | None = None  # the one-shot word
    m_word: Word | None = None
    flow: str = ""  # a key of FLOW_WORDS, UNREADABLE, or PLANE
    comment: str | None = None
    block_delete: bool = False
    parts: dict[str, str] | None = None
    simple: bool = False  # nothing but a move, its feed and G00…G03
    plane: PlaneLine | None = None  # a line of plane switching

    @property
    def moves(self) -> bool:
        """Whether the line asks the slides to move."""
        return self.one_shot in codes.ARCS or (
            self.one_shot is None and ("X" in self.words or "Z" in self.words)
        )

    @property
    def turns(self) -> bool:
        """Whether the line holds C, which turns the spindle where that is locked."""
        return self.one_shot is None and not self.flow and not _C_WORDS.isdisjoint(self.words)

    @property
    def locks(self) -> bool:
        """Whether the line makes the spindle the axis C."""
        return self.one_shot == 89 or self.m in codes.M_POSITIONING

    @property
    def executable(self) -> bool:
        """Whether there is anything on the line besides a comment."""
        return bool(self.words or self.modal or self.code or self.m_word or self.flow)

    def value(self, letter: str) -> float | None:
        """Number of a word, None where the line does not hold it."""
        word = self.words.get(letter)
        return None if word is None else word.value

    def column(self, letter: str) -> int:
        """Column of a word, 0 where the line does not hold it."""
        word = self.words.get(letter)
        return 0 if word is None else word.column

    def part(self, name: str) -> str:
        """Text of one of the blocks that the line makes."""
        return self.text if self.parts is None else self.parts.get(name, self.text)


Step = PlainMove | CodedMove | Statement | None
"""A line to run: a move of plain numbers, anything else, or nothing at all."""
