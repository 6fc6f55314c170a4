"""Removal of private texts from programs, machine files and logs."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Collection, Iterator

from app.cli.bug_report.replaced_names import PrivateValueReplacer
from core.message import Message

_COMMENTS = re.compile(
    r"(?:\([^()\n]*\)?|;[^\n]*|\"[^\"\n]*\"?)"
    r"|(?m:^(?P<name>\s*(?:\d+\s+)?(?:BEGIN PGM|END PGM|CALL PGM|\*\s*-|%)\s*))"
    r"[^\n]*?(?=(?:\s+(?:MM|INCH))?\s*$)",
    re.IGNORECASE | re.MULTILINE,
)
"""Pattern of comments, strings, structure lines and program names in the three program languages."""
_STRING = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'')
_TABLE = re.compile(r"^\s*\[\[?\s*([\w.\"'-]+)")
_TERMINAL = re.compile(r"[A-Za-z_:-]{0,8}\d[\w.:-]{0,8}")
_NETWORK = ("sharing", "announce", "status_page", "mtconnect", "office", "http", "mqtt")
"""Machine file tables in which any string can name a computer, a person or a folder."""


def mask_program_texts(text: str) -> str:
    """Return the program with each letter of its comments, strings and names replaced by ``x``.

    The length and position of each text do not change.
    """

    def mask_match(found: re.Match[str]) -> str:
        start = found["name"] or ""
        return start + re.sub(r"\w", "x", found[0][len(start) :])

    return _COMMENTS.sub(mask_match, text)


def mask_machine_file(text: str, public_strings: Collection[str], replacer: PrivateValueReplacer) -> str:
    """Return the text of a machine file without comments and private strings.

    ``public_strings`` are the strings of the shipped machine files, and these strings are retained. Outside
    the network tables, strings with the form of a terminal name are also retained. The text does not need
    to be valid TOML.
    """
    lines, table = [], ""
    for line in text.splitlines():
        if found := _TABLE.match(line):
            table = found[1].strip("\"'")
        is_network = table.partition(".")[0] in _NETWORK

        def replaced(match: re.Match[str], is_network: bool = is_network) -> str:
            value = match[0][1:-1]
            if value in public_strings or (not is_network and _TERMINAL.fullmatch(value)):
                return match[0]
            return f'"{replacer.get_placeholder("TEXT", value)}"'

        lines.append("".join(_parts(line, replaced)))
    return "\n".join(lines)


def _parts(line: str, replaced: Callable[[re.Match[str]], str]) -> Iterator[str]:
    """Yield the segments of a line up to its comment.

    Each string is replaced by the result of ``replaced``.
    """
    end = 0
    while True:
        string, comment = _STRING.search(line, end), line.find("#", end)
        if comment >= 0 and (string is None or comment < string.start()):
            yield line[end:comment].rstrip()
            return
        if string is None:
            rest = line[end:]
            open_mark = min((at for mark in "\"'" if (at := rest.find(mark)) >= 0), default=-1)
            yield rest if open_mark < 0 else rest[:open_mark] + '"TEXT'
            return
        yield line[end : string.start()]
        yield replaced(string)
        end = string.end()


def remove_scope_record_name(log_line: str) -> str:
    """Return a line of a program run's event log without the name of its scope recording."""
    try:
        event = json.loads(log_line)
        event.pop("record", None)
    except (ValueError, AttributeError, TypeError):
        return log_line
    return json.dumps(event, ensure_ascii=False)


def format_message_without_names(text: str) -> str:
    """Return a message as its template and its numeric values, without names.

    A message that is a plain string is returned unchanged.
    """
    if not isinstance(text, Message):
        return text
    numbers = {name: each for name, each in text.values.items() if isinstance(each, int | float)}
    return f"{text.template} {numbers}" if numbers else text.template
