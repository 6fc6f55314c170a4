"""Lines and name of what has come, as tapes and controls write them."""

from __future__ import annotations

import re

_LINE_ENDS = re.compile(rb"[\r\n]+")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,39}")


def lines_of(text: bytes) -> list[bytes]:
    """Lines ended by LF, CR LF, CR or, as on tapes, LF CR CR; empty ones between stay."""
    lines: list[bytes] = []
    at = 0
    for ends in _LINE_ENDS.finditer(text):
        count = ends[0].count(b"\n") or ends[0].count(b"\r")
        lines += [text[at : ends.start()], *[b""] * (count - 1)]
        at = ends.end()
    return [*lines, text[at:]] if text[at:].strip() else lines


def name_of(head: bytes, lines: list[bytes]) -> str:
    """As written behind the first %, else the O number of the first line that has words."""
    said = head.decode("ascii", "replace").strip().strip("()").strip()
    header = re.fullmatch(r"_N_(.+)_(MPF|SPF)", said, re.IGNORECASE)
    if header is not None:
        said = f"{header[1]}.{header[2].lower()}"
    if _NAME.fullmatch(said):
        return said
    first = next((line for line in lines if line.strip()), b"").decode("ascii", "replace")
    number = re.match(r"\s*[O:](\d{1,8})\b", first, re.IGNORECASE)
    return f"O{number[1]}" if number else ""
