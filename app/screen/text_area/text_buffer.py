"""Text of the text area, stored in blocks of whole lines, with its undo history. It does not use Qt.

An edit copies only the blocks that it changes. Therefore its duration does not depend on the length of the
text. Positions count characters from 0, and lines count from 0.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import NamedTuple

BLOCK_LENGTH = 8192  # characters of a block, unless its first line is longer
MAX_HISTORY_LENGTH = 64 * 1024 * 1024  # characters in the undo history


class TextSelection(NamedTuple):
    """Selected range of a text. The cursor is at ``position``, and the other end is at ``anchor``."""

    anchor: int = 0
    position: int = 0

    @property
    def start(self) -> int:
        """Return the position of the first selected character."""
        return min(self)

    @property
    def end(self) -> int:
        """Return the position after the last selected character."""
        return max(self)


class TextChange(NamedTuple):
    """Lines that an edit has changed.

    The edit replaces ``old_line_count`` lines by ``new_line_count`` lines. The first of them is
    ``first_line``.
    """

    first_line: int
    old_line_count: int
    new_line_count: int


@dataclass(frozen=True, slots=True)
class _Edit:
    """Replacement of the blocks from index ``first``, with the selections before and after it.

    ``typing_end`` is the position at which the next typed character continues this edit, or -1.
    """

    first: int
    old: Sequence[str]
    new: Sequence[str]
    change: TextChange
    before: TextSelection
    after: TextSelection
    typing_end: int = -1

    @property
    def length(self) -> int:
        """Return the number of stored characters."""
        return sum(map(len, self.old)) + sum(map(len, self.new))


class TextBuffer:
    """Text in blocks of whole lines, with an undo history.

    Every block except the last ends with a line feed.
    """

    def __init__(self, text: str = "") -> None:
        self.revision = 0  # number of changes
        self.set_text(text)

    def set_text(self, text: str) -> None:
        """Replace the whole text, and clear the undo history."""
        self._blocks = cut_blocks(text)
        self._line_feeds = _count_line_feeds(self._blocks)
        self._done: list[_Edit] = []
        self._undone: list[_Edit] = []
        self._history_length = 0
        self.last_change = TextChange(0, 1, 1)
        self._update_index()
        self._joined: str | None = text

    # --- reading -------------------------------------------------------------------------------------

    @property
    def text(self) -> str:
        """Return the whole text. It is joined once after each change."""
        if self._joined is None:
            self._joined = "".join(self._blocks)
        return self._joined

    @property
    def length(self) -> int:
        """Return the number of characters."""
        return self._starts[-1]

    @property
    def line_count(self) -> int:
        """Return the number of lines, including an empty line after the last line feed."""
        return self._line_starts[-1] + 1

    def find_line(self, position: int) -> int:
        """Return the line that contains a position."""
        index, offset = self._find_block(position)
        return self._line_starts[index] + self._blocks[index].count("\n", 0, offset)

    def find_column(self, position: int) -> int:
        """Return the number of characters between the start of the line and a position."""
        index, offset = self._find_block(position)
        return offset - (self._blocks[index].rfind("\n", 0, offset) + 1)

    def find_line_start(self, line: int) -> int:
        """Return the position of the first character of a line."""
        index = min(bisect_right(self._line_starts, line), len(self._blocks)) - 1
        block, offset = self._blocks[index], 0
        for _ in range(line - self._line_starts[index]):
            offset = block.find("\n", offset) + 1
        return self._starts[index] + offset

    def find_position(self, line: int, column: int) -> int:
        """Return the position of a column, or the end of the line if the line is shorter."""
        line = max(0, min(line, self.line_count - 1))
        return self.find_line_start(line) + max(0, min(column, len(self.read_line(line))))

    def read_line(self, line: int) -> str:
        """Return the text of a line without its line feed."""
        return self.read_lines(line, 1)[0]

    def read_lines(self, first: int, count: int) -> list[str]:
        """Return at most ``count`` lines, starting with the line ``first``."""
        index, offset = self._find_block(self.find_line_start(first))
        lines = self._blocks[index][offset:].split("\n")
        while len(lines) <= count and index + 1 < len(self._blocks):
            index += 1
            lines[-1:] = self._blocks[index].split("\n")
        return lines[:count]

    def read_range(self, start: int, end: int) -> str:
        """Return the text between two positions."""
        first, offset = self._find_block(start)
        last, _ = self._find_block(end)
        joined = "".join(self._blocks[first : last + 1])
        return joined[offset : offset + end - start]

    def find_last_line_with(self, sign: str, line: int) -> int:
        """Return the last line before ``line`` that contains a character, or -1."""
        index, offset = self._find_block(self.find_line_start(line))
        found = self._blocks[index].rfind(sign, 0, offset)
        while found < 0 and index > 0:
            index -= 1
            found = self._blocks[index].rfind(sign)
        return self.find_line(self._starts[index] + found) if found >= 0 else -1

    # --- editing -------------------------------------------------------------------------------------

    def replace_range(
        self, start: int, end: int, text: str, before: TextSelection, *, is_typing: bool = False
    ) -> TextSelection:
        """Replace the text between two positions, and return the new selection.

        ``before`` is the selection that an undo restores. Consecutive edits with ``is_typing`` are one step
        of the undo history.
        """
        change = self._find_change(start, end, text)
        first, offset = self._find_block(start)
        last, end_offset = self._find_block(end)
        changed = self._blocks[first][:offset] + text + self._blocks[last][end_offset:]
        last += 1
        while last < len(self._blocks) and (not changed.endswith("\n") or len(changed) < BLOCK_LENGTH // 8):
            changed += self._blocks[last]
            last += 1
        after = TextSelection(start + len(text), start + len(text))
        edit = _Edit(first, self._blocks[first:last], cut_blocks(changed), change, before, after)
        self._apply(first, edit.old, edit.new, change)
        self._remember(replace(edit, typing_end=after.position if is_typing else -1), start, end)
        return after

    def replace_matches(
        self, positions: Sequence[int], length: int, replacement: str, before: TextSelection
    ) -> TextSelection:
        """Replace several ranges of the same length as one step of the undo history.

        The positions are sorted, and the ranges do not overlap. Returns the new selection.
        """
        start, end = positions[0], positions[-1] + length
        old = self.read_range(start, end)
        ends = [start, *(at + length for at in positions[:-1])]
        parts = [old[a - start : b - start] for a, b in zip(ends, positions, strict=True)]
        return self.replace_range(start, end, replacement.join([*parts, ""]), before)

    def undo(self) -> TextSelection | None:
        """Reverse the last step, and return the selection before it, or None without a step."""
        if not self._done:
            return None
        edit = self._done.pop()
        self._undone.append(edit)
        line, old_count, new_count = edit.change
        self._apply(edit.first, edit.new, edit.old, TextChange(line, new_count, old_count))
        return edit.before

    def redo(self) -> TextSelection | None:
        """Repeat the last reversed step, and return the selection after it, or None without a step."""
        if not self._undone:
            return None
        edit = self._undone.pop()
        self._done.append(edit)
        self._apply(edit.first, edit.old, edit.new, edit.change)
        return edit.after

    def end_typing(self) -> None:
        """End the present step of the undo history. The next typed character begins a new step."""
        if self._done:
            self._done[-1] = replace(self._done[-1], typing_end=-1)

    def _remember(self, edit: _Edit, start: int, end: int) -> None:
        """Store an edit in the undo history, and forget the oldest edits if the history is too long."""
        self._history_length -= sum(each.length for each in self._undone)
        self._undone.clear()
        last = self._done[-1] if self._done else None
        continues = last is not None and edit.typing_end >= 0 and last.typing_end in {start, end}
        if last is not None and continues and (last.first, len(last.new)) == (edit.first, len(edit.old)):
            self._history_length -= self._done.pop().length
            edit = replace(edit, old=last.old, before=last.before)
        self._done.append(edit)
        self._history_length += edit.length
        while self._history_length > MAX_HISTORY_LENGTH and len(self._done) > 1:
            self._history_length -= self._done.pop(0).length

    def _find_change(self, start: int, end: int, text: str) -> TextChange:
        line = self.find_line(start)
        return TextChange(line, self.find_line(end) - line + 1, text.count("\n") + 1)

    def _apply(self, first: int, old: Sequence[str], new: Sequence[str], change: TextChange) -> None:
        self._blocks[first : first + len(old)] = new
        self._line_feeds[first : first + len(old)] = _count_line_feeds(new)
        self.last_change = change
        self._update_index()

    def _update_index(self) -> None:
        self.revision += 1
        self._joined = None
        self._starts = [0, *accumulate(map(len, self._blocks))]
        self._line_starts = [0, *accumulate(self._line_feeds)]

    def _find_block(self, position: int) -> tuple[int, int]:
        """Return the index of the block that contains a position, and the offset in the block."""
        index = min(bisect_right(self._starts, position), len(self._blocks)) - 1
        return index, position - self._starts[index]


def _count_line_feeds(blocks: Sequence[str]) -> list[int]:
    """Return the number of line feeds of each block."""
    return [block.count("\n") for block in blocks]


def cut_blocks(text: str) -> list[str]:
    """Return a text as blocks of whole lines."""
    blocks, at = [], 0
    while len(text) - at > 2 * BLOCK_LENGTH:
        end = text.rfind("\n", at, at + BLOCK_LENGTH) + 1 or text.find("\n", at + BLOCK_LENGTH) + 1
        if not end:
            break
        blocks.append(text[at:end])
        at = end
    return [*blocks, text[at:]] if at < len(text) or not blocks else blocks
