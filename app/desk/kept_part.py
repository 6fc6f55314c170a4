"""What the store keeps about the part of a program: its stock, stick-out, silenced checks; by its name.

None of it is ever written into the program's text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from core.store.store_file import part_key, stock_key

Setting = Callable[[str], object]


@dataclass(frozen=True, slots=True)
class KeptPart:
    """``stock`` as it was said (``bar:1.0+.02``), empty: not said. ``stick_out`` mm, None: not said.

    ``silenced`` are checks of the part, and why.
    """

    stock: str = ""
    stick_out: float | None = None
    silenced: Mapping[str, str] = field(default_factory=dict)

    def settings(self, program: str) -> dict[str, object]:
        """What is stored, by the name of the setting; None: nothing."""
        rest: dict[str, object] = {"stick_out": self.stick_out, "silenced": dict(self.silenced)}
        said = {name: value for name, value in rest.items() if value}
        return {stock_key(program): self.stock or None, part_key(program): said or None}


NOTHING_KEPT = KeptPart()


def kept_part(setting: Setting, program: str) -> KeptPart:
    """What is kept with a program; what nobody could have stored counts as not there."""
    stock, rest = setting(stock_key(program)), setting(part_key(program))
    known = rest if isinstance(rest, dict) else {}
    out, silenced = known.get("stick_out"), known.get("silenced")
    return KeptPart(
        stock if isinstance(stock, str) else "",
        float(out) if isinstance(out, int | float) and not isinstance(out, bool) and out > 0.0 else None,
        {str(check): str(why) for check, why in silenced.items()} if isinstance(silenced, dict) else {},
    )


def lasting(stock: str) -> str:
    """What is said of a stock, the same from every folder: a file by its whole path."""
    kind, _, rest = stock.partition(":")
    return f"{kind}:{Path(rest).resolve()}" if kind in {"profile", "after"} else stock
