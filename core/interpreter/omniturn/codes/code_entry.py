"""Types of the code table: entries, word rules, meanings of F and S, limits and conditions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, auto
from functools import partial
from math import inf
from typing import NamedTuple

from core.interpreter.shared import units
from core.message import CodedError

EXAMPLE_HEAD = "G90G94F300\nT1\nM03S1000\nX.6Z.1\nG95F.004\n"
"""Program start that precedes every example.

It selects radius mode, moves the tool to X.6 Z.1, and sets 1000 rpm and .004 in/rev.
"""

EXAMPLE_TAIL = "G94F300X.6Z1\nM30\n"


class ActionKind(Enum):
    """Kind of action of a code, which determines when the code is executed (see ``block_execution``)."""

    PLAIN_MOVE = auto()  # a line without a one-shot code: a straight move or no move
    WORD = auto()  # a letter
    MODE = auto()  # active until another code of the same group
    FRAME = auto()  # its X and Z are not a motion
    SPINDLE_LOCK = auto()  # the spindle becomes the C axis, before the motion
    SPINDLE = auto()  # starts the spindle; before the motion
    START = auto()  # an M function before the motion
    ARC = auto()
    MOTION = auto()  # a special motion or a dwell
    CYCLE = auto()  # a line that generates many motions
    CONTOUR = auto()  # a cycle along the lines that follow it, or along a subroutine
    STOP = auto()  # an M function after the motion
    FLOW = auto()  # controls the order of execution


class FMeaning(Enum):
    """Meaning of the F word on a line with a code, such as a feed or a time."""

    NONE = auto()  # F is not allowed
    FEED = auto()  # the feed from this line on
    SECONDS = auto()
    LEAD_RANGE = auto()  # the permitted range of leads


class SMeaning(Enum):
    """Meaning of the S word on a line with a code."""

    SPEED = auto()  # the spindle speed from this line on
    SPEED_LIMIT = auto()  # a limit of constant surface speed, rpm
    C_SPEED = auto()  # the speed of the C axis, rpm


class WordLimit(Enum):
    """Upper limit of a word, from the machine file or the modal state.

    The value of a member is its text on the reference page.
    """

    FEED = "the machine's maximum feed"
    ACTIVE_FEED = (
        "the maximum feed: with G94, the machine's limit; with G95, .2 in/rev (1 in/rev "
        "after G35, 2 in/rev after G35F2)"
    )
    LEAD = ".2 in/rev (1 in/rev after G35, 2 in/rev after G35F2)"
    RPM = "the maximum spindle speed"
    C_RPM = "the maximum speed of the C axis"
    SURFACE_SPEED = "6000 m/min"  # ten times the limit of any tool


MAX_FEEDS_PER_REV = tuple(inches * units.MM_PER_INCH for inches in (0.2, 1.0, 2.0))
"""Maximum feed or lead in mm/rev for G36, G35 and G35F2, in this order."""


class RejectionCondition(Enum):
    """Condition under which the control rejects a code.

    The value of a member is its text on the reference page.
    """

    WITH_OTHER_WORDS = "the line contains other words"
    WITH_FEED = "the line contains F, G94 or G95 and is not the first line of the program"
    WITH_M = "the line contains an M code"
    NOSE_COMPENSATION = "G41 or G42 is active"
    COARSE_FEED = "G35 is active"
    NO_COARSE_FEED = "G35 is not active"
    INCREMENTAL_DIAMETERS = "G72 and G91 are active"
    SURFACE_SPEED = "G96 is active"
    FEED_PER_REV = "G95 is active"
    NO_FEED = "the line has no F and no cutting feed is active"
    NO_CUT_FEED = "no previous cutting feed is available"
    TOOL_NOT_MOVED = "the T word has not yet been followed by a move to X and Z"
    NO_SPEED = "no spindle speed has been set with S"
    SPINDLE_STOPPED = "the spindle is stopped"
    SPINDLE_TURNING = (
        "the spindle is turning, and the machine file does not allow the collet to "
        "open while the spindle turns"
    )
    COLLET_OPEN = (
        "the collet is open, and the machine file does not allow the spindle to start with the collet open"
    )
    C_LOCKED = "the spindle is locked as the C axis"
    C_NOT_LOCKED = "the spindle is not locked as the C axis"
    C_DISABLED = "the C axis is disabled in the machine file"
    NO_STRAIGHT_MOVE = "the line does not contain a straight move in X or Z"


class CodeEntryError(CodedError, ValueError):
    """An error raised if an entry of the code table is inconsistent."""


class ErrorTemplate(NamedTuple):
    """Template of a diagnostic, with its code, message, remedy and location.

    The location is a word letter, a column, or an empty string for the code itself. The texts may contain
    the placeholders ``code``, ``number``, ``name``, ``letter`` and ``word``, and further placeholders whose
    values the caller supplies.
    """

    diagnostic_code: str
    text: str
    hint: str = ""
    location: str | int = ""


@dataclass(frozen=True, slots=True)
class WordRule:
    """Meaning of a word on a line with a code, and the permitted range of its number.

    - The range is from ``minimum`` to ``maximum``; ``excludes_minimum`` excludes ``minimum`` itself.
    - ``missing_error`` is the error if the word is missing.
    - ``invalid_error`` is the error for an invalid number.
    - ``too_large_error`` is a separate error for a number above the limit.
    - ``value_without_number`` is the value that is assumed if the letter has no number.
    """

    description: str
    minimum: float = -inf
    maximum: float | WordLimit = inf
    excludes_minimum: bool = False
    requires_nonzero: bool = False
    requires_whole_number: bool = False
    value_without_number: float | None = None
    missing_error: ErrorTemplate | None = None
    invalid_error: ErrorTemplate | None = None
    too_large_error: ErrorTemplate | None = None
    no_number_error: ErrorTemplate | None = None  # error for the letter without a number
    unwanted_number_error: ErrorTemplate | None = (
        None  # error for the letter with a number that is not allowed here
    )

    def find_error(self, number: float, limit: float = inf) -> ErrorTemplate | None:
        """Return the error for the number of a word, or None if the number is valid.

        ``limit`` is the current upper limit if ``maximum`` is a ``WordLimit``.
        """
        too_small = number < self.minimum or (self.excludes_minimum and number == self.minimum)
        if (
            too_small
            or (self.requires_nonzero and number == 0)
            or (self.requires_whole_number and number % 1)
        ):
            return self.invalid_error
        greatest = limit if isinstance(self.maximum, WordLimit) else self.maximum
        return (self.too_large_error or self.invalid_error) if number > greatest else None

    @property
    def errors(self) -> tuple[ErrorTemplate, ...]:
        """Return all errors that this rule defines."""
        said = (
            self.missing_error,
            self.no_number_error,
            self.unwanted_number_error,
            self.invalid_error,
            self.too_large_error,
        )
        return tuple(each for each in said if each is not None)


class WordGroup(NamedTuple):
    """A group of words of which a line needs at least one, or may have at most one.

    The group contains the error for a line that violates this rule.
    """

    letters: tuple[str, ...]
    refusal: ErrorTemplate


@dataclass(frozen=True, slots=True)
class CodeEntry:
    """Entry of one code in the code table.

    - ``example``: program lines between ``EXAMPLE_HEAD`` and ``EXAMPLE_TAIL``.
    - ``example_subroutine``: example lines after the program end.
    - ``allowed_words``: permitted words other than G and M.
    - ``word_rules``: ranges of the numbers of these words.
    - ``required_words``, ``exclusive_words``: words that are required or exclude each other.
    - ``rejection_conditions``: conditions that reject the code, in the order of the checks.
    - ``other_diagnostic_codes``: codes of checks that need geometry, other lines or the structure.

    Raises CodeEntryError if words, rules and the meaning of F contradict each other, or if a mode has no
    group.
    """

    name: str
    syntax: str
    description: str
    example: str
    example_subroutine: str = ""
    action_kind: ActionKind = field(kw_only=True)
    handler: str = field(kw_only=True)
    f_meaning: FMeaning = field(kw_only=True)
    s_meaning: SMeaning = SMeaning.SPEED
    allowed_words: frozenset[str] = frozenset()
    mode_group: str = ""  # a line may have only one mode of a group
    word_rules: Mapping[str, WordRule] = field(default_factory=dict)
    required_words: WordGroup | None = None
    exclusive_words: tuple[WordGroup, ...] = ()
    rejection_conditions: Mapping[RejectionCondition, ErrorTemplate] = field(default_factory=dict)
    required_input: tuple[str, bool] = ("", False)  # the input that the code reads, and the required state
    min_block_count: int = 0  # minimum number of its elementary blocks
    ends_program: bool = False
    calls_subroutine: bool = False  # calls a subroutine
    depends_on_input: bool = False  # the call depends on an input
    allows_block_delete: bool = True  # "/" may precede it
    is_allowed_with_compensation: bool = False  # allowed with G41 and G42
    is_allowed_after_corner: bool = False  # allowed between a move with C or R and the next move
    is_allowed_in_contour: bool = False  # allowed in the contour of G75 and G78
    mdi_error_text: str = ""  # template with {code}: why MDI rejects the code, which needs other lines
    other_diagnostic_codes: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        if ("F" in self.allowed_words) is not (self.f_meaning is not FMeaning.NONE):
            raise CodeEntryError(
                f"{self.name}: its words and what F means there contradict each other", "f-word"
            )
        if self.action_kind is ActionKind.MODE and not self.mode_group:
            raise CodeEntryError(f"{self.name}: a mode needs its group", "no-group")
        if self.action_kind is not ActionKind.WORD and self.word_rules.keys() - self.allowed_words:
            raise CodeEntryError(
                f"{self.name}: a rule for a word that may not stand there", "rule-without-word"
            )

    @property
    def entry_errors(self) -> tuple[ErrorTemplate, ...]:
        """Return the error templates that this entry defines."""
        together = (*self.exclusive_words, *((self.required_words,) if self.required_words else ()))
        of_words = (each for rule in self.word_rules.values() for each in rule.errors)
        return (*self.rejection_conditions.values(), *of_words, *(each.refusal for each in together))

    @property
    def diagnostic_codes(self) -> frozenset[str]:
        """Return all diagnostic codes of the errors and warnings for this code."""
        return self.other_diagnostic_codes | {each.diagnostic_code for each in self.entry_errors}

    @property
    def example_program(self) -> str:
        """Return the example as a complete program."""
        return f"{EXAMPLE_HEAD}{self.example}\n{EXAMPLE_TAIL}{self.example_subroutine}"


def names(text: str) -> frozenset[str]:
    """Split a space-separated string into a set of names."""
    return frozenset(text.split())


PLAIN_WORDS = names("X Z C CA CI R F S T D")
"""Words allowed on a line without a code of its own, and in addition to modes and M codes."""

# Constructors for the kinds of entries. Modes and M codes allow the words of a plain line.
make_mode_entry = partial(
    CodeEntry, action_kind=ActionKind.MODE, allowed_words=PLAIN_WORDS, f_meaning=FMeaning.FEED
)
make_m_code_entry = partial(CodeEntry, allowed_words=PLAIN_WORDS, f_meaning=FMeaning.FEED)
make_letter_entry = partial(CodeEntry, action_kind=ActionKind.WORD, f_meaning=FMeaning.NONE)
make_flow_entry = partial(CodeEntry, action_kind=ActionKind.FLOW, f_meaning=FMeaning.NONE)

Chapter = tuple[str, tuple[CodeEntry, ...]]
"""Chapter title and its codes, in page order."""
