"""Numbers as words of a program, and as words of a comment, which has letters and digits only."""

from __future__ import annotations

import math
import re

_STEPS = {False: 0.00005, True: 0.0005}  # by metric: what a word is rounded to; a diameter twice of it
_NUMBER = re.compile(r"(M?)(\d+)(?:P(\d+))?(?:MM)?")
_NO_ZERO = re.compile(r"(?<![\d.])\.(?=\d)")
_NAME = str.maketrans({"/": "S", "-": "A", ".": "P", "#": "N"})
_BACK = str.maketrans({"S": "/", "A": "-", "P": ".", "N": "#"})


def plain(value: float, places: int = 5) -> str:
    """``value`` as programs have it: no zero before the point nor behind it: .5, -.035, 2."""
    text = f"{value:.{places}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    if text in {"-0", "-", ""}:
        return "0"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def figure(value: float, places: int = 5) -> str:
    """``value`` as SINUMERIK programs have it: 0.5, -0.035, 2."""
    return with_zero(plain(value, places))


def with_zero(word: str) -> str:
    """A word of ``plain`` with the zero before its point."""
    return _NO_ZERO.sub("0.", word)


def rounded(value: float, *, metric: bool, twice: bool = False) -> float:
    """A length on the step of the control; ``twice``: on that of a diameter."""
    step = _STEPS[metric] * (2.0 if twice else 1.0)
    return round(value / step) * step


def rounded_up(radius: float, *, metric: bool) -> float:
    """A depth on the step of the control or above it: in passes of equal chip a hair less is a pass more."""
    step = _STEPS[metric]
    return math.ceil(radius / step - 1e-6) * step


def in_comment(value: float, places: int = 5) -> str:
    """A number of a comment: P stands for the point, a leading M for minus: 0P5, M0P035."""
    text = f"{abs(value):.{places}f}".rstrip("0").rstrip(".")
    sign = "M" if value < 0 and text.strip("0.") else ""
    return sign + text.replace(".", "P")


def from_comment(text: str) -> float | None:
    """The number of ``in_comment``; None where it is none."""
    found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    value = float(f"{found[2]}.{found[3] or 0}")
    return -value if found[1] else value


def name_in_comment(name: str) -> str:
    """The name of a size in letters and digits: 1/2 is 1S2, 1-1/8 is 1A1S8, M10X1.25 is M10X1P25."""
    return name.translate(_NAME)


def name_from_comment(text: str) -> str:
    """The name that was written so."""
    return text.translate(_BACK)
