"""The lines of a bar loop: a stop that the bar follows, and the subroutine that is the part."""

from __future__ import annotations

from typing import NamedTuple

from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.number_words import plain
from core.language.source import Dialect


class Bars(NamedTuple):
    """``many`` parts of ``long``, fed by ``rate`` a minute to the tool ``stop``, which leaves ``stock``.

    ``each``: the bar is fed for each part, else once. ``part`` is the number of its subroutine.
    """

    many: int
    long: float
    each: bool
    stop: float
    stock: float
    rate: float
    part: int

    @property
    def out(self) -> float:
        """How far the bar comes out at a time."""
        return self.long if self.each else self.many * self.long


def write_bars(code: Code, bars: Bars) -> None:
    """In the language of the program."""
    (_sinumerik if code.setting.dialect is Dialect.SINUMERIK else _omniturn)(code, bars)


def _omniturn(code: Code, bars: Bars) -> None:
    """LS … LF. G97 changes nothing: it carries the comment, which has no place inside a loop."""
    call, loop = f"P{bars.part}", f"LS{bars.many}"
    code.write("G97", loop) if bars.each else code.write("G97")
    code.write(f"T{bars.stop:.0f}")
    _to_stop(code, bars)
    code.write("M13", f"G94F{plain(bars.rate)}{code.z(bars.stock)}", "M12")
    code.forget()
    code.away()
    if bars.each:
        code.write(call, "LF")
    else:
        code.write(loop, call, f"G10{code.point(0.0, -bars.long)}", "LF", "T0")


def _sinumerik(code: Code, bars: Bars) -> None:
    """REPEAT between two labels; a bar that was fed once is gone along by ATRANS."""
    opens, closes = code.setting.shop.chuck or (0, 0)
    begin, end = f"BAR_{bars.part}", f"BAR_{bars.part}_END"
    code.write(*([f"{begin}:"] if bars.each else []), f"T{bars.stop:.0f} D1", "M5")
    code.forget()
    _to_stop(code, bars)
    code.write(f"M{opens}", f"G94 G1 {code.z(bars.stock)} F{plain(bars.rate)}", f"M{closes}")
    code.forget()
    code.away()
    code.write(*([] if bars.each else [f"{begin}:"]), f"PART_{bars.part}")
    if not bars.each:
        code.write(" ".join(("ATRANS", code.z(-bars.long))))
    code.write(f"{end}:")
    if bars.many > 1:
        code.write(" ".join(("REPEAT", begin, end, f"P={bars.many - 1}")))
    if not bars.each:
        code.write("TRANS")


def _to_stop(code: Code, bars: Bars) -> None:
    """The stop to the end of the bar."""
    code.rapid(0.0, code.setting.clear)
    code.rapid(z=bars.stock - bars.out)
