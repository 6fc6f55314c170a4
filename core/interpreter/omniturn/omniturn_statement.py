"""Statements: the words of a line, sorted by function and checked for conflicts."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.interpreter.omniturn.codes.code_entry import ActionKind, CodeEntry, FMeaning, SMeaning
from core.interpreter.omniturn.codes.code_table import FLOW_CODES, G_CODES, M_CODES, PLAIN_LINE_ENTRY
from core.language.diagnostics import ProgramError, make_program_error
from core.language.omniturn import LexedLine, Word, other_controls
from core.language.omniturn.plane_switching_lines import PlaneSwitchingLine
from core.message import Message, fill_template

PlainMove = tuple[float | None, float | None, float | None, int, bool]
"""Line of G00 or G01 with at most X, Z and F, as most lines of a long program.

It contains X, Z and F as written, then 0 or 1 for the code (-1 if absent), and whether any number has a
fifth decimal.
"""

_ARC, _LOCK, _MODE = ActionKind.ARC, ActionKind.SPINDLE_LOCK, ActionKind.MODE  # Read for every line.
_FEED, _LIMIT = FMeaning.FEED, SMeaning.SPEED_LIMIT
_C_WORDS = frozenset({"C", "CA", "CI"})
UNREADABLE_FLOW = "unreadable"
PLANE_FLOW = "plane"


@dataclass(slots=True)
class Statement:
    """A program line that is ready for execution.

    ``words`` contains the words by letter, except G and M. ``block_texts`` contains the texts of the blocks
    that the line generates.
    """

    line: int
    text: str
    words: dict[str, Word] = field(default_factory=dict)
    modal_codes: tuple[int, ...] = ()
    one_shot_code: int | None = None
    m_number: int | None = None
    code_entry: CodeEntry = PLAIN_LINE_ENTRY  # table entry of the one-shot code
    code_word: Word | None = None  # the one-shot word
    m_word: Word | None = None
    m_code_entry: CodeEntry | None = None  # table entry of its M code, if it is built into the control
    flow_code: str = ""  # a key of FLOW_CODES, UNREADABLE, or PLANE
    comment: str | None = None
    has_block_delete: bool = False
    block_texts: dict[str, str] | None = None
    is_simple_move: bool = False  # only a move, its feed and G00…G03
    plane_switching_line: PlaneSwitchingLine | None = None  # a line of plane switching
    is_f_feed_rate: bool = True  # no code on the line changes the meaning of F
    is_s_speed_limit: bool = False  # S belongs to G76 or G77
    has_x_or_z_move: bool = False  # the line moves X or Z
    has_c_word: bool = False  # the line has a C word, which moves a locked spindle
    locks_spindle: bool = False  # the line locks the spindle as the C axis
    calls_subroutine: bool = False  # the line calls a subroutine, conditionally or not
    depends_on_input: bool = False  # the call depends on an input

    @property
    def ends_program(self) -> bool:
        """Return whether the line has M30 or M02."""
        return self.m_code_entry is not None and self.m_code_entry.ends_program

    @property
    def is_contour_cycle(self) -> bool:
        """Return whether the line is a cycle whose contour is described by other lines."""
        return self.code_entry.action_kind is ActionKind.CONTOUR

    @property
    def is_executable(self) -> bool:
        """Return whether the line contains more than a comment."""
        return bool(self.words or self.modal_codes or self.code_word or self.m_word or self.flow_code)

    def get_value(self, letter: str) -> float | None:
        """Return the number of a word, or None if the line lacks the word."""
        word = self.words.get(letter)
        return None if word is None else word.value

    def get_column(self, letter: str) -> int:
        """Return the column of a word, or 0 if the line lacks the word."""
        word = self.words.get(letter)
        return 0 if word is None else word.column

    def make_error(
        self, at: Word | str | int, code: str, text: str, hint: str = "", /, **values: object
    ) -> ProgramError:
        """Return an error of this line, located at a word, at the word of a letter, or at a column.

        The letter M selects the M code. If the line lacks the word, the error is at the line's one-shot
        code. ``values`` are the values for the placeholders of ``text`` and ``hint``.
        """
        if isinstance(at, str):
            at = (self.m_word if at == "M" else self.words.get(at)) or self.code_word or 0
        column = at if isinstance(at, int) else at.column
        return make_program_error(
            self.line, column, code, fill_template(text, values), fill_template(hint, values)
        )

    def check_condition(
        self,
        condition: object,
        location: Word | str | int,
        code: str,
        text: str,
        hint: str = "",
        /,
        **values: object,
    ) -> None:
        """Raise the ProgramError that ``make_error`` returns, unless ``condition`` is true."""
        if not condition:
            raise self.make_error(location, code, text, hint, **values)

    @property
    def code_column(self) -> int:
        """Return the column of the one-shot code, or 0 if the line lacks a one-shot code."""
        return 0 if self.code_word is None else self.code_word.column

    def get_block_text(self, name: str) -> str:
        """Return the text of one block of the line.

        If the line has only one block, the text of the whole line is returned.
        """
        return self.text if self.block_texts is None else self.block_texts.get(name, self.text)


ExecutableLine = PlainMove | Statement | None
"""Line to execute: a plain move, another statement, or None for a line without content."""

# --- reading: sort the words of a line and reject conflicts


_SIMPLE = frozenset({"X", "Z", "I", "K", "R", "F"})
_SIMPLE_MODAL = frozenset({0, 1})
_MOTIONS = frozenset({ActionKind.MOTION, ActionKind.CYCLE, ActionKind.CONTOUR})


def make_statement(line: LexedLine) -> Statement:
    """Return the statement of a line.

    Raises ProgramError if the line has an unknown G code, words that exclude each other, or a word that
    none of its codes uses, or if a required word is missing.
    """
    if line.errors:
        return make_unreadable_statement(line)
    statement = Statement(
        line.line_number, line.text, comment=line.comment, has_block_delete=line.has_block_delete
    )
    if line.comment is not None and line.comment.lstrip().startswith("~"):
        what = f"({line.comment.strip()})"
        message = Message(
            "{what} looks like a plane command; write the plane commands (~PLXC) and (~PLZC) "
            "alone on a line.",
            what=what,
        )
        raise make_program_error(
            line.line_number,
            line.comment_column,
            "plane-entry",
            message,
            "Write (~PLXC) or (~PLZC) alone on a line.",
        )
    _sort(statement, line)
    words = statement.words
    statement.has_x_or_z_move = statement.code_entry.action_kind is _ARC or (
        statement.one_shot_code is None and ("X" in words or "Z" in words)
    )
    if line.comment is None and not statement.m_word and _SIMPLE.issuperset(statement.words):
        statement.is_simple_move = statement.has_x_or_z_move and _SIMPLE_MODAL.issuperset(
            statement.modal_codes
        )
    if not statement.is_simple_move:
        _set_other_functions(statement)
        _name_parts(statement, line)
    _check_words(statement, line)
    return statement


def make_unreadable_statement(line: LexedLine) -> Statement:
    """Return a statement for a line with errors.

    The statement retains X and Z of a move, so that later lines are checked from the correct position.
    """
    words: dict[str, Word] = {}
    if not any(word.letter == "G" and word.value in {4, 10, 92} for word in line.words):
        words = {word.letter: word for word in line.words if word.letter in {"X", "Z"}}
    statement = Statement(
        line.line_number, line.text, words, flow_code=UNREADABLE_FLOW, has_block_delete=line.has_block_delete
    )
    statement.has_x_or_z_move = bool(words)
    statement.modal_codes = tuple(
        code for code in (90, 91) if any(word[:2] == ("G", code) for word in line.words)
    )
    return statement


def _sort(statement: Statement, line: LexedLine) -> None:
    modal: list[Word] = []
    words = statement.words
    for word in line.words:
        letter = word.letter
        if letter == "G":
            _sort_g(statement, word, modal)
        elif letter == "M":
            if statement.m_word is not None:
                text = "This line contains two M codes."
                raise _refused(line, word, "two-m-codes", text, "Split the line.")
            statement.m_number, statement.m_word = int(word.value or 0), word
            statement.m_code_entry = M_CODES.get(statement.m_number)
        elif letter in words:
            text = "This line contains {letter} twice."
            raise _refused(line, word, "word-twice", text, "Remove one of the two.", letter=letter)
        else:
            words[letter] = word
    if modal:
        statement.modal_codes = tuple(int(word.value or 0) for word in modal)
        _check_groups(statement, line, modal)


def _check_groups(statement: Statement, line: LexedLine, modal: list[Word]) -> None:
    groups: dict[str, int] = {}
    for word, code in zip(modal, statement.modal_codes, strict=True):
        if groups.setdefault(G_CODES[code].mode_group, code) != code:
            text = "This line contains two codes of the same group ({group})."
            hint = "Keep only one of the conflicting words."
            raise _refused(line, word, "modal-conflict", text, hint, group=G_CODES[code].mode_group)


def _sort_g(statement: Statement, word: Word, modal: list[Word]) -> None:
    code = int(word.value or 0)
    entry = G_CODES.get(code)
    if entry is None:
        habit, hint = other_controls.explain_foreign_word(word.text.upper()) or (
            "",
            other_controls.CODE_LIST_HINT,
        )
        message = Message(
            "{word} is not a valid code on this control. {habit}", word=word.text, habit=habit
        ).rstrip()
        raise statement.make_error(word, "g-unknown", message, hint)
    if entry.action_kind is _MODE:
        modal.append(word)
    elif statement.code_word is not None:
        message = Message(
            "{code} and {word} cannot be on the same line.", code=statement.code_word.text, word=word.text
        )
        raise statement.make_error(word, "two-one-shots", message, "Split the line.")
    else:
        statement.one_shot_code, statement.code_word, statement.code_entry = code, word, entry
    if entry.f_meaning is not _FEED:
        statement.is_f_feed_rate = False
    if entry.s_meaning is _LIMIT:
        statement.is_s_speed_limit = True


def _set_other_functions(statement: Statement) -> None:
    """Set the functions of a line that are not moves of X and Z."""
    statement.flow_code, m_code = _flow(statement), statement.m_code_entry
    statement.has_c_word = (
        statement.one_shot_code is None
        and not statement.flow_code
        and not _C_WORDS.isdisjoint(statement.words)
    )
    statement.locks_spindle = statement.code_entry.action_kind is _LOCK or (
        m_code is not None and m_code.action_kind is _LOCK
    )
    if statement.flow_code:
        statement.calls_subroutine, statement.depends_on_input = (
            FLOW_CODES[statement.flow_code].calls_subroutine,
            FLOW_CODES[statement.flow_code].depends_on_input,
        )


def _flow(statement: Statement) -> str:
    for letter in ("LS", "LF", "}", "RF"):
        if letter in statement.words:
            return letter
    if statement.m_number is not None and f"M{statement.m_number}" in FLOW_CODES:
        return f"M{statement.m_number}"
    return "P" if "P" in statement.words and statement.code_word is None else ""


def _check_words(statement: Statement, line: LexedLine) -> None:
    if statement.flow_code:
        _check_flow(statement, line)
        return
    allowed = statement.code_entry.allowed_words
    if allowed.issuperset(statement.words):
        return
    for letter, word in statement.words.items():
        if letter not in allowed:
            habit = other_controls.explain_foreign_word(letter)
            if habit is not None:
                message = Message(
                    "{word} has no meaning on this line. {habit}", word=word.text, habit=habit[0]
                )
                raise statement.make_error(word, "word-unused", message, habit[1])
            text = "This line contains {word}, which no code on the line uses."
            hint = "Remove the word, or add the code that uses it."
            raise _refused(line, word, "word-unused", text, hint, word=word.text)


def _check_flow(statement: Statement, line: LexedLine) -> None:
    allowed = FLOW_CODES[statement.flow_code].allowed_words
    for word in line.words:
        if word.letter not in allowed:
            text = "This line contains {word}, but {flow} must be alone on a line."
            hint = "Put each command on a separate line."
            raise _refused(line, word, "not-alone", text, hint, word=word.text, flow=statement.flow_code)
    if line.has_block_delete and not FLOW_CODES[statement.flow_code].allows_block_delete:
        text = (
            "This line has '/' before {flow}, which cannot be skipped because the rest of the program needs "
            "it."
        )
        raise _refused(
            line, line.words[0], "block-delete-flow", text, "Remove '/'.", flow=statement.flow_code
        )
    for letter in sorted(allowed - {"M", "LF", "RF"}):
        if statement.get_value(letter) is None:
            text = "This line contains {flow} without {letter}."
            hint = "Add {letter} with its number."
            raise _refused(
                line, line.words[0], "word-missing", text, hint, flow=statement.flow_code, letter=letter
            )
    for letter, rule in FLOW_CODES[statement.flow_code].word_rules.items():
        word = statement.words[letter]
        refusal = rule.find_error(word.value or 0.0)
        if refusal is not None:
            raise statement.make_error(
                word, refusal.diagnostic_code, Message(refusal.text, word=word.text), refusal.hint
            )


def _name_parts(statement: Statement, line: LexedLine) -> None:
    """Assign to each block of the line the text of the block's words.

    If the line has only one block, nothing is assigned, and the block has the text of the whole line.
    """
    groups: dict[str, str] = {}
    for word in line.words:
        name = _group(statement, word)
        groups[name] = groups.get(name, "") + word.text
    own: list[str] = [name for name in ("tool", "frame", "spindle", "m") if name in groups]
    if statement.has_x_or_z_move or statement.has_c_word or statement.code_entry.action_kind in _MOTIONS:
        own.append("move")
    if len(own) > 1:
        if "move" not in own and "move" in groups:
            groups[own[0]] = groups.pop("move") + groups[own[0]]
        statement.block_texts = groups


def _group(statement: Statement, word: Word) -> str:
    letter = word.letter
    if letter == "T" or (letter == "D" and "T" in statement.words):
        return "tool"
    if statement.code_entry.action_kind is ActionKind.FRAME and (
        letter in {"X", "Z"} or word is statement.code_word
    ):
        return "frame"
    if letter == "M":
        m_code = statement.m_code_entry
        return "spindle" if m_code is not None and m_code.action_kind is ActionKind.SPINDLE else "m"
    if letter == "S" and not statement.is_s_speed_limit and not statement.has_c_word:
        return "m" if statement.locks_spindle else "spindle"
    return "move"


def _refused(
    line: LexedLine, word: Word, code: str, text: str, hint: str, /, **values: object
) -> ProgramError:
    return make_program_error(
        line.line_number, word.column, code, fill_template(text, values), fill_template(hint, values)
    )
