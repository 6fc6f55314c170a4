"""The file of ``--report``: written aside while programs are proved, in place when all are."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from app.desk.command_errors import CommandError

if TYPE_CHECKING:
    from app.cli.proof_work import Proof

_ENDINGS = {".html", ".htm"}


class ReportFile:
    """A report as it is written, a program after the other. Raises CommandError when the disk refuses."""

    def __init__(self, path: Path, file: TextIO) -> None:
        self._path, self._file = path, file

    def begin(self) -> None:
        """Date, and what it is."""
        from app.report.report_page import page_head

        self._write(page_head("Proof", time.strftime("%Y-%m-%d %H:%M %z")))

    def add(self, path: Path, proof: Proof) -> None:
        """The section of the next program."""
        from app.report.report_page import not_proved, program_part

        self._write(program_part(str(path), proof.section or not_proved(proof.fault)))

    def end(self, aside: Path) -> None:
        """The page is whole, and takes its place."""
        from app.report.report_page import PAGE_END

        self._write(PAGE_END)
        try:
            self._file.flush()
            os.fsync(self._file.fileno())  # a full disk is told here, before the old report goes
            self._file.close()
            aside.replace(self._path)
        except OSError as error:
            raise _unwritable(self._path, error) from error

    def _write(self, text: str) -> None:
        try:
            self._file.write(text)
        except OSError as error:
            raise _unwritable(self._path, error) from error


@contextlib.contextmanager
def report_file(name: str | None) -> Iterator[ReportFile | None]:
    """The report of this name, None without one. What is refused is refused before anything is proved."""
    if name is None:
        yield None
        return
    path = Path(name)
    if path.suffix.lower() not in _ENDINGS:
        raise CommandError(f"--report {path}: reports are HTML files; name it {path.stem}.html")
    if path.is_dir():
        raise CommandError(f"--report {path} is a folder; name a file")
    aside = path.with_name(f".{path.name}.part")
    try:
        file = aside.open("w", encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        report = ReportFile(path, file)
        report.begin()
        yield report
        report.end(aside)
    finally:
        with contextlib.suppress(OSError):  # what could not be written before cannot be flushed now either
            file.close()
        aside.unlink(missing_ok=True)


def _unwritable(path: Path, error: OSError) -> CommandError:
    return CommandError(
        f"--report {path} cannot be written ({error.strerror}); check folder, rights and disk"
    )
