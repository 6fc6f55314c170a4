"""Stored part settings of a program: stock, stick-out and silenced checks.

The settings are stored under the program's name. They are never written to the program text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from core.store.store_file import make_part_setting_key, make_stock_setting_key

ReadSetting = Callable[[str], object]


@dataclass(frozen=True, slots=True)
class StoredPart:
    """Stored part settings of one program.

    ``stock_text`` is the stock as entered, for example ``bar:1.0+.02``, or empty. ``stick_out_mm`` is in
    mm, or None if it was not entered. ``silenced_checks`` maps the name of each suppressed check to the
    operator's reason.
    """

    stock_text: str = ""
    stick_out_mm: float | None = None
    silenced_checks: Mapping[str, str] = field(default_factory=dict)

    def make_stored_settings(self, program: str) -> dict[str, object]:
        """Return the settings to store for a program, by setting name. The value None removes a setting."""
        rest: dict[str, object] = {"stick_out": self.stick_out_mm, "silenced": dict(self.silenced_checks)}
        said = {name: value for name, value in rest.items() if value}
        return {
            make_stock_setting_key(program): self.stock_text or None,
            make_part_setting_key(program): said or None,
        }


EMPTY_STORED_PART = StoredPart()


def load_stored_part(read_setting: ReadSetting, program: str) -> StoredPart:
    """Return the stored part settings of a program. Invalid stored values are ignored."""
    stock, rest = read_setting(make_stock_setting_key(program)), read_setting(make_part_setting_key(program))
    known = rest if isinstance(rest, dict) else {}
    out, silenced = known.get("stick_out"), known.get("silenced")
    return StoredPart(
        stock if isinstance(stock, str) else "",
        float(out) if isinstance(out, int | float) and not isinstance(out, bool) and out > 0.0 else None,
        {str(check): str(why) for check, why in silenced.items()} if isinstance(silenced, dict) else {},
    )


def make_stock_path_absolute(stock: str) -> str:
    """Return the stock specification with an absolute file path, so that it is valid in every folder."""
    kind, _, rest = stock.partition(":")
    return f"{kind}:{Path(rest).resolve()}" if kind in {"profile", "after"} else stock
