"""Types of the code table: words, meanings of F and S, limits, and conditions that reject a code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, auto
from functools import partial
from math import inf
from typing import NamedTuple

from core.interpreter.shared import units
from core.message import CodedError

HEAD = "G90G94F300\nT1\nM03S1000\nX.6Z.1\nG95F.004\n"
"""Before every example: radius mode, the tool at X.6 Z.1, .004 in/rev at 1000 rpm."""

TAIL = "G94F300X.6Z1\nM30\n"


class Acts(Enum):
    """Kind of action of a code, which determines when it is executed; see ``block_execution``."""

    PLAIN = auto()  # a line without a one-shot code: a straight move or no move
    WORD = auto()  # a letter
    MODE = auto()  # active until another code of the same group
    FRAME = auto()  # its X and Z are not a motion
    LOCK = auto()  # the spindle becomes the C axis, before the motion
    SPINDLE = auto()  # starts the spindle; before the motion
    START = auto()  # an M function before the motion
    ARC = auto()
    MOTION = auto()  # a special motion or a dwell
    CYCLE = auto()  # a line that generates many motions
    CONTOUR = auto()  # a cycle along the lines that follow it, or along a subroutine
    STOP = auto()  # an M function after the motion
    FLOW = auto()  # controls the order of execution


class FWord(Enum):
    """Meaning of F on the line of a code."""

    NONE = auto()  # F is not allowed
    FEED = auto()  # the feed from this line on
    SECONDS = auto()
    LEADS = auto()  # the permitted range of leads


class SWord(Enum):
    """Meaning of S on the line of a code."""

    SPEED = auto()  # the spindle speed from this line on
    LIMIT = auto()  # a limit of constant surface speed, rpm
    C_SPEED = auto()  # the speed of the C axis, rpm


class Limit(Enum):
    """A limit from the machine file or the modal state; its value is the text on the reference page."""

    FEED = "the machine's maximum feed"
    FEED_IN_FORCE = (
        "the maximum feed: with G94, the machine's limit; with G95, .2 in/rev (1 in/rev "
        "after G35, 2 in/rev after G35F2)"
    )
    LEAD = ".2 in/rev (1 in/rev after G35, 2 in/rev after G35F2)"
    RPM = "the maximum spindle speed"
    C_RPM = "the maximum speed of the C axis"
    SURFACE = "6000 m/min"  # ten times the limit of any tool


MOST_PER_REV = tuple(inches * units.MM_PER_INCH for inches in (0.2, 1.0, 2.0))
"""The greatest feed and lead, mm/rev, by G36, G35 and G35F2."""


class When(Enum):
    """A condition that can reject a code; its value is the text on the reference page."""

    WITH_OTHERS = "the line contains other words"
    WITH_FEED = "the line contains F, G94 or G95 and is not the first line of the program"
    WITH_M = "the line contains an M code"
    NOSE_COMPENSATION = "G41 or G42 is active"
    COARSE = "G35 is active"
    NOT_COARSE = "G35 is not active"
    INCREMENTAL_DIAMETERS = "G72 and G91 are active"
    SURFACE_SPEED = "G96 is active"
    PER_REV = "G95 is active"
    NO_FEED = "the line has no F and no cutting feed is active"
    NO_CUT_FEED = "no previous cutting feed is available"
    TOOL_NOT_MOVED = "the T word has not yet been followed by a move to X and Z"
    NO_SPEED = "no spindle speed has been set with S"
    STANDING = "the spindle is stopped"
    TURNING = (
        "the spindle is turning, and the machine file does not allow the collet to "
        "open while the spindle turns"
    )
    COLLET_OPEN = (
        "the collet is open, and the machine file does not allow the spindle to start with the collet open"
    )
    C_LOCKED = "the spindle is locked as the C axis"
    C_FREE = "the spindle is not locked as the C axis"
    NO_C = "the C axis is disabled in the machine file"
    NO_STRAIGHT_MOVE = "the line does not contain a straight move in X or Z"


class CodeEntryError(CodedError, ValueError):
    """A row of the code table contradicts itself."""


class Refusal(NamedTuple):
    """Template of a diagnostic: code, message, remedy, and location (letter, column, or "" for the code).

    The texts may contain the placeholders ``code``, ``number``, ``letter``, ``what`` and ``word``, and
    further placeholders whose values the caller supplies.
    """

    code: str
    text: str
    hint: str = ""
    at: str | int = ""


@dataclass(frozen=True, slots=True)
class WordRule:
    """Meaning of a word on the line of a code, and the range of its number, from ``least`` to ``most``.

    With ``over``, the number must exceed ``least``. ``missing`` is the error without the word, ``wrong`` the
    error for an invalid number, and ``too_great`` a separate error for a number above the limit. ``bare`` is
    the value of the letter without a number.
    """

    what: str
    least: float = -inf
    most: float | Limit = inf
    over: bool = False
    nonzero: bool = False
    whole: bool = False
    bare: float | None = None
    missing: Refusal | None = None
    wrong: Refusal | None = None
    too_great: Refusal | None = None
    numberless: Refusal | None = None  # error for the letter without a number
    numbered: Refusal | None = None  # error for the letter with a number that is not allowed here

    def refusal_of(self, number: float, most: float = inf) -> Refusal | None:
        """Return the error for a number, or None. ``most`` is the present value of a ``Limit``."""
        too_small = number < self.least or (self.over and number == self.least)
        if too_small or (self.nonzero and number == 0) or (self.whole and number % 1):
            return self.wrong
        greatest = most if isinstance(self.most, Limit) else self.most
        return (self.too_great or self.wrong) if number > greatest else None

    @property
    def refusals(self) -> tuple[Refusal, ...]:
        """All errors of this rule."""
        said = (self.missing, self.numberless, self.numbered, self.wrong, self.too_great)
        return tuple(each for each in said if each is not None)


class Together(NamedTuple):
    """A set of words of which a line has at most one, or at least one, and the error otherwise."""

    letters: tuple[str, ...]
    refusal: Refusal


@dataclass(frozen=True, slots=True)
class Code:
    """Entry of one code. ``example`` are lines between ``HEAD`` and ``TAIL``; ``subroutine`` follows the end.

    ``words`` are the permitted words other than G and M. ``rules`` limit their numbers, ``one_of`` and
    ``apart`` specify required and exclusive words, and ``not_when`` lists the conditions that reject the
    code, in the order of the checks. ``further`` are diagnostic codes of checks that need geometry, other
    lines or the program structure. Raises CodeEntryError if words, rules and the meaning of F contradict each
    other.
    """

    name: str
    form: str
    what: str
    example: str
    subroutine: str = ""
    acts: Acts = field(kw_only=True)
    handler: str = field(kw_only=True)
    f: FWord = field(kw_only=True)
    s: SWord = SWord.SPEED
    words: frozenset[str] = frozenset()
    group: str = ""  # a line may have only one mode of a group
    rules: Mapping[str, WordRule] = field(default_factory=dict)
    one_of: Together | None = None
    apart: tuple[Together, ...] = ()
    not_when: Mapping[When, Refusal] = field(default_factory=dict)
    terminal: tuple[str, bool] = ("", False)  # the input that the code reads, and the required state
    least_blocks: int = 0  # minimum number of its elementary blocks
    ends_program: bool = False
    calls: bool = False  # calls a subroutine
    asks: bool = False  # the call depends on an input
    deletable: bool = True  # "/" may precede it
    under_nose: bool = False  # allowed with G41 and G42
    before_corner: bool = False  # allowed between a move with C or R and the next move
    in_contour: bool = False  # allowed in the contour of G75 and G78
    not_in_mdi: str = ""  # template with {code}: why MDI rejects the code, which needs other lines
    further: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        if ("F" in self.words) is not (self.f is not FWord.NONE):
            raise CodeEntryError(
                f"{self.name}: its words and what F means there contradict each other", "f-word"
            )
        if self.acts is Acts.MODE and not self.group:
            raise CodeEntryError(f"{self.name}: a mode needs its group", "no-group")
        if self.acts is not Acts.WORD and self.rules.keys() - self.words:
            raise CodeEntryError(
                f"{self.name}: a rule for a word that may not stand there", "rule-without-word"
            )

    @property
    def plain_refusals(self) -> tuple[Refusal, ...]:
        """The errors whose messages are in the entry."""
        together = (*self.apart, *((self.one_of,) if self.one_of else ()))
        of_words = (each for rule in self.rules.values() for each in rule.refusals)
        return (*self.not_when.values(), *of_words, *(each.refusal for each in together))

    @property
    def refusals(self) -> frozenset[str]:
        """All diagnostic codes of errors and warnings for this code."""
        return self.further | {each.code for each in self.plain_refusals}

    @property
    def program(self) -> str:
        """The example as a complete program."""
        return f"{HEAD}{self.example}\n{TAIL}{self.subroutine}"


def names(text: str) -> frozenset[str]:
    """Return a set of names from a text with blanks between them."""
    return frozenset(text.split())


PLAIN_WORDS = names("X Z C CA CI R F S T D")
"""Words of a line without a code of its own, and beside modes and M codes."""

# Constructors for the kinds of entries. Modes and M codes allow the words of a plain line.
mode = partial(Code, acts=Acts.MODE, words=PLAIN_WORDS, f=FWord.FEED)
m_code = partial(Code, words=PLAIN_WORDS, f=FWord.FEED)
letter = partial(Code, acts=Acts.WORD, f=FWord.NONE)
flow = partial(Code, acts=Acts.FLOW, f=FWord.NONE)

Chapter = tuple[str, tuple[Code, ...]]
"""A title and its codes, in the order of the page."""
