"""Report file of ``--report`` in HTML or PDF.

The file has a temporary name until all programs are proved.
"""

from __future__ import annotations

import argparse
import contextlib
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from app.desk.command_errors import CommandError
from core.file_replacement import replace_atomically
from core.message import Message

if TYPE_CHECKING:
    from app.cli.proofs.proof_work import Proof

_TITLE = "Proof"
_HTML, _PDF = {".html", ".htm"}, {".pdf"}


class _ReportPages(Protocol):
    """Interface of a writer that adds one program after another to a report.

    All methods may raise OSError.
    """

    def add_page(self, name: str, html: str, /) -> None:
        """Add the HTML of the next program under its name."""

    def finish_file(self) -> None:
        """Write the complete file to the disk.

        A full disk is thus detected while the old report still exists.
        """

    def close(self) -> None:
        """Close the file, even if the report is incomplete."""


class _HtmlPages:
    """Writer of a report as one HTML page."""

    def __init__(self, path: Path) -> None:
        from app.desk.translation import ENGLISH_CODE
        from app.report.html_tables import make_page_head

        self._file = path.open("w", encoding="utf-8", errors="backslashreplace")
        self._file.write(make_page_head(_TITLE, _now(), ENGLISH_CODE))

    def add_page(self, _name: str, html: str) -> None:
        self._file.write(html)

    def finish_file(self) -> None:
        from app.report.html_tables import HTML_END

        self._file.write(HTML_END)
        self._file.flush()

    def close(self) -> None:
        self._file.close()


class _PdfPages:
    """Writer of a report as numbered PDF pages. Each program starts on a new page."""

    def __init__(self, path: Path, paper: str | None) -> None:
        from app.report.html_tables import make_headline
        from app.report.pdf_file import PaperSize
        from app.screen.pdf_pages import PdfWriter, find_default_paper_size

        self._head = make_headline(_TITLE, _now())
        self._pages = PdfWriter(
            path, _TITLE, PaperSize(paper) if paper is not None else find_default_paper_size()
        )

    def add_page(self, name: str, html: str) -> None:
        self._pages.add_pages(self._head + html, name)
        self._head = ""

    def finish_file(self) -> None:
        self._pages.close()

    def close(self) -> None:
        self._pages.discard_file()


class ReportFile:
    """A report in progress, to which programs are added one at a time.

    Methods raise CommandError for disk errors.
    """

    def __init__(self, path: Path, pages: _ReportPages) -> None:
        self._path, self._pages = path, pages

    def add_proof(self, path: Path, proof: Proof) -> None:
        """Add the report section of the next program."""
        from app.report.report_page import make_program_section, make_unproved_section

        part = make_program_section(
            str(path), proof.report_section or make_unproved_section(proof.failure_reason)
        )
        try:
            self._pages.add_page(path.name, part)
        except OSError as error:
            raise _unwritable(self._path, error) from error

    def finish_report(self, temporary_path: Path) -> None:
        """Finish the report and move its temporary file to its final path."""
        try:
            self._pages.finish_file()
            self._pages.close()
            replace_atomically(temporary_path, self._path)
        except OSError as error:
            raise _unwritable(self._path, error) from error


@contextlib.contextmanager
def open_report(args: argparse.Namespace) -> Iterator[ReportFile | None]:
    """Yield the report file of --report, or None if the option is not used.

    Invalid options raise CommandError before a program is proved.
    """
    if args.report is None:
        if args.paper is not None:
            raise CommandError("--paper is only for --report FILE.pdf", "paper-is-for-pdf")
        yield None
        return
    path = _report_path(args)
    aside = path.with_name(f".{path.name}.part")
    try:
        pages = _pages(aside, path.suffix.lower(), args.paper)
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        report = ReportFile(path, pages)
        yield report
        report.finish_report(aside)
    finally:
        with contextlib.suppress(OSError):  # data that could not be written cannot be flushed either
            pages.close()
        aside.unlink(missing_ok=True)


def _report_path(args: argparse.Namespace) -> Path:
    """Return the path of the report.

    Raises CommandError if its suffix is not supported, if --paper is used for an HTML report, or if the
    path is a folder.
    """
    path = Path(args.report)
    ending = path.suffix.lower()
    if ending not in _HTML | _PDF:
        remedy = Message("name the report {stem}.html or {stem2}.pdf", stem=path.stem, stem2=path.stem)
        raise CommandError(
            Message(
                "--report {path}: a report must be an HTML or PDF file; {details}", path=path, details=remedy
            ),
            "report-ending",
        )
    if args.paper is not None and ending not in _PDF:
        raise CommandError(
            Message(
                "--paper is only for PDF; for {path}, select the paper size when you print from the browser",
                path=path.name,
            ),
            "paper-is-for-pdf",
        )
    if path.is_dir():
        raise CommandError(
            Message("--report {path} is a folder; specify a file name", path=path), "report-is-folder"
        )
    return path


def _pages(path: Path, ending: str, paper: str | None) -> _ReportPages:
    return _PdfPages(path, paper) if ending in _PDF else _HtmlPages(path)


def _now() -> str:
    return time.strftime("%Y-%m-%d %H:%M %z")


def _unwritable(path: Path, error: OSError) -> CommandError:
    return CommandError(
        Message(
            "--report {path} cannot be written ({cause}); check the folder, its permissions and the disk",
            path=path,
            cause=error.strerror,
        ),
        "cannot-write",
    )
