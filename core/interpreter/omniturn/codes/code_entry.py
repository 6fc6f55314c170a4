"""What an entry of the code table can state: words, what F and S mean, bounds, when a code is refused."""

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
    """What a code does on its line, and so when: see ``block_execution``."""

    PLAIN = auto()  # no code of its own: a straight move, or none
    WORD = auto()  # a letter
    MODE = auto()  # in force until another of its group
    FRAME = auto()  # its X and Z are no motion
    LOCK = auto()  # the spindle becomes the axis C; before the motion
    SPINDLE = auto()  # starts the spindle; before the motion
    START = auto()  # an M function before the motion
    ARC = auto()
    MOTION = auto()  # motion or rest of a kind of its own
    CYCLE = auto()  # a line that stands for many motions
    CONTOUR = auto()  # a cycle along the lines that follow it, or along a subroutine
    STOP = auto()  # an M function after the motion
    FLOW = auto()  # steers the order of execution


class FWord(Enum):
    """What F means on the line of a code."""

    NONE = auto()  # no F may stand there
    FEED = auto()  # the feed from here on
    SECONDS = auto()
    LEADS = auto()  # how coarse leads may be


class SWord(Enum):
    """What S means on the line of a code."""

    SPEED = auto()  # of the spindle, from here on
    LIMIT = auto()  # of constant surface speed, rpm
    C_SPEED = auto()  # rpm at which C turns


class Limit(Enum):
    """A bound that the machine file sets, or what is in force; its value is what the page calls it."""

    FEED = "the machine's maximum feed"
    FEED_IN_FORCE = (
        "the maximum feed: with G94, the machine's limit; with G95, .2 in/rev (1 in/rev "
        "after G35, 2 in/rev after G35F2)"
    )
    LEAD = ".2 in/rev (1 in/rev after G35, 2 in/rev after G35F2)"
    RPM = "the maximum spindle speed"
    C_RPM = "the maximum speed of the C axis"
    SURFACE = "6000 m/min"  # ten times what any tool stands


MOST_PER_REV = tuple(inches * units.MM_PER_INCH for inches in (0.2, 1.0, 2.0))
"""The greatest feed and lead, mm/rev, by G36, G35 and G35F2."""


class When(Enum):
    """What may be so when a code comes; its value is what the page calls it."""

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
    """A row of the code table that contradicts itself."""


class Refusal(NamedTuple):
    """A diagnostic: its code, sentence and remedy, and where it is: a letter, a column, "" at the code.

    In braces stand ``code``, its ``number``, the ``letter`` and ``what`` of a word, the ``word`` as written,
    and what whoever refuses has to tell besides.
    """

    code: str
    text: str
    hint: str = ""
    at: str | int = ""


@dataclass(frozen=True, slots=True)
class WordRule:
    """What a word means beside a code, and what its number must be: from ``least`` to ``most``.

    ``over``: ``least`` itself is too small. ``missing``: refused without the word; ``wrong``: with a number
    that is none, ``too_great`` where that is told in other words. ``bare`` is what the letter alone means.
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
    numberless: Refusal | None = None  # the letter is there and has no number
    numbered: Refusal | None = None  # it has one, and stands alone here

    def refusal_of(self, number: float, most: float = inf) -> Refusal | None:
        """What is said of a number, None where it may be; ``most``: what a limit is now."""
        too_small = number < self.least or (self.over and number == self.least)
        if too_small or (self.nonzero and number == 0) or (self.whole and number % 1):
            return self.wrong
        greatest = most if isinstance(self.most, Limit) else self.most
        return (self.too_great or self.wrong) if number > greatest else None

    @property
    def refusals(self) -> tuple[Refusal, ...]:
        """All that it can say."""
        said = (self.missing, self.numberless, self.numbered, self.wrong, self.too_great)
        return tuple(each for each in said if each is not None)


class Together(NamedTuple):
    """Words of which a line holds one at most, or one at least, and what is said otherwise."""

    letters: tuple[str, ...]
    refusal: Refusal


@dataclass(frozen=True, slots=True)
class Code:
    """One code. ``example``: lines that use it between ``HEAD`` and ``TAIL``; ``subroutine`` follows the end.

    ``words`` may stand beside it, G and M apart; ``rules`` say what their numbers must be, ``one_of`` and
    ``apart`` which must stand together or must not, ``not_when`` in what state it is refused, in the order in
    which it is looked at. ``further`` are the diagnostic codes that need geometry, the lines around or the
    structure of the program, and are told where that is computed. Raises ValueError where words, rules and
    the meaning of F contradict each other.
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
    group: str = ""  # one line may hold one mode of a group
    rules: Mapping[str, WordRule] = field(default_factory=dict)
    one_of: Together | None = None
    apart: tuple[Together, ...] = ()
    not_when: Mapping[When, Refusal] = field(default_factory=dict)
    terminal: tuple[str, bool] = ("", False)  # the input that it waits for or asks, and its wanted state
    least_blocks: int = 0  # elementary blocks that it makes at least
    ends_program: bool = False
    calls: bool = False  # a subroutine
    asks: bool = False  # calls only as an input says
    deletable: bool = True  # "/" may stand before it
    under_nose: bool = False  # may stand under G41 and G42 where it moves
    before_corner: bool = False  # may stand between a move with C or R and the next
    in_contour: bool = False  # may stand in the contour of G75 and G78
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
        """Those that stand in the entry with their sentences."""
        together = (*self.apart, *((self.one_of,) if self.one_of else ()))
        of_words = (each for rule in self.rules.values() for each in rule.refusals)
        return (*self.not_when.values(), *of_words, *(each.refusal for each in together))

    @property
    def refusals(self) -> frozenset[str]:
        """All diagnostic codes by which it is refused or warned of."""
        return self.further | {each.code for each in self.plain_refusals}

    @property
    def program(self) -> str:
        """The example as a whole program."""
        return f"{HEAD}{self.example}\n{TAIL}{self.subroutine}"


def names(text: str) -> frozenset[str]:
    """Names with blanks between them, as a set."""
    return frozenset(text.split())


PLAIN_WORDS = names("X Z C CA CI R F S T D")
"""Words of a line without a code of its own, and beside modes and M codes."""

# What the entries of a kind have in common: beside modes and M codes stand the words of a plain line.
mode = partial(Code, acts=Acts.MODE, words=PLAIN_WORDS, f=FWord.FEED)
m_code = partial(Code, words=PLAIN_WORDS, f=FWord.FEED)
letter = partial(Code, acts=Acts.WORD, f=FWord.NONE)
flow = partial(Code, acts=Acts.FLOW, f=FWord.NONE)

Chapter = tuple[str, tuple[Code, ...]]
"""A title and its codes, in the order of the page."""
