"""SINUMERIK statement: the words of one block, sorted by function.

The words are checked for conflicts.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.sinumerik import sinumerik_words as known
from core.language.sinumerik import word_table as table
from core.language.sinumerik.iso_words import find_iso_word
from core.language.sinumerik.sinumerik_alarms import (
    GROUP_CONFLICT,
    UNKNOWN_G_FUNCTION,
    WORD_REPEATED,
    make_alarm_diagnostic,
)
from core.language.sinumerik.sinumerik_words import LexedBlock, Word
from core.language.sinumerik.word_values import is_variable
from core.message import Message, fill_template

_DWELL_WORDS = frozenset({"F", "S"})
_ENDS = frozenset({2, 17, 30})


@dataclass(slots=True)
class Statement:
    """One block with its words sorted by function.

    - ``g_words`` contains the G functions by group, and ``m_words`` contains the M functions by number.
    - ``words`` contains the other words by name.
    - ``assignments`` contains the assignments to R parameters and variables.
    - ``named_functions`` contains the functions without a G number by name.
    """

    lexed_block: LexedBlock
    g_words: dict[str, Word] = field(default_factory=dict)
    m_words: dict[int, Word] = field(default_factory=dict)
    words: dict[str, Word] = field(default_factory=dict)
    assignments: list[Word] = field(default_factory=list)
    named_functions: dict[str, Word] = field(default_factory=dict)
    live_tool_words: list[Word] = field(default_factory=list)  # words of spindle 2, the live tool

    def get_g_code(self, group: str) -> int | None:
        """Return the number of the G code of this group, or None if the block has no G code of the group.

        Also returns None for a function of the group that has a name instead of a number.
        """
        word = self.g_words.get(group)
        return None if word is None or word.value is None else int(word.value)

    def get_named_function(self, group: str) -> str:
        """Return the named function of this group, or an empty string if the block does not contain one."""
        word = self.g_words.get(group)
        return "" if word is None or word.value is not None else word.name

    @property
    def axis_names(self) -> list[str]:
        """Return the names of the axes that have a word in the block."""
        return [name for name in known.AXIS_NAMES if name in self.words]

    @property
    def frame_word(self) -> Word | None:
        """Return the frame word of the block, such as TRANS or ATRANS, or None if it lacks a frame word."""
        return next((word for name, word in self.named_functions.items() if name in known.FRAME_WORDS), None)

    @property
    def has_position_word(self) -> bool:
        """Return whether the block contains a position word."""
        return bool(known.POSITION_WORDS & self.words.keys())

    @property
    def corner_word(self) -> Word | None:
        """Return the word CHF, CHR or RND of the block, or None if the block lacks these words."""
        return next((self.words[name] for name in sorted(known.CORNER_WORDS) if name in self.words), None)

    @property
    def ends_program(self) -> bool:
        """Return whether the block contains M2, M17 or M30."""
        return bool(_ENDS & self.m_words.keys())

    def make_error(
        self, word: Word | None, code: int | str, text: str, hint: str, /, **values: object
    ) -> ProgramError:
        """Return an error at this word.

        ``code`` is an alarm number of the control or a TurnDesk code. ``values`` are the values for the
        placeholders of ``text`` and ``hint``.
        """
        text, hint = fill_template(text, values), fill_template(hint, values)
        line, column = self.lexed_block, word.column if word else 1
        axis = _axis_name(word) if word and word.name in known.AXIS_NAMES else ""
        return ProgramError(
            make_alarm_diagnostic(line.line_number, column, code, line.block_name, text, hint, axis=axis)
        )

    def require_condition(
        self, condition: object, word: Word | None, code: int | str, text: str, hint: str, /, **values: object
    ) -> None:
        """Raise the ProgramError that ``make_error`` returns, unless ``condition`` is true."""
        if not condition:
            raise self.make_error(word, code, text, hint, **values)

    def make_warning(self, word: Word | None, code: str, text: str, hint: str) -> Diagnostic:
        """Return a warning with the location and texts of the error that ``make_error`` would return."""
        return replace(self.make_error(word, code, text, hint).diagnostic, severity=Severity.WARNING)


def _axis_name(word: Word) -> str:
    """Return the axis of a word as written, such as Q1 for Q1=30."""
    return word.text.partition("=")[0] if "=" in word.text else word.text[:1]


def make_statement(line: LexedBlock) -> Statement:
    """Return the statement of a block.

    Raises ProgramError if its words exclude each other or are repeated, and for a function that this
    control does not have.
    """
    statement = Statement(line)
    for word in line.words:
        _sort(statement, word)
    if statement.m_words or statement.named_functions:
        _check_m(statement)
    if statement.named_functions or table.DWELL_GROUP in statement.g_words:
        _check_separate_block(statement)
    _check_corner(statement)
    return statement


def _sort(statement: Statement, word: Word) -> None:
    if word.spindle_number == 2 and (
        word.name in {"S", "SETMS"} or (word.name == "M" and word.value in {3, 4, 5})
    ):
        statement.live_tool_words.append(word)
        return
    if word.spindle_number > 1:
        text = Message(
            "{word}: this machine can position only one spindle; spindle 2 is its live tool.", word=word.text
        )
        raise statement.make_error(
            word, "one-spindle", text, "Program this function for spindle 1, or remove it."
        )
    if word.name == "G":
        _sort_g(statement, word, known.G_GROUPS.get(int(word.value or 0)))
    elif word.name == "M":
        if word.value is None:
            text = Message("{word}: the M function must be a number.", word=word.text)
            raise statement.make_error(word, "m-unknown", text, "Write M with a number.")
        statement.m_words[int(word.value)] = word
    elif word.name in known.NAMED_FUNCTIONS:
        statement.named_functions[word.name] = word
        _sort_g(statement, word, known.NAMED_GROUPS[word.name])
    elif is_variable(word.name):
        statement.assignments.append(word)
    elif word.name in statement.words:
        raise statement.make_error(
            word,
            WORD_REPEATED,
            Message("{word} is programmed twice in the block.", word=word.name),
            "Keep only one of the conflicting words.",
        )
    else:
        statement.words[word.name] = word


def _sort_g(statement: Statement, word: Word, group: str | None) -> None:
    if group is None:
        why = known.UNSUPPORTED_REASONS.get(f"G{int(word.value or 0)}")
        if why is not None:
            raise statement.make_error(
                word,
                "not-in-subset",
                Message("{word}: {problem}.", word=word.text, problem=why),
                "Remove this text from the program.",
            )
        if habit := find_iso_word(statement.lexed_block.text.upper()):
            raise statement.make_error(word, "other-control", habit.explanation, habit.remedy)
        raise statement.make_error(
            word,
            UNKNOWN_G_FUNCTION,
            Message("{word} is not a G function of this control.", word=word.text),
            "Remove this text from the program.",
        )
    before = statement.g_words.get(group)
    if before is not None:
        text = Message(
            "{before} and {word} belong to the same group ({group}) and cannot be in the same block.",
            before=before.text,
            word=word.text,
            group=group,
        )
        raise statement.make_error(
            word, GROUP_CONFLICT, text, "Use only one G code from each group in a block."
        )
    statement.g_words[group] = word


def _check_m(statement: Statement) -> None:
    if len(statement.m_words) > known.MAX_M_FUNCTION_COUNT:
        text = Message("the block contains {m_count} M codes.", m_count=len(statement.m_words))
        raise statement.make_error(
            list(statement.m_words.values())[-1],
            "m-too-many",
            text,
            Message("The maximum is {most_m} M codes in a block.", most_m=known.MAX_M_FUNCTION_COUNT),
        )
    for group in ({3, 4, 5, 19, 70}, {0, 1, 2, 17, 30}, {7, 9}, {8, 9}, {40, 41, 42, 43, 44, 45}):
        found = sorted(group & statement.m_words.keys())
        if len(found) > 1:
            text = Message(
                "M{value} and M{value2} cannot be in the same block.", value=found[0], value2=found[1]
            )
            raise statement.make_error(
                statement.m_words[found[1]], "m-conflict", text, "Keep only one of the conflicting words."
            )


def _check_separate_block(statement: Statement) -> None:
    """Raise ProgramError if G4, TRANS or another frame word shares its block with other words."""
    dwell, key = statement.g_words.get(table.DWELL_GROUP), statement.frame_word
    if dwell is not None:
        others = (
            statement.words.keys() - _DWELL_WORDS
            or statement.m_words
            or statement.assignments
            or len(statement.g_words) > 1
        )
        if habit := find_iso_word(statement.lexed_block.text.upper()):
            raise statement.make_error(dwell, "other-control", habit.explanation, habit.remedy)
        if others or len(statement.words) != 1:
            text = "G4 must be in a separate block with F (seconds) or S (revolutions)."
            raise statement.make_error(dwell, "own-block", text, "Split the block into two or more blocks.")
    if key is not None:
        others = (
            statement.words.keys() - {*known.AXIS_NAMES, "RPL"}
            or statement.m_words
            or statement.assignments
            or len(statement.g_words) > 1
        )
        if others:
            text = Message("{key} must be in a separate block that contains only axes.", key=key.name)
            raise statement.make_error(key, "own-block", text, "Split the block into two or more blocks.")


def _check_corner(statement: Statement) -> None:
    if known.CORNER_WORDS.isdisjoint(statement.words):
        return
    corners = sorted(known.CORNER_WORDS & statement.words.keys())
    if len(corners) > 1:
        text = Message(
            "{corners} and {corners2} cannot be in the same block.", corners=corners[0], corners2=corners[1]
        )
        raise statement.make_error(
            statement.words[corners[1]], "corner-both", text, "Keep only one of the conflicting words."
        )
    if corners and not (known.POSITION_WORDS - {"C"}) & statement.words.keys():
        text = Message("{corners} is in a block without X or Z.", corners=corners[0])
        raise statement.make_error(
            statement.words[corners[0]],
            "corner-without-move",
            text,
            "Put this word in a block that contains a move.",
        )
