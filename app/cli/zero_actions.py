"""What ``turndesk offsets`` does with G54 to G59: mm and degrees, X a radius, as the store keeps them."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping

from app.cli.errors import EXIT_OK, CommandError
from app.cli.opened_store import opened_store
from app.cli.toml_file import unknown
from app.desk.arithmetic import EntryError, value_of
from core.store.zero import CODES, FIELDS, ZeroRow

_CODE = re.compile(r"G0*(\d{1,4})", re.IGNORECASE)


def code_of(name: str) -> int | None:
    """The code that a name means; None where it names no settable offset at all.

    Raises CommandError for one that does not exist.
    """
    match = _CODE.fullmatch(name)
    if match is None:
        return None
    if int(match[1]) not in CODES:
        raise CommandError(f"{name} is no settable offset; name G54…G59")
    return int(match[1])


def set_zero(code: int, entries: list[str], why: str) -> int:
    """Set what entries such as ``z=-120`` say; the rest stays."""
    values = _values(entries)
    with opened_store() as store:
        row = store.set_zero(code, why, values, who="command line").result()
    sys.stdout.write(f"{line(code, row)}\n")
    return EXIT_OK


def line(code: int, row: ZeroRow) -> str:
    """One offset for a person to read."""
    return f"G{code} X {row.x:+.3f}  Z {row.z:+.3f} mm  C {row.c:+.3f}°"


def as_json(rows: Mapping[int, ZeroRow]) -> dict[int, dict[str, float]]:
    """All of them, by code."""
    return {code: row._asdict() for code, row in rows.items()}


def _values(entries: list[str]) -> dict[str, float]:
    values: dict[str, float] = {}
    for entry in entries:
        key, equals, text = entry.partition("=")
        key = key.strip().lower()
        if not equals:
            raise CommandError(f"{entry} sets nothing; write KEY=VALUE, such as z=-120")
        if key not in FIELDS:
            raise CommandError(unknown(key, FIELDS))
        if key in values:
            raise CommandError(f"{key} is given twice; give it once")
        try:
            values[key] = value_of(text)
        except EntryError as error:
            raise CommandError(f"{key}: {error}") from error
    return values
