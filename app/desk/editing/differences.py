"""What has changed between two versions of a program, line by line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

AROUND = 2  # unchanged lines shown about a change
MOST_COMPARED = 20_000  # lines: above that only the first and last difference are looked for


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a comparison. ``sign`` is + (new), - (old), blank (both) or … (lines left out)."""

    sign: str
    old: int  # line number in the old text, 0: it is not there
    new: int
    text: str


def differences(old: str, new: str) -> tuple[Row, ...]:
    """The rows from one text to another; empty when they are the same."""
    if old == new:
        return ()
    before, after = old.splitlines(), new.splitlines()
    rows: list[Row] = []
    for group in _groups(before, after):
        if rows or group[0][1] > 0:
            rows.append(Row("…", 0, 0, ""))
        for tag, i1, i2, j1, j2 in group:
            rows += _rows(tag, (i1, i2), (j1, j2), before, after)
    return tuple(rows)


def _groups(before: Sequence[str], after: Sequence[str]) -> list[list[tuple[str, int, int, int, int]]]:
    if len(before) + len(after) <= MOST_COMPARED:
        matcher = SequenceMatcher(None, before, after, autojunk=len(before) > 1000)
        return [list(group) for group in matcher.get_grouped_opcodes(AROUND)]
    first = next((n for n, (a, b) in enumerate(zip(before, after, strict=False)) if a != b), None)
    first = min(len(before), len(after)) if first is None else first
    tail = 0
    while tail < min(len(before), len(after)) - first and before[-1 - tail] == after[-1 - tail]:
        tail += 1
    return [[("replace", first, len(before) - tail, first, len(after) - tail)]]


def _rows(
    tag: str, old: tuple[int, int], new: tuple[int, int], before: Sequence[str], after: Sequence[str]
) -> list[Row]:
    if tag == "equal":
        shift = new[0] - old[0]
        return [Row(" ", n + 1, n + 1 + shift, before[n]) for n in range(*old)]
    gone = [Row("-", n + 1, 0, before[n]) for n in range(*old)]
    return gone + [Row("+", 0, n + 1, after[n]) for n in range(*new)]
