"""Programs spoilt as typing, disks and cables spoil them: for fuzzing."""

from __future__ import annotations

import random

from core.interpreter.omniturn.code_table import CHAPTERS

SEEDS = tuple(code.program for _, codes in CHAPTERS for code in codes)
_LETTERS = "GMXZCIKRPSFTDLUAOQN()/}.-+,~0123456789 "


# What forks a program, what a cut may lack, and what other controls and people write.
_LINES = (
    *("M95", "M97I1C1P1", "M97I2C0P6", "/M97I3C1P5", "/X.5", "M98P1", "M91", "M94", "M97I99C1P1"),
    *("T0", "M05", "M13", "M12", "M27", "M28", "M19S60", "F20X.4", "G95F.004Z-.3", "G92X0Z0", "(PLXC)"),
    *("%", "O1234", "N10X1", "G54", "G20", "T0101", "M06", "X1U.1", "F0", "X\u2212.5", "RETRACT THE TOOL"),
    *("M30 END", "X1;TURN", "M50", "LS3", "LF", "}1", "M99", "M30"),
)


def mutated(chance: random.Random) -> str:
    """One of the book's programs with a few changes to characters, numbers and lines."""
    lines = chance.choice(SEEDS).splitlines()
    for _ in range(chance.randrange(1, 6)):
        _CHANGES[chance.randrange(len(_CHANGES))](lines, chance)
    return "\n".join(lines) + "\n"


def _change_character(lines: list[str], chance: random.Random) -> None:
    at = chance.randrange(len(lines))
    line = lines[at] or " "
    k = chance.randrange(len(line))
    lines[at] = line[:k] + chance.choice(_LETTERS) + line[k + chance.randrange(2) :]


def _change_number(lines: list[str], chance: random.Random) -> None:
    at = chance.randrange(len(lines))
    letter = chance.choice("XZCIKRSFTDPLU")
    number = chance.choice(
        ["0", "-0", ".00001", "-.5", "1", "1e9", "99999999", "-1", "3.", str(chance.random())]
    )
    lines[at] += letter + number


def _drop_line(lines: list[str], chance: random.Random) -> None:
    if len(lines) > 2:
        del lines[chance.randrange(len(lines))]


def _repeat_lines(lines: list[str], chance: random.Random) -> None:
    at = chance.randrange(len(lines))
    lines[at:at] = lines[at : at + chance.randrange(1, 4)]


def _swap_lines(lines: list[str], chance: random.Random) -> None:
    a, b = chance.randrange(len(lines)), chance.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]


def _mix_programs(lines: list[str], chance: random.Random) -> None:
    other = chance.choice(SEEDS).splitlines()
    lines[chance.randrange(len(lines)) :] = other[chance.randrange(len(other)) :]


def _insert_line(lines: list[str], chance: random.Random) -> None:
    lines.insert(chance.randrange(len(lines) + 1), chance.choice(_LINES))


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
