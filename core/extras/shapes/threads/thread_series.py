"""Thread series by name, and thread limits by class, from the formulas of the standards.

The sources are ASME B1.1 for unified threads, and ISO 965-1 for metric threads, whose tolerances are
rounded to preferred numbers (R 40). Pipe threads follow B1.20.1, ISO 7-1 and ISO 228-1. ACME threads follow
B1.5, general purpose.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction


class ThreadSeries(StrEnum):
    """The standard thread series, and OWN for a thread defined by its own dimensions."""

    UNC = "UNC"
    UNF = "UNF"
    UNEF = "UNEF"
    M = "M"
    MF = "MF"
    NPT = "NPT"
    BSP = "BSP"
    BSPT = "BSPT"
    ACME = "ACME"
    CUSTOM = "OWN"


METRIC_SERIES = frozenset({ThreadSeries.M, ThreadSeries.MF, ThreadSeries.BSP, ThreadSeries.BSPT})
UNIFIED_SERIES = frozenset({ThreadSeries.UNC, ThreadSeries.UNF, ThreadSeries.UNEF})
TAPERED_SERIES = frozenset({ThreadSeries.NPT, ThreadSeries.BSPT})


@dataclass(frozen=True, slots=True)
class ThreadSize:
    """A thread size in the unit of its series.

    ``diameter`` is the basic major diameter. For a pipe thread it is the diameter of the pipe (NPT) or the
    diameter at the gauge plane. ``gauge_length`` is the distance of the gauge plane from the small end of a
    tapered thread.
    """

    name: str
    diameter: float
    pitch: float
    gauge_length: float = 0.0


def _fraction(name: str) -> float:
    return float(sum(Fraction(part) for part in name.split("-")))


def _unified_series(listed: str) -> tuple[ThreadSize, ...]:
    found = []
    for each in listed.split():
        name, _, turns = each.rpartition(":")
        number = name.startswith("#")
        diameter = 0.060 + 0.013 * int(name[1:]) if number else _fraction(name)
        found.append(ThreadSize(name, round(diameter, 6), 1.0 / float(turns)))
    return tuple(found)


def _metric_series(listed: str, *, fine: bool) -> tuple[ThreadSize, ...]:
    found = []
    for each in listed.split():
        across, _, pitch = each.partition("x")
        name = f"M{across}X{pitch}" if fine else f"M{across}"
        found.append(ThreadSize(name, float(across), float(pitch)))
    return tuple(found)


def _listed(unit: float, listed: str) -> tuple[ThreadSize, ...]:
    """Return sizes from a list of name, diameter, threads per inch and, for tapered threads, gauge length.

    ``unit`` is the length of an inch in the unit of the series.
    """
    found = []
    for each in listed.split():
        name, diameter, turns, *gauge = each.split(":")
        found.append(
            ThreadSize(name, float(diameter), unit / float(turns), float(gauge[0]) if gauge else 0.0)
        )
    return tuple(found)


THREAD_SIZES: dict[ThreadSeries, tuple[ThreadSize, ...]] = {
    ThreadSeries.UNC: _unified_series(
        "#1:64 #2:56 #3:48 #4:40 #5:40 #6:32 #8:32 #10:24 #12:24 1/4:20 5/16:18 3/8:16 7/16:14 1/2:13 "
        "9/16:12 5/8:11 3/4:10 7/8:9 1:8 1-1/8:7 1-1/4:7 1-3/8:6 1-1/2:6 1-3/4:5 2:4.5"
    ),
    ThreadSeries.UNF: _unified_series(
        "#0:80 #1:72 #2:64 #3:56 #4:48 #5:44 #6:40 #8:36 #10:32 #12:28 1/4:28 5/16:24 3/8:24 7/16:20 "
        "1/2:20 9/16:18 5/8:18 3/4:16 7/8:14 1:12 1-1/8:12 1-1/4:12 1-3/8:12 1-1/2:12"
    ),
    ThreadSeries.UNEF: _unified_series(
        "#12:32 1/4:32 5/16:32 3/8:32 7/16:28 1/2:28 9/16:24 5/8:24 11/16:24 3/4:20 13/16:20 7/8:20 "
        "15/16:20 1:20 1-1/16:18 1-1/8:18 1-1/4:18 1-3/8:18 1-1/2:18"
    ),
    ThreadSeries.M: _metric_series(
        "1.6x0.35 2x0.4 2.5x0.45 3x0.5 3.5x0.6 4x0.7 5x0.8 6x1 7x1 8x1.25 10x1.5 12x1.75 14x2 16x2 18x2.5 "
        "20x2.5 22x2.5 24x3 27x3 30x3.5 33x3.5 36x4 39x4 42x4.5 48x5",
        fine=False,
    ),
    ThreadSeries.MF: _metric_series(
        "4x0.5 5x0.5 6x0.75 8x0.75 8x1 10x0.75 10x1 10x1.25 12x1 12x1.25 12x1.5 14x1 14x1.5 16x1 16x1.5 "
        "18x1 18x1.5 20x1 20x1.5 20x2 22x1.5 24x1 24x1.5 24x2 27x1.5 27x2 30x1.5 30x2 33x2 36x1.5 36x3 "
        "39x3 42x2 42x3 48x2 48x3",
        fine=True,
    ),
    ThreadSeries.NPT: _listed(
        1.0,
        "1/16:0.3125:27:0.160 1/8:0.405:27:0.1615 1/4:0.540:18:0.2278 3/8:0.675:18:0.240 "
        "1/2:0.840:14:0.320 3/4:1.050:14:0.339 1:1.315:11.5:0.400 1-1/4:1.660:11.5:0.420 "
        "1-1/2:1.900:11.5:0.420 2:2.375:11.5:0.436",
    ),
    ThreadSeries.BSP: _listed(
        25.4,
        "1/16:7.723:28 1/8:9.728:28 1/4:13.157:19 3/8:16.662:19 1/2:20.955:14 5/8:22.911:14 3/4:26.441:14 "
        "7/8:30.201:14 1:33.249:11 1-1/8:37.897:11 1-1/4:41.910:11 1-1/2:47.803:11 1-3/4:53.746:11 "
        "2:59.614:11",
    ),
    ThreadSeries.BSPT: _listed(
        25.4,
        "1/16:7.723:28:4.0 1/8:9.728:28:4.0 1/4:13.157:19:6.0 3/8:16.662:19:6.4 1/2:20.955:14:8.2 "
        "3/4:26.441:14:9.5 1:33.249:11:10.4 1-1/4:41.910:11:12.7 1-1/2:47.803:11:12.7 2:59.614:11:15.9",
    ),
    ThreadSeries.ACME: _listed(
        1.0,
        "1/4:0.25:16 5/16:0.3125:14 3/8:0.375:12 7/16:0.4375:12 1/2:0.5:10 5/8:0.625:8 3/4:0.75:6 "
        "7/8:0.875:6 1:1:5 1-1/8:1.125:5 1-1/4:1.25:5 1-3/8:1.375:4 1-1/2:1.5:4 1-3/4:1.75:4 2:2:4",
    ),
}
"""Thread sizes by thread series, from small to large."""


def find_thread_size(series: ThreadSeries, name: str) -> ThreadSize | None:
    """Return the size with this name, or None if the series does not contain it.

    Names are, for example, 1/2, 1/2-13, #10, M10X1.25, 10, 10-32 or 10X1.25. If a name is ambiguous, 1 is
    the size in inches and #1 is the numbered size.
    """
    wanted = name.strip().upper().replace(" ", "")
    sizes = THREAD_SIZES.get(series, ())
    for bare in ("", "#", "M"):
        for each in sizes:
            if wanted in {known.removeprefix(bare) for known in _names(series, each)}:
                return each
    return None


def _names(series: ThreadSeries, size: ThreadSize) -> tuple[str, ...]:
    """Return the names of a size, one with and one without the pitch."""
    if series in {ThreadSeries.M, ThreadSeries.MF}:
        return size.name, f"{size.name.partition('X')[0]}X{size.pitch:g}"
    turns = (25.4 if series in METRIC_SERIES else 1.0) / size.pitch
    return size.name, f"{size.name}-{round(turns, 2):g}"


V60_HEIGHT_FACTOR = math.sqrt(3.0) / 2.0  # =
_V55 = 0.960491  # height of a sharp V of 55° in pitches
_PIPE_HEIGHT = 0.8  # height of an NPT thread in pitches; ASME B1.20.1
_WHITWORTH = 2.0 / 3.0 * _V55  # height of a 55° thread with a sixth rounded off at crest and root; ISO 228-1
_TAPER = 1.0 / 16.0  # on the diameter

TOLERANCE_CLASSES = {
    "unified": (("2A", "1A", "3A"), ("2B", "1B", "3B")),
    "metric": (("6g", "6h", "4h", "8g"), ("6H", "5H", "7H", "6G")),
    "ACME": (("2G", "3G", "4G"), ("2G", "3G", "4G")),
    "BSP": (("A", "B"), ()),
}
"""Tolerance classes of external and internal threads, by series. The first class is the default."""


@dataclass(frozen=True, slots=True)
class ThreadLimits:
    """Limits of the diameters of a thread in the unit of its series.

    For a tapered thread the limits are at its small end. ``root_diameter`` is the final diameter of the tip
    of a standard tool when the pitch diameter is in the middle of its limits. ``crest_diameter`` is the
    diameter to be turned or bored before threading.
    """

    major_diameter: tuple[float, float]
    pitch_diameter: tuple[float, float]
    minor_diameter: tuple[float, float]
    crest_diameter: float
    root_diameter: float
    flank_angle_deg: float = 60.0

    @property
    def thread_height(self) -> float:
        """Return the height from crest to root, as a radius."""
        return abs(self.crest_diameter - self.root_diameter) / 2.0


def list_tolerance_classes(series: ThreadSeries, *, is_inside: bool) -> tuple[str, ...]:
    """Return the tolerance classes of a series, the usual class first.

    The result is () if the standard has only one class.
    """
    if series in UNIFIED_SERIES:
        return TOLERANCE_CLASSES["unified"][is_inside]
    if series in {ThreadSeries.M, ThreadSeries.MF}:
        return TOLERANCE_CLASSES["metric"][is_inside]
    return TOLERANCE_CLASSES[series.value][is_inside] if series.value in TOLERANCE_CLASSES else ()


def get_flank_angle(series: ThreadSeries) -> float | None:
    """Return the included angle of the flanks in degrees, or None if the series does not specify it."""
    if series is ThreadSeries.CUSTOM:
        return None
    return (
        29.0
        if series is ThreadSeries.ACME
        else 55.0
        if series in {ThreadSeries.BSP, ThreadSeries.BSPT}
        else 60.0
    )


def calculate_thread_limits(
    series: ThreadSeries, size: ThreadSize, tolerance_class: str, *, is_inside: bool, nose_radius: float = 0.0
) -> ThreadLimits:
    """Return the limits of a thread.

    ``nose_radius`` is the tip radius of the tool in the unit of the series; 0 means the standard profile.
    """
    if series in UNIFIED_SERIES:
        return _unified(series, size, tolerance_class, nose_radius, inside=is_inside)
    if series in {ThreadSeries.M, ThreadSeries.MF}:
        return _metric(size, tolerance_class, nose_radius, inside=is_inside)
    if series is ThreadSeries.ACME:
        return _acme(size, tolerance_class, is_inside=is_inside)
    if series in TAPERED_SERIES:
        return _pipe(series, size, nose_radius, is_inside=is_inside)
    return _parallel_pipe(size, tolerance_class, nose_radius, is_inside=is_inside)


def _middle(pair: tuple[float, float]) -> float:
    return (pair[0] + pair[1]) / 2.0


def _v_root(pitch_diameter: float, pitch: float, nose: float, *, is_inside: bool) -> float:
    """Return the diameter that the tip of the threading tool reaches on the last pass of a V thread.

    ``nose`` is the tip radius. If it is 0, the standard profile is assumed: a root truncation of H/6
    outside (rounded root) or H/8 inside (flat of P/8).
    """
    high = V60_HEIGHT_FACTOR * pitch
    lack = nose or high / (8.0 if is_inside else 6.0)
    far = high - 2.0 * lack
    return pitch_diameter + far if is_inside else pitch_diameter - far


# --- ASME B1.1


def _printed(value: float) -> float:
    """Return a value rounded half up, as B1.1 rounds tolerances, allowances and basic diameters."""
    return math.floor(value * 10_000.0 + 0.5 + 1e-9) / 10_000.0


def _unified(
    series: ThreadSeries, size: ThreadSize, tolerance: str, nose: float, *, inside: bool
) -> ThreadLimits:
    d, p = size.diameter, size.pitch
    grade = int(tolerance[0])
    engaged = 9.0 * p if series is ThreadSeries.UNEF else d
    pitch_2a = round(0.0015 * d ** (1 / 3) + 0.0015 * math.sqrt(engaged) + 0.015 * p ** (2 / 3), 6)
    basic_pitch, basic_minor = _printed(d - 0.75 * V60_HEIGHT_FACTOR * p), d - 1.25 * V60_HEIGHT_FACTOR * p
    if inside:
        wide = _printed({1: 1.95, 2: 1.3, 3: 0.975}[grade] * pitch_2a)
        pitch = basic_pitch, basic_pitch + wide
        minor = basic_minor, basic_minor + _minor_tolerance(d, p, grade)
        return ThreadLimits(
            (d, math.inf), pitch, minor, _middle(minor), _v_root(_middle(pitch), p, nose, is_inside=True)
        )
    allowance = _printed(0.3 * pitch_2a) if grade < 3 else 0.0
    wide = _printed({1: 1.5, 2: 1.0, 3: 0.75}[grade] * pitch_2a)
    major_wide = _printed((0.09 if grade == 1 else 0.06) * p ** (2 / 3))
    major = d - allowance - major_wide, d - allowance
    pitch = basic_pitch - allowance - wide, basic_pitch - allowance
    root = _v_root(_middle(pitch), p, nose, is_inside=False)
    deepest = d - allowance - 17.0 / 12.0 * V60_HEIGHT_FACTOR * p  # UNR, reference value
    return ThreadLimits(major, pitch, (-math.inf, deepest), _middle(major), root)


def _minor_tolerance(d: float, p: float, grade: int) -> float:
    """Return the tolerance of the minor diameter of an internal thread (ASME B1.1, section 5.8)."""
    formula = 0.05 * math.pow(p, 2 / 3) + 0.03 * p / d - 0.002
    if grade < 3:
        if d >= 0.25:
            return 0.25 * p - 0.4 * p * p if 1.0 / p >= 4.0 else 0.15 * p
        return min(max(formula, 0.25 * p - 0.4 * p * p), 0.394 * p)
    least = 0.23 * p - 1.5 * p * p if 1.0 / p >= 13.0 else 0.12 * p
    return min(max(formula, least), 0.394 * p)


# --- ISO 965-1

_R40 = (
    *(100, 106, 112, 118, 125, 132, 140, 150, 160, 170, 180, 190, 200, 212, 224, 236, 250, 265, 280, 300),
    *(315, 335, 355, 375, 400, 425, 450, 475, 500, 530, 560, 600, 630, 670, 710, 750, 800, 850, 900, 950),
)
_STEPS = (0.99, 1.4, 2.8, 5.6, 11.2, 22.4, 45.0, 90.0, 180.0)  # mm, ranges of diameters
_GRADES = {3: 0.5, 4: 0.63, 5: 0.8, 6: 1.0, 7: 1.25, 8: 1.6}
_MINOR_6 = {0.35: 100, 0.4: 112, 0.45: 125, 0.5: 140, 0.6: 160, 0.7: 180, 0.75: 190, 0.8: 200, 1.0: 236}
_MINOR_6 |= {
    1.25: 265,
    1.5: 300,
    1.75: 335,
    2.0: 375,
    2.5: 450,
    3.0: 500,
    3.5: 560,
    4.0: 600,
    4.5: 670,
    5.0: 710,
}

# Values where the table differs from the formula: pitch diameter by pitch and range, major diameter by pitch.
_PITCH_6 = {(0.5, 2.8): 75.0, (5.0, 45.0): 250.0}
_MAJOR_6 = {4.0: 475.0}
_PLACE_G = {0.35: 19, 0.4: 19, 0.45: 20, 0.5: 20, 0.6: 21, 0.7: 22, 0.75: 22, 0.8: 24, 1.0: 26, 1.25: 28}
_PLACE_G |= {1.5: 32, 1.75: 34, 2.0: 38, 2.5: 42, 3.0: 48, 3.5: 53, 4.0: 60, 4.5: 63, 5.0: 71}


def _preferred(value: float, *, up: bool = False) -> float:
    """Return the nearest preferred number of the R 40 series.

    If ``up`` is True, return the first preferred number that is at least 99 % of the value.
    """
    scale = 10.0 ** math.floor(math.log10(value / 100.0))
    numbers = [n * scale for n in (*_R40, 1000)]
    if up:
        return next(n for n in numbers if n >= 0.99 * value)
    return min(numbers, key=lambda n: (abs(n - value), -n))


def _metric(size: ThreadSize, tolerance: str, nose: float, *, inside: bool) -> ThreadLimits:
    d, p = size.diameter, size.pitch
    grade, place = int(tolerance[0]), tolerance[1]
    low = max(step for step in _STEPS if step < d)
    mean = math.sqrt(low * _STEPS[_STEPS.index(low) + 1])
    pitch_6 = _PITCH_6.get((p, low)) or _preferred(90.0 * p**0.4 * mean**0.1)
    away = _PLACE_G.get(p, round(15.0 + 11.0 * p)) / 1000.0
    shift = {"g": -away, "G": away}.get(place, 0.0)
    basic_pitch, basic_minor = d - 0.75 * V60_HEIGHT_FACTOR * p, d - 1.25 * V60_HEIGHT_FACTOR * p
    if inside:
        wide = _preferred(_preferred(1.32 * pitch_6, up=True) * _GRADES[grade]) / 1000.0
        minor_wide = _preferred(_MINOR_6.get(p, 230.0 * p**0.7) * _GRADES[grade]) / 1000.0
        pitch = basic_pitch + shift, basic_pitch + shift + wide
        minor = basic_minor + shift, basic_minor + shift + minor_wide
        root = _v_root(_middle(pitch), p, nose, is_inside=True)
        return ThreadLimits((d + shift, math.inf), pitch, minor, _middle(minor), root)
    wide = _preferred(pitch_6 * _GRADES[grade]) / 1000.0
    major_6 = _MAJOR_6.get(p) or _preferred(180.0 * p ** (2 / 3) - 3.15 / math.sqrt(p))
    major_wide = _preferred(major_6 * {4: 0.63, 6: 1.0, 8: 1.6}[grade]) / 1000.0
    major = d + shift - major_wide, d + shift
    pitch = basic_pitch + shift - wide, basic_pitch + shift
    root = _v_root(_middle(pitch), p, nose, is_inside=False)
    return ThreadLimits(
        major, pitch, (-math.inf, d + shift - 1.25 * V60_HEIGHT_FACTOR * p), _middle(major), root
    )


# --- Pipe threads, ACME


_PIPE_PITCH = {28: 0.107, 19: 0.125, 14: 0.142, 11: 0.180}
_PIPE_MINOR = {28: 0.282, 19: 0.445, 14: 0.541, 11: 0.640}
"""Minor-diameter tolerance of internal pipe threads by threads per inch, in mm (ISO 228-1)."""


def _parallel_pipe(size: ThreadSize, tolerance: str, nose: float, *, is_inside: bool) -> ThreadLimits:
    """Return the limits of a parallel pipe thread according to ISO 228-1.

    For internal threads, the standard has only one tolerance class.
    """
    d, p, turns = size.diameter, size.pitch, round(25.4 / size.pitch)
    wide, basic_pitch, basic_minor = _PIPE_PITCH[turns], d - _WHITWORTH * p, d - 2.0 * _WHITWORTH * p
    if is_inside:
        pitch = basic_pitch, basic_pitch + wide
        minor = basic_minor, basic_minor + _PIPE_MINOR[turns]
        root = _pipe_root(_middle(pitch), p, 55.0, nose, is_inside=True)
        return ThreadLimits((d, math.inf), pitch, minor, _middle(minor), root, 55.0)
    pitch, major = (
        (basic_pitch - (wide if tolerance == "A" else 2.0 * wide), basic_pitch),
        (d - 2.0 * wide, d),
    )
    root = _pipe_root(_middle(pitch), p, 55.0, nose, is_inside=False)
    return ThreadLimits(major, pitch, (-math.inf, basic_minor), _middle(major), root, 55.0)


def _pipe_root(pitch_diameter: float, pitch: float, angle: float, nose: float, *, is_inside: bool) -> float:
    """Return the diameter that the tip of the tool reaches on the last pass of a pipe thread.

    ``nose`` is the radius of the tip, or 0 for the standard profile.
    """
    if nose:
        sharp = _V55 if angle == 55.0 else V60_HEIGHT_FACTOR
        high = sharp * pitch - 2.0 * nose * (1.0 / math.sin(math.radians(angle / 2.0)) - 1.0)
    else:
        high = (_WHITWORTH if angle == 55.0 else _PIPE_HEIGHT) * pitch
    return pitch_diameter + high if is_inside else pitch_diameter - high


def _pipe(series: ThreadSeries, size: ThreadSize, nose: float, *, is_inside: bool) -> ThreadLimits:
    """Return the limits of a tapered pipe thread.

    The limits are at the small end of an external thread, or at the mouth of an internal thread, which is
    its large end.
    """
    d, p = size.diameter, size.pitch
    if series is ThreadSeries.NPT:
        small = d - (0.05 * d + 1.1) * p  # =
        high, angle = _PIPE_HEIGHT, 60.0
    else:
        small = d - size.gauge_length * _TAPER - _WHITWORTH * p
        high, angle = _WHITWORTH, 55.0
    pitch = small + size.gauge_length * _TAPER if is_inside else small
    outer, inner = pitch + high * p, pitch - high * p
    crest = inner if is_inside else outer
    root = _pipe_root(pitch, p, angle, nose, is_inside=is_inside)
    return ThreadLimits((outer, outer), (pitch, pitch), (inner, inner), crest, root, angle)


def get_pipe_thread_length(series: ThreadSeries, size: ThreadSize) -> float:
    """Return the length of the full thread of a tapered pipe thread, or 0 if the operator must specify it.

    The length is L2 of B1.20.1, or the gauge length plus the fitting allowance of ISO 7-1.
    """
    if series is ThreadSeries.NPT:
        return (0.8 * size.diameter + 6.8) * size.pitch
    turns = 2.75 if size.diameter < 50.0 else 3.25
    return size.gauge_length + turns * size.pitch if series is ThreadSeries.BSPT else 0.0


def _acme(size: ThreadSize, tolerance: str, *, is_inside: bool) -> ThreadLimits:
    """Return the limits of an ACME thread according to B1.5, general purpose.

    The height is P/2 with a clearance of .010 in at the root, or .005 in above 10 threads per inch.
    """
    d, p = size.diameter, size.pitch
    clear = 0.020 if 1.0 / p <= 10.0 + 1e-9 else 0.010
    grade = tolerance[0]
    allowance = {"2": 0.008, "3": 0.006, "4": 0.004}[grade] * math.sqrt(d)
    wide = {"2": 1.0, "3": 7.0 / 15.0, "4": 1.0 / 3.0}[grade] * (0.030 * math.sqrt(p) + 0.006 * math.sqrt(d))
    basic_pitch, basic_minor = d - p / 2.0, d - p
    if is_inside:
        pitch = basic_pitch, basic_pitch + wide
        minor = basic_minor, basic_minor + max(0.05 * p, 0.005)
        return ThreadLimits((d + clear, math.inf), pitch, minor, _middle(minor), d + clear + 0.5 * wide, 29.0)
    pitch = basic_pitch - allowance - wide, basic_pitch - allowance
    major = d - max(0.05 * p, 0.005), d
    deepest = basic_minor - clear
    return ThreadLimits(major, pitch, (-math.inf, deepest), _middle(major), deepest - 0.5 * wide, 29.0)


def convert_length(value: float, series: ThreadSeries, *, is_metric: bool) -> float:
    """Convert a length from the unit of a series to the unit of a program."""
    return value * (
        1.0 / 25.4
        if series in METRIC_SERIES and not is_metric
        else 25.4
        if is_metric and series not in METRIC_SERIES
        else 1.0
    )
