"""Comments of an OmniTurn program, in the order in which its blocks are executed."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Sequence

from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block

COMMENT = re.compile(r"\(([^()]*)\)?")
_SUBROUTINE = re.compile(r"\s*\}")
_JUMP = re.compile(r"[/\s]*(M9[5789]|P\s*\d|LF)", re.IGNORECASE)


class SourceComments:
    """Reader of the comments that belong to the next step of the converted program.

    ``texts`` contains the lines of the program. ``block_lines`` contains the numbers of the lines that have
    blocks, in ascending order.
    """

    def __init__(self, texts: Sequence[str], block_lines: Sequence[int]) -> None:
        self._texts, self._block_lines = texts, block_lines
        self._line = 0  # of the last block
        self._read: set[int] = set()
        self._comments: list[str] = []

    def remove_pending(self) -> str:
        """Return the comments that no step has, separated by line feeds, and remove them."""
        comments, self._comments = self._comments, []
        return "\n".join(comments)

    def restore_pending(self, comment: str) -> None:
        """Restore comments that belong to a later step."""
        self._comments = comment.split("\n") if comment else []

    def read_lines_before(self, block: Block) -> Sequence[int]:
        """Read the comments of the line of a block and of the lines without blocks before it.

        The latter are read only once. At a jump, the lines up to the one that jumps are included, but not
        the lines that the jump skips. Returns the numbers of the lines that were read.
        """
        before, line = self._line, block.line
        if line == before and not isinstance(block.action, actions.ProgramStop):
            return ()
        self._line = line
        index = bisect_left(self._block_lines, line)
        first = self._block_lines[index - 1] + 1 if index else 1
        numbers = [] if before == first - 1 else self._list_lines_to_jump(before)
        labels = (each for each in range(line, first, -1) if _SUBROUTINE.match(self._texts[each - 1]))
        numbers += range(next(labels, first), line)
        numbers = [*(each for each in numbers if each not in self._read), line]
        for each in numbers:
            found = COMMENT.findall(self._texts[each - 1])
            self._comments += filter(None, map(str.strip, found))
        self._read.update(numbers)
        return numbers

    def _list_lines_to_jump(self, line: int) -> list[int]:
        """Return the numbers of the lines without blocks from the one after ``line`` to a jump."""
        index = bisect_left(self._block_lines, line + 1)
        end = self._block_lines[index] if index < len(self._block_lines) else len(self._texts)
        numbers = []
        for number in range(line + 1, end):
            numbers.append(number)
            if _JUMP.match(self._texts[number - 1]):
                break
        return numbers
