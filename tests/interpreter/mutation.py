"""Programs spoilt as typing, disks and cables spoil them: for fuzzing."""

from __future__ import annotations

import random

from core.interpreter.book import CHAPTERS

SEEDS = tuple(entry.program for _, entries in CHAPTERS for entry in entries)
_LETTERS = "GMXZCIKRPSFTDLUAOQN()/}.-+,~0123456789 "


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


_CHANGES = (
    _change_character,
    _change_character,
    _change_number,
    _drop_line,
    _repeat_lines,
    _swap_lines,
    _mix_programs,
)
