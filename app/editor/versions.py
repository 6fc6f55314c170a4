"""The versions of the program that is edited: where they are kept, what each would change, line by line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Protocol

from app.desk.background_work import Latest, Watch
from core.message import Message
from core.store.store_errors import StoreError
from core.store.store_rows import VersionRow


class Archive(Protocol):
    """The versions of programs. Called on the editor's worker only; each raises StoreError."""

    def versions(self, name: str) -> Sequence[VersionRow]:
        """Every version of a program, newest first."""
        ...

    def text_of(self, name: str, version: int) -> bytes:
        """One of them, as it was kept."""
        ...

    def save_version(self, name: str, text: bytes, why: str) -> int:
        """Keep another, and answer its number when it is on the disk; the same text again is no new one."""
        ...


class NoArchive:
    """Where nothing is kept: scripts, and a desk whose store cannot be opened."""

    def versions(self, _name: str) -> Sequence[VersionRow]:
        """No version is kept."""
        return ()

    def text_of(self, name: str, version: int) -> bytes:
        """Raises StoreError: no version is kept."""
        raise StoreError(
            Message("version {version} of {name} is not in the program history", version=version, name=name),
            "no-version",
        )

    def save_version(self, _name: str, _text: bytes, _why: str) -> int:
        """Keeps nothing and answers 0."""
        return 0


# --- what has changed between two versions, line by line ---------------------------------------------------


AROUND = 2  # unchanged lines shown about a change
MOST_COMPARED = 20_000  # lines: above that only the first and last difference are looked for


@dataclass(frozen=True, slots=True)
class DifferenceRow:
    """One line of a comparison. ``sign`` is + (new), - (old), blank (both) or … (lines left out)."""

    sign: str
    old: int  # line number in the old text, 0: it is not there
    new: int
    text: str


def differences(old: str, new: str) -> tuple[DifferenceRow, ...]:
    """The rows from one text to another; empty when they are the same."""
    if old == new:
        return ()
    before, after = old.splitlines(), new.splitlines()
    rows: list[DifferenceRow] = []
    for group in _groups(before, after):
        if rows or group[0][1] > 0:
            rows.append(DifferenceRow("…", 0, 0, ""))
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
) -> list[DifferenceRow]:
    if tag == "equal":
        shift = new[0] - old[0]
        return [DifferenceRow(" ", n + 1, n + 1 + shift, before[n]) for n in range(*old)]
    gone = [DifferenceRow("-", n + 1, 0, before[n]) for n in range(*old)]
    return gone + [DifferenceRow("+", 0, n + 1, after[n]) for n in range(*new)]


# --- the versions of the program that is edited ------------------------------------------------------------


@dataclass(slots=True)
class VersionHistory:
    """``rows`` are the versions, newest first; ``changes`` leads from the marked one to the text on hand."""

    archive: Archive
    worker: Latest
    name: str = ""
    now: str = ""
    rows: tuple[VersionRow, ...] = ()
    marked: int = 0
    text: str | None = None  # of the marked version, once it is read
    changes: tuple[DifferenceRow, ...] = ()
    trouble: str = ""

    def look(self, name: str, now: str) -> None:
        """Open the history of a program; ``now`` is the text in the editor."""
        self.name, self.now = name, now
        self.rows, self.marked, self.text, self.changes, self.trouble = (), 0, None, (), ""
        self.worker.queue(lambda: tuple(self.archive.versions(name)), self._listed, self._failed)

    def mark(self, place: int) -> None:
        """Mark another version and compare it."""
        if not self.rows:
            return
        self.marked = max(0, min(len(self.rows) - 1, place))
        self.text, self.changes, self.trouble = None, (), ""
        name, now, number = self.name, self.now, self.rows[self.marked].number

        def compare(_watch: Watch) -> tuple[str, tuple[DifferenceRow, ...]]:
            text = lines_of(self.archive.text_of(name, number))
            return text, differences(*self.between(text, now))

        self.worker.ask(compare, self._compared, self._failed)

    def between(self, marked: str, now: str) -> tuple[str, str]:
        """From which text to which the changes lead."""
        return marked, now

    def heading(self) -> str:
        """What the lines of the comparison are."""
        return Message("CHANGES FROM VERSION {number} TO THE EDITOR TEXT", number=self.number)

    @property
    def number(self) -> int:
        """The number of the marked version, 0: there is none."""
        return self.rows[self.marked].number if self.rows else 0

    def words(self) -> str:
        """What is to be said of the marked version."""
        if self.trouble:
            return self.trouble
        if not self.rows:
            return "READING" if self.worker.busy else "NO VERSION OF THIS PROGRAM STORED YET"
        if self.text is None:
            return "COMPARING"
        return "" if self.changes else "IDENTICAL TO THE TEXT IN THE EDITOR"

    def _listed(self, rows: tuple[VersionRow, ...]) -> None:
        self.rows = rows
        self.mark(0)

    def _compared(self, answer: tuple[str, tuple[DifferenceRow, ...]]) -> None:
        self.text, self.changes = answer

    def _failed(self, why: str) -> None:
        self.trouble = why


def lines_of(data: bytes) -> str:
    """A version's text as an editor shows it; bytes of old codes stay apart from each other."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.rstrip("\x1a").replace("\r\n", "\n").replace("\r", "\n")
