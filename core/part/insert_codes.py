"""Codes of indexable inserts (ISO 1832, ANSI B212.4) and of tool holders, and their dimensions.

``CNMG 120408`` and ``CNMG432`` are the same insert: an 80° rhombus without clearance, with an inscribed
circle of 12.7 mm, a thickness of 4.76 mm and a nose radius of 0.8 mm (1/32 in). The tables follow ISO 1832
(shape, clearance, tolerance, type, size, thickness, corner) and ANSI B212.4 (sizes in fractions of an
inch). They were compared with the catalogs of Mitsubishi, Widia, Palbit and Denitool.

Holder texts:

- ``20x20``, ``3/4"`` and ``16mm`` are sizes of a standard shank.
- ``MCLNR 2020K12`` (ISO 5608) and ``MCLNR-124B`` (ANSI B212.5) are holders with a shank.
- ``S16R-SCLCR09`` (ISO 5609) and ``A10-SCLCR2`` are boring bars.
- ``0,4 18,4 18,60 0,60`` is an outline in mm, with Z and X from the control point.

Any other text is treated as a name. The reach and the head are typical values, not those of one
manufacturer. If they must be exact within 1 mm, measure the holder and specify its outline.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from math import radians, sin, tan

from core.message import CodedError, Message

MM_PER_INCH = 25.4
_RHOMBS = {"C": 80.0, "D": 55.0, "E": 75.0, "K": 55.0, "M": 86.0, "S": 90.0, "V": 35.0}
CORNER_ANGLES: Mapping[str, tuple[float, ...]] = {
    **{shape: (angle, 180.0 - angle) * 2 for shape, angle in _RHOMBS.items()},
    "T": (60.0,) * 3,
    "W": (80.0, 160.0) * 3,  # the trigon, a triangle with bent sides
    "P": (108.0,) * 5,
    "H": (120.0,) * 6,
    "O": (135.0,) * 8,
    "R": (),
}
CLEARANCE_ANGLES = {
    "A": 3.0,
    "B": 5.0,
    "C": 7.0,
    "D": 15.0,
    "E": 20.0,
    "F": 25.0,
    "G": 30.0,
    "N": 0.0,
    "P": 11.0,
}
_LETTERS: tuple[tuple[str, Iterable[str]], ...] = (
    ("shape", CORNER_ANGLES),
    ("clearance", CLEARANCE_ANGLES),
    ("tolerance class", "ACEFGHJKLMNU"),
    ("insert type (hole and chip breaker)", "ABCFGHJMNQRTUWX"),
)
# Inscribed circles in inches; those under 1/4 in only if the standard has an edge length for them.
_SERIES = (1 / 4, 5 / 16, 3 / 8, 7 / 16, 1 / 2, 9 / 16, 5 / 8, 11 / 16, 3 / 4, 7 / 8, 1.0, 5 / 4)
_SMALL = (5 / 32, 3 / 16, 7 / 32)
_UNUSUAL: Mapping[str, Mapping[str, float]] = {
    "C": {"03": 5 / 32 * MM_PER_INCH},  # the edge of 4.03 mm would give 04, which is 3/16 in
    "K": {"16": 9.525},
    "R": {f"{circle:02d}": float(circle) for circle in (5, 6, 8, 10, 16, 20, 25, 32)}
    | {"09": 9.525, "12": 12.7, "15": 15.875, "19": 19.05},
    "W": {"L3": 4.7625},
}
# Thin inserts of the smallest boring bars (CCGT 0301, CCGT 04T0) have maker-specific circles, mm.
_THIN: Mapping[tuple[str, str], float] = {
    **{("03", "01"): 3.5, ("03", "S1"): 3.5, ("04", "T0"): 4.3, ("04", "T1"): 4.3},
}
_METRIC_ROUND = 12.0  # mm; RCMT 1204M0, compared with 12.7 mm of RNMG 120400
THICKNESSES = {
    **{
        "S1": 1.39,
        "01": 1.59,
        "T0": 1.79,
        "T1": 1.98,
        "02": 2.38,
        "T2": 2.78,
        "03": 3.18,
        "T3": 3.97,
        "04": 4.76,
    },
    **{"T4": 4.96, "05": 5.56, "T5": 5.95, "06": 6.35, "T6": 6.75, "07": 7.94, "09": 9.52, "T9": 9.72},
    **{"11": 11.11, "12": 12.7},
}
CORNER_RADII = {
    f"{tenths:02d}": tenths / 10.0 for tenths in (0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20, 24, 28, 32)
}
_K_EDGE = 16.15  # mm, the long edge of KNUX 1604.., the only K insert used for turning
_EIGHTHS = {
    **{"1.2": 5 / 32, "1.5": 3 / 16, "1.8": 7 / 32, "2": 1 / 4, "2.5": 5 / 16, "3": 3 / 8},
    **{"4": 1 / 2, "5": 5 / 8, "6": 3 / 4, "7": 7 / 8, "8": 1.0},
}
_SIXTEENTHS = {
    **{
        "1": 1 / 16,
        "1.1": 0.07,
        "1.2": 5 / 64,
        "1.5": 3 / 32,
        "1.8": 7 / 64,
        "2": 1 / 8,
        "2.5": 5 / 32,
        "3": 3 / 16,
        "3.5": 7 / 32,
    },
    **{"4": 1 / 4, "5": 5 / 16, "6": 3 / 8},
}
_SIXTY_FOURTHS = {
    **{"0": 0.0, "0.2": 0.004, ".2": 0.004, "0.5": 0.008, ".5": 0.008},
    **{str(count): count / 64 for count in (1, 2, 3, 4, 5, 6, 7, 8)},
}
_FRACTION = re.compile(r"1\.[1258]|[23]\.5|\d?")
_CORNER_FRACTION = re.compile(r"0?\.[25]|\d?")
# Entering angles by style letter, ISO 5608 clause 4.4; shanks of the second table are for facing.
_TURNS: Mapping[str, float] = {
    **{"A": 90.0, "B": 75.0, "D": 45.0, "E": 60.0, "G": 90.0, "H": 107.5, "J": 93.0, "L": 95.0},
    **{"M": 50.0, "N": 63.0, "P": 117.5, "Q": 107.5, "R": 75.0, "S": 45.0, "T": 60.0, "V": 72.5},
}
_FACES: Mapping[str, float] = {"C": 90.0, "F": 91.0, "K": 75.0, "U": 93.0, "W": 60.0, "X": 120.0, "Y": 85.0}
# Distance from the tip to the far side of the shank by its width, ISO 5608 (mm) and ANSI B212.5 (1/16 in).
_REACH = {8.0: 10.0, 10.0: 12.0, 12.0: 16.0, 16.0: 20.0, 20.0: 25.0, 25.0: 32.0, 32.0: 40.0, 40.0: 50.0}
_INCH_REACH = {6: 8, 8: 10, 10: 12, 12: 16, 16: 20, 20: 24, 24: 32}
_PAIR = r"[-+.\d]+,[-+.\d]+"
_NUMBER = r"(\d+\s*/\s*\d+|\d*\.?\d+)"
_SIZES = rf"{_NUMBER}(?:\s*x\s*{_NUMBER})?\s*(mm|in|inch|\"|)"
_HEAD = r"[CDMPSWX][CDEKMPRSTVWHO]([A-Y])[A-Z][RLN]"
_ISO_SHANK = rf"{_HEAD}[\s-]*(\d\d)[\s-]*(\d\d)\s*[A-Z]?\s*(?:\d\d)?\b.*"
_INCH_SHANK = rf"{_HEAD}[\s-]*(\d\d)[\s-]*\d[A-Z]?\b.*"
_BAR = rf"[ACES](\d\d)[A-Z]?[\s-]*{_HEAD}[\s-]*(\d\d?)\b.*"


class InsertCodeError(CodedError, ValueError):
    """Error raised for an invalid insert code, with a message that names the invalid character."""


@dataclass(frozen=True, slots=True)
class CuttingInsert:
    """The geometry of an indexable insert, in degrees and mm.

    ``corner_angles`` and ``edge_lengths`` are the interior angles and the edge lengths, counterclockwise
    from the cutting corner. ``inscribed_circle`` is a diameter. A round insert has no corners or edges, and
    its nose radius is the radius of the whole insert.
    """

    shape: str
    corner_angles: tuple[float, ...]
    edge_lengths: tuple[float, ...]
    inscribed_circle: float
    nose_radius: float
    thickness: float = 0.0
    clearance_angle: float = 0.0

    @property
    def point_angle(self) -> float:
        """Return the included angle of the cutting corner in degrees, or 0 for a round insert."""
        return self.corner_angles[0] if self.corner_angles else 0.0


# --- ISO 1832, symbols 1 to 4: shape, normal clearance, tolerance, fixing and chip breaker -----------------


# --- ISO 1832, symbols 5 to 7 ------------------------------------------------------------------------------


# --- ANSI B212.4: inscribed circle in 1/8 in, thickness in 1/16 in, corner in 1/64 in ----------------------


def calculate_edge_length(corner_deg: float, next_corner_deg: float, circle_diameter: float) -> float:
    """Return the length of the edge between two corners of a polygon around an inscribed circle.

    The corners are interior angles in degrees.
    """
    return (
        circle_diameter
        / 2.0
        * (1.0 / tan(radians(corner_deg / 2.0)) + 1.0 / tan(radians(next_corner_deg / 2.0)))
    )


def make_insert(shape: str, circle_diameter: float, nose_radius: float) -> CuttingInsert:
    """Return the insert with this shape letter, inscribed circle and nose radius, in mm."""
    corners = CORNER_ANGLES[shape]
    if shape == "K":  # only the long edges of a parallelogram touch the circle; the end edge is short
        edges: tuple[float, ...] = (circle_diameter / sin(radians(corners[0])), _K_EDGE) * 2
    else:
        edges = tuple(
            calculate_edge_length(corner, after, circle_diameter)
            for corner, after in pairwise((*corners, *corners[:1]))
        )
    return CuttingInsert(
        shape, corners, edges, circle_diameter, nose_radius if corners else circle_diameter / 2.0
    )


def list_metric_circle_sizes(shape: str) -> dict[str, float]:
    """Return the inscribed circles in mm, with the two size digits of the ISO 1832 code as keys.

    The digits are the edge length in whole mm, rounded down.
    """
    if shape in "RK":
        return dict(_UNUSUAL[shape])
    corners = CORNER_ANGLES[shape]
    sizes = {}
    for inch in (*(_SMALL if shape in "CDSTVW" else ()), *_SERIES):
        circle = round(inch * MM_PER_INCH, 6)
        # A triangle for 1/4 in has an edge of 10.9985 mm, which the standard rounds to 11.
        sizes[f"{int(calculate_edge_length(corners[0], corners[1], circle) + 0.005):02d}"] = circle
    return {**sizes, **_UNUSUAL.get(shape, {})}


@lru_cache(maxsize=256)  # called for every feed of a program
def decode_insert_code(code: str) -> CuttingInsert:
    """Return the insert of an ISO or ANSI code.

    Characters after the size (edge condition, hand, chip breaker of the manufacturer) are ignored. Raises
    InsertCodeError if a character is invalid; the message names the character.
    """
    text = re.sub(r"[\s_]", "", code).upper()
    letters = re.match(r"[^-.\d]*?(?=[-.\d]|L\d|$)", text)
    head = letters[0] if letters else ""
    size = text[len(head) :].removeprefix("-")
    metric = re.match(r"(L\d|\d\d)\w\d", size)
    _check_letters(code, head, is_old_code=len(head) == 3 and size[:1].isdigit() and not metric)
    read = _read_metric_sizes if metric else _read_inch_sizes
    circle, thickness, nose = read(_CodeDigits(code, head[0], size, len(head)))
    return replace(
        make_insert(head[0], circle, nose), thickness=thickness, clearance_angle=CLEARANCE_ANGLES[head[1]]
    )


def _check_letters(code: str, head: str, *, is_old_code: bool) -> None:
    """Raise InsertCodeError if one of the four letters at the start of a code is invalid.

    Older inch codes do not have the last letter (TPG 322).
    """
    for place, (what, known) in enumerate(_LETTERS, start=1):
        if len(head) < place:
            if is_old_code:
                return
            raise InsertCodeError(
                Message(
                    "{code}: character {place} is missing; it specifies the {what}",
                    code=code,
                    place=place,
                    what=what,
                ),
                "character-missing",
            )
        if head[place - 1] not in known:
            raise _meaningless(code, place, head[place - 1], what, known)
    if len(head) > len(_LETTERS):
        raise InsertCodeError(
            Message(
                "{code}: character 5 ({head}) is not valid; the insert size begins at this position",
                code=code,
                head=head[4],
            ),
            "unknown-character",
        )


@dataclass(slots=True)
class _CodeDigits:
    """Reader of the digits of an insert code, from left to right."""

    code: str
    shape: str
    remaining_digits: str
    last_read_position: int  # position of the last character read, without blanks and dashes

    def remove_digits(self, found: str, what: str, known: Mapping[str, float]) -> float:
        """Remove the digits ``found`` from the remaining digits, and return their value in ``known``.

        ``what`` is the name of the value, for messages. Raises InsertCodeError if the digits are missing or
        not in ``known``.
        """
        if not found or len(found) < len(min(known, key=len)):
            place, known_codes = self.last_read_position + len(found) + 1, " ".join(sorted(known))
            raise InsertCodeError(
                Message(
                    "{code}: character {place} is missing; it specifies the {what}, one of: {values}",
                    code=self.code,
                    place=place,
                    what=what,
                    values=known_codes,
                ),
                "character-missing",
            )
        if found not in known:
            raise _meaningless(self.code, self.last_read_position + 1, found, what, known)
        self.remaining_digits = self.remaining_digits[len(found) :]
        self.last_read_position += len(found)
        return known[found]


def _meaningless(code: str, place: int, found: str, what: str, known: Iterable[str]) -> InsertCodeError:
    where = Message("character {place} ({value})", place=place, value=found)
    if len(found) > 1:
        where = Message(
            "characters {place} and {place2} ({value})",
            place=place,
            place2=place + len(found) - 1,
            value=found,
        )
    return InsertCodeError(
        Message(
            "{code}: invalid {what} in {place}; use one of: {known}",
            code=code,
            place=where,
            what=what,
            known=" ".join(sorted(known)),
        ),
        "unknown-character",
    )


def _read_metric_sizes(size: _CodeDigits) -> tuple[float, float, float]:
    """Return the inscribed circle, thickness and nose radius in mm that a metric code specifies."""
    edge = size.remaining_digits[:2]
    circle = size.remove_digits(
        edge, Message("size for insert shape {shape}", shape=size.shape), list_metric_circle_sizes(size.shape)
    )
    if size.shape == "C":
        circle = _THIN.get((edge, size.remaining_digits[:2]), circle)
    thickness = size.remove_digits(size.remaining_digits[:2], "thickness", THICKNESSES)
    if size.shape != "R":
        return (
            circle,
            thickness,
            size.remove_digits(size.remaining_digits[:2], "corner radius (tenths of a mm)", CORNER_RADII),
        )
    if (
        size.remove_digits(
            size.remaining_digits[:2],
            "round-insert code (in place of the corner radius)",
            {"00": 0.0, "M0": 1.0},
        )
        and edge == "12"
    ):
        circle = _METRIC_ROUND
    return circle, thickness, circle / 2.0


def _read_inch_sizes(size: _CodeDigits) -> tuple[float, float, float]:
    """Return the inscribed circle, thickness and nose radius in mm that an inch code specifies."""
    circle = size.remove_digits(_next_number(size, _FRACTION), "insert size (eighths of an inch)", _EIGHTHS)
    thickness = size.remove_digits(
        _next_number(size, _FRACTION), "insert thickness (sixteenths of an inch)", _SIXTEENTHS
    )
    corner = _next_number(size, _CORNER_FRACTION)
    if size.shape == "R" and corner in {"", "0"}:  # a round insert needs no corner
        return circle * MM_PER_INCH, thickness * MM_PER_INCH, circle * MM_PER_INCH / 2.0
    nose = size.remove_digits(corner, "corner radius (1/64 in)", _SIXTY_FOURTHS)
    if size.remaining_digits[:1].isdigit():
        raise InsertCodeError(
            Message(
                "{code}: character {place} ({left}) is an extra digit",
                code=size.code,
                place=size.last_read_position + 1,
                left=size.remaining_digits[0],
            ),
            "too-many-characters",
        )
    return circle * MM_PER_INCH, thickness * MM_PER_INCH, nose * MM_PER_INCH


def _next_number(size: _CodeDigits, pattern: re.Pattern[str]) -> str:
    """Return the next number of an inch code, or the invalid character at that position."""
    found = pattern.match(size.remaining_digits)
    return (found[0] if found else "") or size.remaining_digits[:1]


@dataclass(frozen=True, slots=True)
class ToolHolder:
    """A tool holder, with dimensions in mm; 0 means not specified.

    A bar is round; a shank is square or nearly square. ``reach_mm`` is the distance from the tip to the far
    side of the shank. ``entering_angle_deg`` is the entering angle in degrees. ``is_angle_for_facing`` is
    True if this angle applies to a feed toward the axis. ``outline`` replaces all other values.
    """

    shank_width_mm: float = 0.0
    bar_diameter_mm: float = 0.0
    reach_mm: float = 0.0
    entering_angle_deg: float = 0.0
    is_angle_for_facing: bool = False
    outline: tuple[tuple[float, float], ...] = ()


def parse_holder(text: str) -> ToolHolder | None:
    """Return the holder that a text describes, or None if the text is empty or only a name."""
    words = text.strip()
    if points := parse_outline(words):
        return ToolHolder(outline=points)
    return _parse_shank_size(words.lower()) or _coded(words.upper())


def make_standard_shank(width: float) -> ToolHolder:
    """Return a standard shank of the given width in mm."""
    return ToolHolder(shank_width_mm=width, reach_mm=_reach(width))


def parse_outline(text: str) -> tuple[tuple[float, float], ...] | None:
    """Return the points of an outline ``z,x z,x z,x``, or None for any other text."""
    if not re.fullmatch(rf"\s*{_PAIR}(?:\s+{_PAIR}){{2,}}\s*", text):
        return None
    try:
        return tuple((float(z), float(r)) for z, r in (pair.split(",") for pair in text.split()))
    except ValueError:
        return None


def _parse_shank_size(words: str) -> ToolHolder | None:
    """Return the shank of a size such as ``20x20``, ``3/4``, ``.75 in`` or ``16mm``.

    Fractions are inches. The result is None if the text is not a valid size, or if it is a single number
    without a unit.
    """
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
    return make_standard_shank(wide) if 0.0 < wide <= 100.0 else None


def _reach(width: float) -> float:
    sixteenths = round(width / MM_PER_INCH * 16.0, 6)
    if sixteenths in _INCH_REACH:
        return _INCH_REACH[int(sixteenths)] * MM_PER_INCH / 16.0
    return _REACH.get(round(width, 6), 1.25 * width)


# --- codes: clamping, insert shape, style, clearance, hand; then the shank and the size of the insert -------


def _coded(words: str) -> ToolHolder | None:
    if bar := re.fullmatch(_BAR, words):
        metric = len(bar[3]) == 2  # an ISO bar gives the edge in mm, an inch bar the circle in 1/8 in
        across = float(bar[1]) * (1.0 if metric else MM_PER_INCH / 16.0)
        return ToolHolder(bar_diameter_mm=across, entering_angle_deg={**_TURNS, **_FACES}.get(bar[2], 0.0))
    if found := re.fullmatch(_ISO_SHANK, words):
        return _styled(found[1], float(found[3]))
    if found := re.fullmatch(_INCH_SHANK, words):
        return _styled(found[1], _parse_inch_width(found[2]))
    return None


def _styled(style: str, width: float) -> ToolHolder:
    entry, faces = _TURNS.get(style, 0.0), style in _FACES
    neutral = style in "DENV"
    return ToolHolder(
        width, 0.0, width / 2.0 if neutral else _reach(width), entry or _FACES.get(style, 0.0), faces
    )


def _parse_inch_width(digits: str) -> float:
    """Return the shank width in mm for the two digits of an inch code.

    The digits of a square shank are 16ths of an inch. For other shanks, the first digit is the width in
    8ths and the second is the height in quarters of an inch.
    """
    if int(digits) in _INCH_REACH or digits in {"04", "05", "32"}:
        return int(digits) * MM_PER_INCH / 16.0
    return int(digits[0]) * MM_PER_INCH / 8.0
