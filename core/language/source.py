"""Program text, with its name, its dialect and its lines, which count from 1."""

from __future__ import annotations

import codecs
import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from pathlib import Path, PurePath

from core.input_file import TooLargeError, read_input_bytes
from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.message import CodedError, Message


class Dialect(StrEnum):
    """Dialect of a program; the enum values are used on the command line and in the JSON output."""

    OMNITURN = "omniturn"
    KLARTEXT = "klartext"
    SINUMERIK = "sinumerik"


_DIALECT_BY_EXTENSION = {".h": Dialect.KLARTEXT, ".mpf": Dialect.SINUMERIK, ".spf": Dialect.SINUMERIK}


_USUAL_ENDINGS = {Dialect.OMNITURN: ".nc", Dialect.KLARTEXT: ".h", Dialect.SINUMERIK: ".mpf"}


def get_default_extension(dialect: Dialect) -> str:
    """Return the default file extension of a dialect, such as ``.nc``."""
    return _USUAL_ENDINGS[dialect]


def guess_dialect(name: str) -> Dialect:
    """Return the default dialect for the extension of a file name."""
    return _DIALECT_BY_EXTENSION.get(PurePath(name).suffix.lower(), Dialect.OMNITURN)


# Form feeds and Unicode line separators do not end a line, so that line numbers match those of an editor.
_LINE_END = re.compile(r"\r\n|\r|\n")
_MAX_LINE_LENGTH = 8192
_LONG = 4 * 1024 * 1024  # characters; the lines of longer texts are not stored
MAX_FILE_BYTES = 64 * 1024 * 1024
_DOS_END_OF_FILE = "\x1a"
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


@dataclass(frozen=True)
class ProgramSource:
    """The text of a program.

    ``name`` is used in messages and on the screen. ``specified_dialect`` is the dialect if it is specified,
    or None. ``subprograms`` contains the called files, which are read together with the program, so that
    the executed text is the proved text.
    """

    name: str
    text: str
    specified_dialect: Dialect | None = None
    subprograms: tuple[ProgramSource, ...] = ()

    def __reduce__(self) -> tuple[object, ...]:
        """Return the pickle data without the lines. The receiving process splits the text again."""
        return ProgramSource, (self.name, self.text, self.specified_dialect, self.subprograms)

    @property
    def dialect(self) -> Dialect:
        """Return the dialect of the program."""
        return self.specified_dialect or guess_dialect(self.name)

    @cached_property
    def lines(self) -> Sequence[str]:
        """Return the lines without line ends; an empty line after the final line end is omitted."""
        if len(self.text) >= _LONG and self.text.isascii() and "\r" not in self.text:
            from core.language.long_lines import LazyLines  # noqa: PLC0415  with numpy

            return LazyLines(self.text)
        lines = _lines(self.text)
        if not lines[-1]:
            lines.pop()
        return tuple(lines)


class SourceError(CodedError):
    """Error for a file that is not a readable program text.

    ``str()`` returns the message for the operator.
    """

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message, diagnostic.code)
        self.diagnostic = diagnostic


def load_source(path: Path, specified_dialect: Dialect | None = None) -> ProgramSource:
    """Read a program file in UTF-8 or in an 8-bit character set of DOS or Windows.

    Raises SourceError if the file cannot be read, is larger than 64 MB, is empty, has a line of more than
    8192 characters, or is not text. A UTF-16 file is also rejected.
    """
    try:
        data = read_input_bytes(path, MAX_FILE_BYTES)
    except TooLargeError as problem:
        raise _too_large(path.name) from problem
    except OSError as problem:
        reason = problem.strerror or "read error"
        raise _refused(
            "file-unreadable",
            Message("{path} cannot be read: {cause}.", path=path.name, cause=reason),
            "Check the file name and the disk.",
        ) from problem
    return decode_source(path.name, data, specified_dialect)


def decode_source(name: str, data: bytes, specified_dialect: Dialect | None = None) -> ProgramSource:
    """Decode the bytes of a program file and return its source.

    Raises SourceError if the bytes are more than 64 MB, are empty, are UTF-16, contain a line of more than
    8192 characters, or are not text.
    """
    if len(data) > MAX_FILE_BYTES:
        raise _too_large(name)
    return ProgramSource(name, _decoded(name, data), specified_dialect)


def _decoded(name: str, data: bytes) -> str:
    if data.startswith(_UTF_16):
        raise _refused(
            "file-utf16",
            Message("{name} is stored as UTF-16.", name=name),
            "Save the file as UTF-8 or plain text.",
        )
    if b"\0" in data:
        raise _refused(
            "file-binary",
            Message("{name} contains NUL bytes, so it is not a text file.", name=name),
            "Choose a text file.",
        )
    text = _characters(data.removeprefix(codecs.BOM_UTF8)).rstrip(_DOS_END_OF_FILE)
    if not text or text.isspace():
        raise _refused(
            "file-empty", Message("{name} is empty.", name=name), "Choose a file that contains a program."
        )
    _check_line_lengths(name, text)
    return text


def _characters(data: bytes) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        # In DOS code page 437, 80…9F are letters. In Latin-1, they are unprintable control characters.
        dos = any(0x80 <= byte <= 0x9F for byte in data)
        return data.decode("cp437" if dos else "latin-1")


def _lines(text: str) -> list[str]:
    """Return the lines without line ends, with an empty last line if the text ends with a line end."""
    return _LINE_END.split(text) if "\r" in text else text.split("\n")


def _check_line_lengths(name: str, text: str) -> None:
    if not _may_contain_long_line(text):
        return
    for number, line in enumerate(_lines(text), start=1):
        if len(line) > _MAX_LINE_LENGTH:
            raise _refused(
                "line-too-long",
                Message(
                    "Line {number} of {name} has {line_count} characters; the maximum is {longest_line}.",
                    number=number,
                    name=name,
                    line_count=len(line),
                    longest_line=_MAX_LINE_LENGTH,
                ),
                "Choose a program file with line breaks.",
                number,
            )


def _may_contain_long_line(text: str) -> bool:
    """Return whether a line may be too long.

    The function checks only whether every section of the maximum length contains a line end.
    """
    at = 0
    while len(text) - at > _MAX_LINE_LENGTH:
        end = text.rfind("\n", at, at + _MAX_LINE_LENGTH + 1)
        if end < 0:
            return True
        at = end + 1
    return False


def _too_large(name: str) -> SourceError:
    return _refused(
        "file-too-large", Message("{name} is larger than 64 MB.", name=name), "Split the program."
    )


def _refused(code: str, message: str, hint: str, line: int = 0) -> SourceError:
    return SourceError(make_error_diagnostic(line, 0, code, message, hint))
