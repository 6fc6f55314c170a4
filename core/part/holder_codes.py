"""Tool holders: shank, boring bar and entering angle, from a size or from a holder's code.

``20x20``, ``3/4"`` and ``16mm`` are sizes of a shank; ``MCLNR 2020K12`` (ISO 5608) and ``MCLNR-124B``
(ANSI B212.5) are holders with a shank, ``S16R-SCLCR09`` (ISO 5609) and ``A10-SCLCR2`` boring bars.
Style letters and codes are as catalogues print them; reach and head are the usual ones and not those of
one maker: for less than a millimetre measure the holder and give its outline.
``0,4 18,4 18,60 0,60`` is an outline, mm: Z and X from the control point. All else is a name.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

MM_PER_INCH = 25.4

# Entering angles by the style letter, ISO 5608 clause 4.4; in a shank these of the second table face.
_TURNS: Mapping[str, float] = {
    **{"A": 90.0, "B": 75.0, "D": 45.0, "E": 60.0, "G": 90.0, "H": 107.5, "J": 93.0, "L": 95.0},
    **{"M": 50.0, "N": 63.0, "P": 117.5, "Q": 107.5, "R": 75.0, "S": 45.0, "T": 60.0, "V": 72.5},
}
_FACES: Mapping[str, float] = {"C": 90.0, "F": 91.0, "K": 75.0, "U": 93.0, "W": 60.0, "X": 120.0, "Y": 85.0}

# From the tip to the far side of the shank by its width, ISO 5608 (mm) and ANSI B212.5 (16ths of an inch).
_REACH = {8.0: 10.0, 10.0: 12.0, 12.0: 16.0, 16.0: 20.0, 20.0: 25.0, 25.0: 32.0, 32.0: 40.0, 40.0: 50.0}
_INCH_REACH = {6: 8, 8: 10, 10: 12, 12: 16, 16: 20, 20: 24, 24: 32}


@dataclass(frozen=True, slots=True)
class Holder:
    """What stands behind an insert, mm; 0: not said. A bar is round, a shank square or nearly so.

    ``reach`` goes from the tip to the far side of the shank. ``entry`` is the entering angle, degrees, and
    ``faces`` says that it is one against a feed towards the axis. ``outline`` replaces everything.
    """

    width: float = 0.0
    bar: float = 0.0
    reach: float = 0.0
    entry: float = 0.0
    faces: bool = False
    outline: tuple[tuple[float, float], ...] = ()


def holder_of(text: str) -> Holder | None:
    """The holder that a text describes; None where it is but a name, or empty."""
    words = text.strip()
    if points := outline_points(words):
        return Holder(outline=points)
    return _size(words.lower()) or _coded(words.upper())


def shank(width: float) -> Holder:
    """A standard shank of this width."""
    return Holder(width=width, reach=_reach(width))


_PAIR = r"[-+.\d]+,[-+.\d]+"


def outline_points(text: str) -> tuple[tuple[float, float], ...] | None:
    """Three points or more, ``z,x z,x z,x``; None for any other text."""
    if not re.fullmatch(rf"\s*{_PAIR}(?:\s+{_PAIR}){{2,}}\s*", text):
        return None
    try:
        return tuple((float(z), float(r)) for z, r in (pair.split(",") for pair in text.split()))
    except ValueError:
        return None


_NUMBER = r"(\d+\s*/\s*\d+|\d*\.?\d+)"
_SIZES = rf"{_NUMBER}(?:\s*x\s*{_NUMBER})?\s*(mm|in|inch|\"|)"


def _size(words: str) -> Holder | None:
    """``20x20``, ``3/4"``, ``.75 in``, ``16mm``; a fraction is inches, a bare number is none."""
    found = re.fullmatch(_SIZES, words)
    if not found:
        return None
    height, width, unit = found.groups()
    fraction = "/" in words
    if not (unit or width or fraction):
        return None
    inches = fraction or unit in {"in", "inch", '"'}
    figure = (width or height).replace(" ", "")
    if float(figure.partition("/")[2] or 1.0) == 0.0:
        return None
    above, _, under = figure.partition("/")
    wide = float(above) / float(under or 1.0) * (MM_PER_INCH if inches else 1.0)
    return shank(wide) if 0.0 < wide <= 100.0 else None


def _reach(width: float) -> float:
    sixteenths = round(width / MM_PER_INCH * 16.0, 6)
    if sixteenths in _INCH_REACH:
        return _INCH_REACH[int(sixteenths)] * MM_PER_INCH / 16.0
    return _REACH.get(round(width, 6), 1.25 * width)


# --- codes: clamping, insert shape, style, clearance, hand; then the shank and the size of the insert -------

_HEAD = r"[CDMPSWX][CDEKMPRSTVWHO]([A-Y])[A-Z][RLN]"
_ISO_SHANK = rf"{_HEAD}[\s-]*(\d\d)[\s-]*(\d\d)\s*[A-Z]?\s*(?:\d\d)?\b.*"
_INCH_SHANK = rf"{_HEAD}[\s-]*(\d\d)[\s-]*\d[A-Z]?\b.*"
_BAR = rf"[ACES](\d\d)[A-Z]?[\s-]*{_HEAD}[\s-]*(\d\d?)\b.*"


def _coded(words: str) -> Holder | None:
    if bar := re.fullmatch(_BAR, words):
        metric = len(bar[3]) == 2  # an ISO bar names the edge in mm, an inch bar the circle in eighths
        across = float(bar[1]) * (1.0 if metric else MM_PER_INCH / 16.0)
        return Holder(bar=across, entry={**_TURNS, **_FACES}.get(bar[2], 0.0))
    if found := re.fullmatch(_ISO_SHANK, words):
        return _styled(found[1], float(found[3]))
    if found := re.fullmatch(_INCH_SHANK, words):
        return _styled(found[1], _inch_width(found[2]))
    return None


def _styled(style: str, width: float) -> Holder:
    entry, faces = _TURNS.get(style, 0.0), style in _FACES
    neutral = style in "DENV"
    return Holder(
        width, 0.0, width / 2.0 if neutral else _reach(width), entry or _FACES.get(style, 0.0), faces
    )


def _inch_width(figures: str) -> float:
    """Square shanks are named in 16ths of an inch, others by width in 8ths and height in quarters."""
    if int(figures) in _INCH_REACH or figures in {"04", "05", "32"}:
        return int(figures) * MM_PER_INCH / 16.0
    return int(figures[0]) * MM_PER_INCH / 8.0
