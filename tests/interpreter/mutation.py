"""Programs of any language spoilt as typing, disks and cables spoil them: for fuzzing."""

from __future__ import annotations

import random
from functools import cache

from core.interpreter.dialects import get_code_book
from core.interpreter.omniturn.codes.code_table import CODE_CHAPTERS
from core.language.source import Dialect

SEEDS = tuple(code.example_program for _, codes in CODE_CHAPTERS for code in codes)
_SIGNS = {
    Dialect.OMNITURN: "GMXZCIKRPSFTDLUAOQN()/}.-+,~0123456789 ",
    Dialect.KLARTEXT: 'LCRPQXYZABCFMSDTEIN;~*/="+-.,0123456789 ',
    Dialect.SINUMERIK: 'GMXZCIKRPSFTDLN()[]<>=;:/"_$+-.,0123456789 ',
}

# What forks a program, what a cut may lack, and what other controls and people write.
_LINES = {
    Dialect.OMNITURN: (
        "M95",
        "M97I1C1P1",
        "M97I2C0P6",
        "/M97I3C1P5",
        "/X.5",
        "M98P1",
        "M91",
        "M94",
        "M97I99C1P1",
        "T0",
        "M05",
        "M13",
        "M12",
        "M27",
        "M28",
        "M19S60",
        "F20X.4",
        "G95F.004Z-.3",
        "G92X0Z0",
        "(PLXC)",
        "%",
        "O1234",
        "N10X1",
        "G54",
        "G20",
        "T0101",
        "M06",
        "X1U.1",
        "F0",
        "X\u2212.5",
        "RETRACT THE TOOL",
        "M30 END",
        "X1;TURN",
        "M50",
        "LS3",
        "LF",
        "}1",
        "M99",
        "M30",
    ),
    Dialect.KLARTEXT: (
        "LBL 1",
        "LBL 0",
        "CALL LBL 1 REP 3",
        "CALL LBL 1",
        "L IX+5 R0 F200",
        "L X+Q1 RL",
        "CC X+0 Y+0",
        "C X+5 Y+5 DR-",
        "RND R2",
        "CHF 3",
        "TOOL CALL 1 Z S500 DR+1",
        "CYCL CALL",
        "L X+3 FMAX M99",
        "M128",
        "Q1 = Q1 + 1",
        "Q5 = 3 / Q1",
        "FN 9: IF +Q1 EQU +3 GOTO LBL 1",
        "PLANE RESET TURN",
        "/ L Z+5 FMAX",
        "PLANE AXIAL A+90 C+0 TURN FMAX",
        "STOP",
        "M30",
        "M2",
        "G01 X5",
        "FL AN+30",
        "L Z+1e9",
        "DEP LT LEN10",
    ),
    Dialect.SINUMERIK: (
        "GOTOB AGAIN",
        "AGAIN:",
        "IF R1>3 GOTOF OUT",
        "OUT:",
        "R1=R1+1",
        "R2=1/R1",
        "LOOP",
        "ENDLOOP",
        "ELSE",
        "G41 X20",
        "G40",
        "G42 Z-5",
        "G96 S200",
        "G97",
        "G95 F.1",
        "T1 D1",
        "D0",
        "M5",
        "M3 S900",
        "G91",
        "G90",
        "TRANS Z5",
        "G54",
        "G53 G0 X50",
        "G33 Z-20 K1.5",
        "RND=2",
        "CHF=1",
        "G2 X30 Z-5 CR=4",
        "/G0 X40",
        "M17",
        "C=DC(90)",
        "MSG()",
        "UNKNOWN(1,2)",
        "L99",
        "WHILE R1<5",
        "ENDWHILE",
        "FOR R1=1 TO 3",
        "ENDFOR",
        "M30",
    ),
}


@cache
def _seeds(dialect: Dialect) -> tuple[str, ...]:
    if dialect is Dialect.OMNITURN:
        return SEEDS
    book = get_code_book(dialect)
    end = "END PGM EXAMPLE MM\n" if dialect is Dialect.KLARTEXT else ""
    return tuple(
        each.example
        if each.whole
        else f"{book.head}{each.example}\n{book.lines_after_example}{each.behind}{end}"
        for each in book.entries
    )


def mutated(chance: random.Random, dialect: Dialect = Dialect.OMNITURN) -> str:
    """One of the book's programs with a few changes to characters, numbers and lines."""
    lines = chance.choice(_seeds(dialect)).splitlines() or [""]
    for _ in range(chance.randrange(1, 6)):
        _CHANGES[chance.randrange(len(_CHANGES))](lines, chance, dialect)
    return "\n".join(lines) + "\n"


def _change_character(lines: list[str], chance: random.Random, dialect: Dialect) -> None:
    at = chance.randrange(len(lines))
    line = lines[at] or " "
    k = chance.randrange(len(line))
    lines[at] = line[:k] + chance.choice(_SIGNS[dialect]) + line[k + chance.randrange(2) :]


def _change_number(lines: list[str], chance: random.Random, dialect: Dialect) -> None:
    at = chance.randrange(len(lines))
    letter = chance.choice("XZCIKRSFTDPLU")
    number = chance.choice(
        ["0", "-0", ".00001", "-.5", "1", "1e9", "99999999", "-1", "3.", str(chance.random())]
    )
    lines[at] += letter + number if dialect is Dialect.OMNITURN else f" {letter}{number}"


def _drop_line(lines: list[str], chance: random.Random, _dialect: Dialect) -> None:
    if len(lines) > 2:
        del lines[chance.randrange(len(lines))]


def _repeat_lines(lines: list[str], chance: random.Random, _dialect: Dialect) -> None:
    at = chance.randrange(len(lines))
    lines[at:at] = lines[at : at + chance.randrange(1, 4)]


def _swap_lines(lines: list[str], chance: random.Random, _dialect: Dialect) -> None:
    a, b = chance.randrange(len(lines)), chance.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]


def _mix_programs(lines: list[str], chance: random.Random, dialect: Dialect) -> None:
    other = chance.choice(_seeds(dialect)).splitlines() or [""]
    lines[chance.randrange(len(lines)) :] = other[chance.randrange(len(other)) :]


def _insert_line(lines: list[str], chance: random.Random, dialect: Dialect) -> None:
    lines.insert(chance.randrange(len(lines) + 1), chance.choice(_LINES[dialect]))


_CHANGES = (
    _insert_line,
    _insert_line,
    _change_character,
    _change_character,
    _change_number,
    _drop_line,
    _repeat_lines,
    _swap_lines,
    _mix_programs,
)
