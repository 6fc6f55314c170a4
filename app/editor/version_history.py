"""Versions of the edited program, and line-by-line comparison of their texts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Protocol

from app.desk.background_work import LatestRequestWorker, ProgressCallback
from core.message import Message
from core.store.store_errors import StoreError
from core.store.store_rows import ProgramVersionRow


class VersionArchive(Protocol):
    """Archive of the stored versions of all programs.

    The methods are called only on the worker of the editor. All methods raise StoreError if the archive
    fails.
    """

    def versions(self, name: str) -> Sequence[ProgramVersionRow]:
        """Return all versions of a program, newest first."""
        ...

    def read_version_text(self, name: str, version: int) -> bytes:
        """Return the stored bytes of a version."""
        ...

    def save_version(self, name: str, text: bytes, reason: str) -> int:
        """Store a version and return its number after it is written to the disk.

        An unchanged text does not create a new version.
        """
        ...


class NullVersionArchive:
    """Archive without versions, for scripts and for a store that cannot be opened."""

    def versions(self, _name: str) -> Sequence[ProgramVersionRow]:
        """Return an empty tuple because this archive stores no versions."""
        return ()

    def read_version_text(self, name: str, version: int) -> bytes:
        """Raise StoreError because no version is stored."""
        raise StoreError(
            Message("version {version} of {name} is not in the program history", version=version, name=name),
            "no-version",
        )

    def save_version(self, _name: str, _text: bytes, _why: str) -> int:
        """Store nothing and return 0 as the version number."""
        return 0


# --- differences between two versions, line by line --------------------------------------------------------


CONTEXT_LINES = 2  # unchanged lines shown around a change
MAX_COMPARED_LINES = 20_000  # number of lines above which only the first and last difference are searched
MAX_SHOWN_LINES = 10_000  # lines of one difference that are shown


@dataclass(frozen=True, slots=True)
class DifferenceRow:
    """One line in the comparison of an old and a new text.

    ``sign`` is + for a new line, - for an old line, a blank for a line in both texts, and … for omitted
    lines.
    """

    sign: str
    old: int  # line number in the old text, or 0
    new: int
    text: str


def compare_texts(old: str, new: str) -> tuple[DifferenceRow, ...]:
    """Return the rows of a line-by-line comparison, or an empty tuple if the texts are equal."""
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
    if len(before) + len(after) <= MAX_COMPARED_LINES:
        matcher = SequenceMatcher(None, before, after, autojunk=len(before) > 1000)
        return [list(group) for group in matcher.get_grouped_opcodes(CONTEXT_LINES)]
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
    gone = [DifferenceRow("-", n + 1, 0, before[n]) for n in range(*old)[:MAX_SHOWN_LINES]]
    added = [DifferenceRow("+", 0, n + 1, after[n]) for n in range(*new)[:MAX_SHOWN_LINES]]
    omitted = [DifferenceRow("…", 0, 0, "")]
    return [
        *gone,
        *(omitted if len(range(*old)) > MAX_SHOWN_LINES else ()),
        *added,
        *(omitted if len(range(*new)) > MAX_SHOWN_LINES else ()),
    ]


# --- versions of the edited program ------------------------------------------------------------------------


@dataclass(slots=True)
class VersionHistory:
    """Version history of a program. The selected version is compared with the current text.

    ``changes`` are the differences between the selected version and the current text.
    """

    archive: VersionArchive
    worker: LatestRequestWorker
    program_name: str = ""
    current_text: str = ""
    rows: tuple[ProgramVersionRow, ...] = ()
    marked: int = 0
    text: str | None = None  # text of the selected version once it is read
    changes: tuple[DifferenceRow, ...] = ()
    error_text: str = ""

    def open_history(self, name: str, current_text: str) -> None:
        """Start reading the versions of a program.

        ``current_text`` is the text in the editor.
        """
        self.program_name, self.current_text = name, current_text
        self.rows, self.marked, self.text, self.changes, self.error_text = (), 0, None, (), ""
        self.worker.enqueue_work(lambda: tuple(self.archive.versions(name)), self._listed, self._failed)

    def mark(self, index: int) -> None:
        """Select a version and compare its text with the current text."""
        if not self.rows:
            return
        self.marked = max(0, min(len(self.rows) - 1, index))
        self.text, self.changes, self.error_text = None, (), ""
        name, now, number = self.program_name, self.current_text, self.rows[self.marked].number

        def compare_version(_watch: ProgressCallback) -> tuple[str, tuple[DifferenceRow, ...]]:
            text = decode_text(self.archive.read_version_text(name, number))
            return text, compare_texts(*self.order_texts(text, now))

        self.worker.request_work(compare_version, self._compared, self._failed)

    def order_texts(self, selected: str, current: str) -> tuple[str, str]:
        """Return the two texts to compare, the older text first."""
        return selected, current

    def heading(self) -> str:
        """Return the heading of the comparison."""
        return Message("CHANGES FROM VERSION {number} TO THE EDITOR TEXT", number=self.number)

    @property
    def number(self) -> int:
        """Return the number of the selected version, or 0 if there are no versions."""
        return self.rows[self.marked].number if self.rows else 0

    def words(self) -> str:
        """Return the status of the history as display text, such as READING while versions are being read."""
        if self.error_text:
            return self.error_text
        if not self.rows:
            return "READING" if self.worker.is_busy else "NO VERSION OF THIS PROGRAM STORED YET"
        if self.text is None:
            return "COMPARING"
        return "" if self.changes else "IDENTICAL TO THE TEXT IN THE EDITOR"

    def _listed(self, rows: tuple[ProgramVersionRow, ...]) -> None:
        self.rows = rows
        self.mark(0)

    def _compared(self, answer: tuple[str, tuple[DifferenceRow, ...]]) -> None:
        self.text, self.changes = answer

    def _failed(self, why: str) -> None:
        self.error_text = why


def decode_text(data: bytes) -> str:
    """Decode the text of a version for display.

    Texts that are not UTF-8 are decoded as Latin-1.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.rstrip("\x1a").replace("\r\n", "\n").replace("\r", "\n")
