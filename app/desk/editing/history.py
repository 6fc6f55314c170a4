"""The versions of the program that is edited, and what each would change."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.editing.bench import Archive
from app.desk.editing.differences import Row, differences
from app.desk.editing.worker import Worker
from core.store.rows import VersionRow


@dataclass(slots=True)
class History:
    """``rows`` are the versions, newest first; ``changes`` leads from the marked one to the text on hand."""

    archive: Archive
    worker: Worker
    name: str = ""
    now: str = ""
    rows: tuple[VersionRow, ...] = ()
    marked: int = 0
    text: str | None = None  # of the marked version, once it is read
    changes: tuple[Row, ...] = ()
    trouble: str = ""
    _asked: int = 0

    def look(self, name: str, now: str) -> None:
        """Open the history of a program; ``now`` is the text in the editor."""
        self.name, self.now = name, now
        self.rows, self.marked, self.text, self.changes, self.trouble = (), 0, None, (), ""
        self.worker.ask(lambda: tuple(self.archive.versions(name)), self._listed, self._failed)

    def mark(self, place: int) -> None:
        """Mark another version and compare it."""
        if not self.rows:
            return
        self.marked = max(0, min(len(self.rows) - 1, place))
        self.text, self.changes, self.trouble = None, (), ""
        self._asked += 1
        asked, name, now = self._asked, self.name, self.now
        number = self.rows[self.marked].number

        def compare() -> tuple[int, str, tuple[Row, ...]]:
            text = _lines(self.archive.text_of(name, number))
            return asked, text, differences(text, now)

        self.worker.ask(compare, self._compared, self._failed)

    @property
    def number(self) -> int:
        """The number of the marked version, 0: there is none."""
        return self.rows[self.marked].number if self.rows else 0

    def words(self) -> str:
        """What is to be said of the marked version."""
        if self.trouble:
            return self.trouble
        if not self.rows:
            return "READING" if self.worker.busy else "NO VERSION IS KEPT OF THIS PROGRAM YET"
        if self.text is None:
            return "COMPARING"
        return "" if self.changes else "THE SAME AS IN THE EDITOR"

    def _listed(self, rows: tuple[VersionRow, ...]) -> None:
        self.rows = rows
        self.mark(0)

    def _compared(self, answer: tuple[int, str, tuple[Row, ...]]) -> None:
        asked, text, changes = answer
        if asked == self._asked:
            self.text, self.changes = text, changes

    def _failed(self, why: str) -> None:
        self.trouble = why


def _lines(data: bytes) -> str:
    """A version's text as an editor shows it; bytes of old codes stay apart from each other."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.rstrip("\x1a").replace("\r\n", "\n").replace("\r", "\n")
