"""Thread series by name: diameter and pitch of UNC, UNF, UNEF, M, MF, NPT, BSP, BSPT and ACME.

Inch series are in inches, the others in mm: each as its standard gives it. ASME B1.1, B1.20.1 and B1.5,
ISO 261, ISO 228-1 and ISO 7-1.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction


class Series(StrEnum):
    """The standard series, and one that is said by its figures."""

    UNC = "UNC"
    UNF = "UNF"
    UNEF = "UNEF"
    M = "M"
    MF = "MF"
    NPT = "NPT"
    BSP = "BSP"
    BSPT = "BSPT"
    ACME = "ACME"
    OWN = "OWN"


METRIC = frozenset({Series.M, Series.MF, Series.BSP, Series.BSPT})
UNIFIED = frozenset({Series.UNC, Series.UNF, Series.UNEF})
TAPERED = frozenset({Series.NPT, Series.BSPT})


@dataclass(frozen=True, slots=True)
class ThreadSize:
    """``diameter`` is the basic major one; of a pipe thread that of the pipe (NPT) or at the gauge plane.

    ``gauge``: of a tapered one how far the gauge plane lies from the small end. Unit: that of the series.
    """

    name: str
    diameter: float
    pitch: float
    gauge: float = 0.0


def _fraction(name: str) -> float:
    return float(sum(Fraction(part) for part in name.split("-")))


def _unified(listed: str) -> tuple[ThreadSize, ...]:
    found = []
    for each in listed.split():
        name, _, turns = each.rpartition(":")
        number = name.startswith("#")
        diameter = 0.060 + 0.013 * int(name[1:]) if number else _fraction(name)
        found.append(ThreadSize(name, round(diameter, 6), 1.0 / float(turns)))
    return tuple(found)


def _metric(listed: str, *, fine: bool) -> tuple[ThreadSize, ...]:
    found = []
    for each in listed.split():
        across, _, pitch = each.partition("x")
        name = f"M{across}X{pitch}" if fine else f"M{across}"
        found.append(ThreadSize(name, float(across), float(pitch)))
    return tuple(found)


def _listed(unit: float, listed: str) -> tuple[ThreadSize, ...]:
    """Name, diameter, turns an inch and, of tapered ones, the gauge length; ``unit`` of an inch."""
    found = []
    for each in listed.split():
        name, diameter, turns, *gauge = each.split(":")
        found.append(
            ThreadSize(name, float(diameter), unit / float(turns), float(gauge[0]) if gauge else 0.0)
        )
    return tuple(found)


SIZES: dict[Series, tuple[ThreadSize, ...]] = {
    Series.UNC: _unified(
        "#1:64 #2:56 #3:48 #4:40 #5:40 #6:32 #8:32 #10:24 #12:24 1/4:20 5/16:18 3/8:16 7/16:14 1/2:13 "
        "9/16:12 5/8:11 3/4:10 7/8:9 1:8 1-1/8:7 1-1/4:7 1-3/8:6 1-1/2:6 1-3/4:5 2:4.5"
    ),
    Series.UNF: _unified(
        "#0:80 #1:72 #2:64 #3:56 #4:48 #5:44 #6:40 #8:36 #10:32 #12:28 1/4:28 5/16:24 3/8:24 7/16:20 "
        "1/2:20 9/16:18 5/8:18 3/4:16 7/8:14 1:12 1-1/8:12 1-1/4:12 1-3/8:12 1-1/2:12"
    ),
    Series.UNEF: _unified(
        "#12:32 1/4:32 5/16:32 3/8:32 7/16:28 1/2:28 9/16:24 5/8:24 11/16:24 3/4:20 13/16:20 7/8:20 "
        "15/16:20 1:20 1-1/16:18 1-1/8:18 1-1/4:18 1-3/8:18 1-1/2:18"
    ),
    Series.M: _metric(
        "1.6x0.35 2x0.4 2.5x0.45 3x0.5 3.5x0.6 4x0.7 5x0.8 6x1 7x1 8x1.25 10x1.5 12x1.75 14x2 16x2 18x2.5 "
        "20x2.5 22x2.5 24x3 27x3 30x3.5 33x3.5 36x4 39x4 42x4.5 48x5",
        fine=False,
    ),
    Series.MF: _metric(
        "4x0.5 5x0.5 6x0.75 8x0.75 8x1 10x0.75 10x1 10x1.25 12x1 12x1.25 12x1.5 14x1 14x1.5 16x1 16x1.5 "
        "18x1 18x1.5 20x1 20x1.5 20x2 22x1.5 24x1 24x1.5 24x2 27x1.5 27x2 30x1.5 30x2 33x2 36x1.5 36x3 "
        "39x3 42x2 42x3 48x2 48x3",
        fine=True,
    ),
    Series.NPT: _listed(
        1.0,
        "1/16:0.3125:27:0.160 1/8:0.405:27:0.1615 1/4:0.540:18:0.2278 3/8:0.675:18:0.240 "
        "1/2:0.840:14:0.320 3/4:1.050:14:0.339 1:1.315:11.5:0.400 1-1/4:1.660:11.5:0.420 "
        "1-1/2:1.900:11.5:0.420 2:2.375:11.5:0.436",
    ),
    Series.BSP: _listed(
        25.4,
        "1/16:7.723:28 1/8:9.728:28 1/4:13.157:19 3/8:16.662:19 1/2:20.955:14 5/8:22.911:14 3/4:26.441:14 "
        "7/8:30.201:14 1:33.249:11 1-1/8:37.897:11 1-1/4:41.910:11 1-1/2:47.803:11 1-3/4:53.746:11 "
        "2:59.614:11",
    ),
    Series.BSPT: _listed(
        25.4,
        "1/16:7.723:28:4.0 1/8:9.728:28:4.0 1/4:13.157:19:6.0 3/8:16.662:19:6.4 1/2:20.955:14:8.2 "
        "3/4:26.441:14:9.5 1:33.249:11:10.4 1-1/4:41.910:11:12.7 1-1/2:47.803:11:12.7 2:59.614:11:15.9",
    ),
    Series.ACME: _listed(
        1.0,
        "1/4:0.25:16 5/16:0.3125:14 3/8:0.375:12 7/16:0.4375:12 1/2:0.5:10 5/8:0.625:8 3/4:0.75:6 "
        "7/8:0.875:6 1:1:5 1-1/8:1.125:5 1-1/4:1.25:5 1-3/8:1.375:4 1-1/2:1.5:4 1-3/4:1.75:4 2:2:4",
    ),
}
"""From small to large."""


def size_of(series: Series, name: str) -> ThreadSize | None:
    """The size of this name: 1/2, 1/2-13, #10, M10X1.25; also 10 and 10-32, 10X1.25. None: it has none.

    1 is the inch, #1 the number.
    """
    wanted = name.strip().upper().replace(" ", "")
    sizes = SIZES.get(series, ())
    for bare in ("", "#", "M"):
        for each in sizes:
            if wanted in {known.removeprefix(bare) for known in _names(series, each)}:
                return each
    return None


def _names(series: Series, size: ThreadSize) -> tuple[str, ...]:
    """With and without its pitch."""
    if series in {Series.M, Series.MF}:
        return size.name, f"{size.name.partition('X')[0]}X{size.pitch:g}"
    turns = (25.4 if series in METRIC else 1.0) / size.pitch
    return size.name, f"{size.name}-{round(turns, 2):g}"
