"""Statements: the words of a block, sorted by function and checked for conflicts."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.sinumerik import sinumerik_words as known
from core.language.sinumerik import word_table as table
from core.language.sinumerik.iso_words import iso_habit
from core.language.sinumerik.sinumerik_alarms import ONE_GROUP, TWICE, UNKNOWN_G, fault
from core.language.sinumerik.sinumerik_words import Line, Word
from core.language.sinumerik.word_values import variable
from core.message import Message, worded

_DWELL_WORDS = frozenset({"F", "S"})
_ENDS = frozenset({2, 17, 30})


@dataclass(slots=True)
class Statement:
    """One block. ``g`` are its G functions by group, ``words`` other words by name, ``sets`` the assignments.

    ``keys`` are the functions with a name, by their name.
    """

    line: Line
    g: dict[str, Word] = field(default_factory=dict)
    m: dict[int, Word] = field(default_factory=dict)
    words: dict[str, Word] = field(default_factory=dict)
    sets: list[Word] = field(default_factory=list)
    keys: dict[str, Word] = field(default_factory=dict)
    live: list[Word] = field(default_factory=list)  # words of spindle 2, the live tool

    def code(self, group: str) -> int | None:
        """Return the G code of this group, or None if the block has none or has a named function."""
        word = self.g.get(group)
        return None if word is None or word.value is None else int(word.value)

    def key(self, group: str) -> str:
        """Return the named function of this group; empty without one."""
        word = self.g.get(group)
        return "" if word is None or word.value is not None else word.name

    @property
    def axes(self) -> list[str]:
        """Names of the axes with a word in the block."""
        return [name for name in known.AXES if name in self.words]

    @property
    def frame_key(self) -> Word | None:
        """The word TRANS, ROT, SCALE or MIRROR of the block, or its A form; None without one."""
        return next((word for name, word in self.keys.items() if name in known.FRAMES), None)

    @property
    def moves(self) -> bool:
        """Whether the block has a position word."""
        return bool(known.PLACES & self.words.keys())

    @property
    def corner(self) -> Word | None:
        """The word CHF, CHR or RND of the block, or None."""
        return next((self.words[name] for name in sorted(known.CORNERS) if name in self.words), None)

    @property
    def ends(self) -> bool:
        """Whether the block has M2, M17 or M30."""
        return bool(_ENDS & self.m.keys())

    def refuse(
        self, word: Word | None, code: int | str, text: str, hint: str, /, **values: object
    ) -> ProgramError:
        """Return the error to raise at this word, with an alarm number of the control or a TurnDesk code.

        ``values`` are the values for the placeholders of ``text`` and ``hint``.
        """
        text, hint = worded(text, values), worded(hint, values)
        line, column = self.line, word.column if word else 1
        axis = _axis(word) if word and word.name in known.AXES else ""
        return ProgramError(fault(line.number, column, code, line.block, text, hint, axis=axis))

    def check(
        self, ok: object, word: Word | None, code: int | str, text: str, hint: str, /, **values: object
    ) -> None:
        """Raise the error of ``refuse`` unless the condition ``ok`` is true."""
        if not ok:
            raise self.refuse(word, code, text, hint, **values)

    def warning(self, word: Word | None, code: str, text: str, hint: str) -> Diagnostic:
        """Return the diagnostic of ``refuse`` as a warning."""
        return replace(self.refuse(word, code, text, hint).diagnostic, severity=Severity.WARNING)


def _axis(word: Word) -> str:
    """Return the axis of a word as written, such as Q1 for Q1=30."""
    return word.text.partition("=")[0] if "=" in word.text else word.text[:1]


def statement_of(line: Line) -> Statement:
    """Return the statement of a block. Raises ProgramError if its words exclude each other."""
    statement = Statement(line)
    for word in line.words:
        _sort(statement, word)
    if statement.m or statement.keys:
        _check_m(statement)
    if statement.keys or table.DWELL in statement.g:
        _check_alone(statement)
    _check_corner(statement)
    return statement


def _sort(statement: Statement, word: Word) -> None:
    if word.spindle == 2 and (word.name in {"S", "SETMS"} or (word.name == "M" and word.value in {3, 4, 5})):
        statement.live.append(word)
        return
    if word.spindle > 1:
        text = Message(
            "{word}: this machine can position only one spindle; spindle 2 is its live tool.", word=word.text
        )
        raise statement.refuse(
            word, "one-spindle", text, "Program this function for spindle 1, or remove it."
        )
    if word.name == "G":
        _sort_g(statement, word, known.G_GROUPS.get(int(word.value or 0)))
    elif word.name == "M":
        if word.value is None:
            text = Message("{word}: the M function must be a number.", word=word.text)
            raise statement.refuse(word, "m-unknown", text, "Write M with a number.")
        statement.m[int(word.value)] = word
    elif word.name in known.KEYS:
        statement.keys[word.name] = word
        _sort_g(statement, word, known.NAMED_GROUPS[word.name])
    elif variable(word.name):
        statement.sets.append(word)
    elif word.name in statement.words:
        raise statement.refuse(
            word,
            TWICE,
            Message("{word} is programmed twice in the block.", word=word.name),
            "Keep only one of the conflicting words.",
        )
    else:
        statement.words[word.name] = word


def _sort_g(statement: Statement, word: Word, group: str | None) -> None:
    if group is None:
        why = known.WHY_OUTSIDE.get(f"G{int(word.value or 0)}")
        if why is not None:
            raise statement.refuse(
                word,
                "not-in-subset",
                Message("{word}: {problem}.", word=word.text, problem=why),
                "Remove this text from the program.",
            )
        if habit := iso_habit(statement.line.text.upper()):
            raise statement.refuse(word, "other-control", habit.text, habit.hint)
        raise statement.refuse(
            word,
            UNKNOWN_G,
            Message("{word} is not a G function of this control.", word=word.text),
            "Remove this text from the program.",
        )
    before = statement.g.get(group)
    if before is not None:
        text = Message(
            "{before} and {word} belong to the same group ({group}) and cannot be in the same block.",
            before=before.text,
            word=word.text,
            group=group,
        )
        raise statement.refuse(word, ONE_GROUP, text, "Use only one G code from each group in a block.")
    statement.g[group] = word


def _check_m(statement: Statement) -> None:
    if len(statement.m) > known.MOST_M:
        text = Message("the block contains {m_count} M codes.", m_count=len(statement.m))
        raise statement.refuse(
            list(statement.m.values())[-1],
            "m-too-many",
            text,
            Message("The maximum is {most_m} M codes in a block.", most_m=known.MOST_M),
        )
    for group in ({3, 4, 5, 19, 70}, {0, 1, 2, 17, 30}, {7, 9}, {8, 9}, {40, 41, 42, 43, 44, 45}):
        found = sorted(group & statement.m.keys())
        if len(found) > 1:
            text = Message(
                "M{value} and M{value2} cannot be in the same block.", value=found[0], value2=found[1]
            )
            raise statement.refuse(
                statement.m[found[1]], "m-conflict", text, "Keep only one of the conflicting words."
            )


def _check_alone(statement: Statement) -> None:
    """Check that G4, TRANS and the other frame words are in a separate block."""
    dwell, key = statement.g.get(table.DWELL), statement.frame_key
    if dwell is not None:
        others = (
            statement.words.keys() - _DWELL_WORDS or statement.m or statement.sets or len(statement.g) > 1
        )
        if habit := iso_habit(statement.line.text.upper()):
            raise statement.refuse(dwell, "other-control", habit.text, habit.hint)
        if others or len(statement.words) != 1:
            text = "G4 must be in a separate block with F (seconds) or S (revolutions)."
            raise statement.refuse(dwell, "own-block", text, "Split the block into two or more blocks.")
    if key is not None:
        others = (
            statement.words.keys() - {*known.AXES, "RPL"}
            or statement.m
            or statement.sets
            or len(statement.g) > 1
        )
        if others:
            text = Message("{key} must be in a separate block that contains only axes.", key=key.name)
            raise statement.refuse(key, "own-block", text, "Split the block into two or more blocks.")


def _check_corner(statement: Statement) -> None:
    if known.CORNERS.isdisjoint(statement.words):
        return
    corners = sorted(known.CORNERS & statement.words.keys())
    if len(corners) > 1:
        text = Message(
            "{corners} and {corners2} cannot be in the same block.", corners=corners[0], corners2=corners[1]
        )
        raise statement.refuse(
            statement.words[corners[1]], "corner-both", text, "Keep only one of the conflicting words."
        )
    if corners and not (known.PLACES - {"C"}) & statement.words.keys():
        text = Message("{corners} is in a block without X or Z.", corners=corners[0])
        raise statement.refuse(
            statement.words[corners[0]],
            "corner-without-move",
            text,
            "Put this word in a block that contains a move.",
        )
