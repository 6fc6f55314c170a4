"""Analyses of a record: path error, thread passes, ball-bar plot of an arc, response of axis and spindle.

They take what the scope shows frozen, or of live samples the last program that ran. A worker works them out;
what cannot be told is a sentence.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import combinations
from operator import itemgetter

import numpy as np
import numpy.typing as npt

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import STEPS, Row, Sheet
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.axis_response import AxisResponse, last_move, response_drawing, response_sheet
from app.extras.analyses.drawing import Drawing
from app.extras.analyses.drive_test_figures import (
    DriveTestFigures,
    drive_test_figures,
    figures_sheet,
    path_in,
    shown_words,
)
from app.extras.analyses.spindle_response import SpindleResponse, last_run_up, spindle_drawing, spindle_sheet
from app.scope.scope_model import Scope
from core.extras.analyses.path_error import (
    BallBar,
    PathError,
    WorstPlace,
    arcs_in,
    ball_bar,
    of_samples,
    worst_places,
)
from core.extras.analyses.thread_passes import Thread, fastest, find_thread
from core.machine.machine_model import Axis, SpindleModel
from core.message import Message
from core.records.record import AnalysisError, Record

FloatArray = npt.NDArray[np.float64]
MOST_POINTS = 6000  # that are drawn of a path
MAGNIFIED = (10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)
_PAUSE = 2.0  # s without a line that end a run of the program
_WORST = 12


class Kind(Enum):
    """What is looked for."""

    PATH = "PATH ERROR"
    THREAD = "THREAD"
    BALL_BAR = "BALL BAR"
    RESPONSE = "RESPONSE"
    SPINDLE = "SPINDLE"


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What an analysis has found: one of the three, or ``why`` there is nothing."""

    kind: Kind
    why: str = ""
    path: PathError | None = None
    worst: tuple[WorstPlace, ...] = ()
    thread: Thread | None = None
    speeds: tuple[FloatArray, ...] = ()  # of the passes, rpm
    ball: BallBar | None = None
    response: AxisResponse | None = None
    spindle: SpindleResponse | None = None
    test: DriveTestFigures | None = None  # the record is one of a drive test
    arc: tuple[int, int, int] = (0, 0, 0)  # its number, of how many, its line
    vmax: float = 0.0  # of the slide along a thread, mm/s
    axes: tuple[str, str] = ("Z", "X")  # that are drawn
    slides: tuple[str, ...] = ("Z", "X")  # of a path: all that it goes in


@dataclass(slots=True)
class Analyses:
    """``marked`` row of the table, ``magnified`` how many times an error is drawn larger."""

    scope: Scope
    drives: Mapping[str, Axis] = field(default_factory=dict)  # by letter
    spindle: SpindleModel | None = None
    worker: Latest = field(default_factory=lambda: Latest("editing-analyses"))
    kind: Kind = Kind.PATH
    arc: int = 0
    magnified: float = 100.0
    marked: int = 0
    found: Found | None = None
    _of: object = None

    @property
    def desk(self) -> Desk:
        """Where answers are said."""
        return self.scope.desk

    # --- what is asked -------------------------------------------------------------------------------

    def opened(self) -> None:
        """The page comes up: look at what there is now."""
        self._of = None
        self.found = None

    def choose(self, kind: Kind) -> None:
        """Another analysis; the same again takes newer samples."""
        self.desk.clear()
        self.kind, self.arc, self.marked = kind, 0, 0
        self.opened()

    def next_arc(self) -> None:
        """The next arc of the record."""
        self.desk.clear()
        if self.kind is not Kind.BALL_BAR:
            self.choose(Kind.BALL_BAR)
            return
        self.arc += 1
        self.opened()

    def magnify(self, steps: int) -> None:
        """Draw the error larger or smaller."""
        at = min(range(len(MAGNIFIED)), key=lambda i: abs(MAGNIFIED[i] - self.magnified))
        self.magnified = MAGNIFIED[max(0, min(len(MAGNIFIED) - 1, at + steps))]

    def typed(self, key: str) -> bool:
        """Arrows mark a row."""
        count = len(self.sheet().rows)
        if key not in STEPS or not count:
            return False
        self.mark(self.marked + STEPS[key])
        return True

    def mark(self, row: int) -> None:
        """The drawing shows where it is."""
        self.marked = max(0, min(len(self.sheet().rows) - 1, row))

    def look(self) -> None:
        """Once a frame: what the worker has found; it is asked once."""
        self.worker.poll()
        if self._of is None and not self.worker.busy:
            kind, arc, drives, spindle = self.kind, self.arc, self.drives, self.spindle
            self._of = (kind, arc)
            frozen, window, live = self.scope.frozen, self.scope.window, self.scope.live

            def work(_request: object) -> Found:
                if frozen is not None:
                    begin, end = frozen.zero + window.begin, frozen.zero + window.end
                    return analysed(kind, frozen.record.between(begin, end), arc, drives, spindle)
                if live is None or not math.isfinite(live.last):
                    return Found(kind, tr("NO SCOPE DATA ON THIS MACHINE. F9: OPEN A SCOPE RECORD"))
                names = {each.name for each in live.channels if each.unit in {"mm", "deg"}}
                names |= {"line", "spindle turns", "spindle speed", "spindle command"}
                record = live.between(live.last - live.lasts, live.last, names)
                cut = record if kind in {Kind.RESPONSE, Kind.SPINDLE} else last_run(record)
                return analysed(kind, cut, arc, drives, spindle)

            self.worker.ask(work, self._take, self.desk.say)

    def _take(self, found: Found) -> None:
        if found.kind is self.kind:
            self.found = found

    def close(self) -> None:
        """End the worker."""
        self.worker.close()

    # --- what is shown -------------------------------------------------------------------------------

    def drawing(self) -> Drawing:
        """Lines of what was found."""
        found = self.found
        if found is None or found.why:
            return Drawing()
        if found.path is not None:
            return _path_drawing(found, self.magnified, self.marked)
        if found.thread is not None:
            return _thread_drawing(found)
        if found.ball is not None:
            return _ball_drawing(found, self.magnified)
        return _response_drawing(found)

    def sheet(self) -> Sheet:
        """Figures of what was found."""
        found, metric = self.found, self.scope.metric
        title = tr(self.kind.value)
        if found is None:
            return Sheet(title, ("",), (1.0,), (), notes=(tr("CALCULATING …"),))
        if found.path is not None:
            return _path_sheet(title, found, metric, self.marked)
        if found.thread is not None:
            return _thread_sheet(title, found.thread, found.vmax, metric, self.marked)
        if found.ball is not None:
            return _ball_sheet(title, found.ball, found, metric)
        return _response_sheet(title, found, metric)

    @property
    def words(self) -> str:
        """What is looked at, above the drawing."""
        found = self.found
        if found is None:
            return tr("CALCULATING …")
        if found.why:
            return found.why
        if found.thread is not None:
            return tr("thread passes overlaid by spindle angle: deviation from the thread, and spindle speed")
        if found.kind in {Kind.RESPONSE, Kind.SPINDLE}:
            return _response_words(found, self.scope.metric)
        return tr(
            Message("error magnified {times}x; press Z to change the scale", times=f"{self.magnified:g}")
        )


def last_run(record: Record) -> Record:
    """Of samples the last stretch in which lines of a program were executed; all of it where none were."""
    lines = record.columns.get("line")
    if lines is None or not (lines > 0).any():
        return record
    on = np.flatnonzero(lines > 0)
    times = record.times[on]
    gaps = np.flatnonzero(np.diff(times) > _PAUSE)
    first = on[gaps[-1] + 1] if len(gaps) else on[0]
    return record.between(float(record.times[first]), float(record.times[on[-1]]))


def analysed(
    kind: Kind, record: Record, arc: int, drives: Mapping[str, Axis], spindle: SpindleModel | None = None
) -> Found:
    """Work it out; what cannot be is told by ``why``."""
    try:
        if kind is Kind.SPINDLE:
            return Found(kind, spindle=last_run_up(record, spindle))
        return _analysed(kind, record, arc, drives)
    except AnalysisError as error:
        return Found(kind, str(error))


def _analysed(kind: Kind, record: Record, arc: int, drives: Mapping[str, Axis]) -> Found:
    if kind is Kind.RESPONSE:
        played = path_in(record)
        if played is not None:
            return Found(kind, test=drive_test_figures(record, played, drives))
        return Found(kind, response=last_move(record, drives))
    columns = record.columns
    letters = [each.name[0] for each in record.channels if each.name[1:] == " demand" and each.unit == "mm"]
    if len(letters) < 2 or not len(record.times):
        raise AnalysisError(
            tr("a path needs two linear axes, but the record contains fewer than two"), "no-path"
        )
    slides = ("Z", "X") if set(letters) == {"X", "Z"} else tuple(sorted(letters))
    demand = np.column_stack([columns[Message("{item} demand", item=each)] for each in slides])
    actual = np.column_stack([columns[Message("{item} actual", item=each)] for each in slides])
    lines = columns.get("line", np.zeros(len(record.times)))
    axes = _drawn(slides, demand)
    if kind is Kind.PATH:
        path = of_samples(demand, actual, lines, record.rate)
        return Found(kind, path=path, worst=worst_places(path, _WORST), axes=axes, slides=slides)
    if kind is Kind.THREAD:
        speed = columns.get("spindle speed", np.full(len(lines), np.nan))
        turns = columns.get("spindle turns", np.full(len(lines), np.nan))
        vmax = drives[axes[0]].vmax if axes[0] in drives else 0.0
        thread = find_thread(turns, actual[:, 0], actual[:, 1], speed)
        speeds = tuple(speed[each.first : each.last + 1] for each in thread.passes)
        return Found(kind, thread=thread, speeds=speeds, vmax=vmax, axes=axes)
    return _ball_bar_found(slides, demand, actual, np.where(np.isfinite(lines), lines, 0.0), arc)


def _ball_bar_found(
    slides: tuple[str, ...], demand: FloatArray, actual: FloatArray, lines: FloatArray, arc: int
) -> Found:
    """The arc of this number, in whichever plane of two slides it lies."""
    arcs = [
        (cut.start, line, cut, pair)
        for pair in combinations(range(len(slides)), 2)
        for line, cut in arcs_in(demand[:, pair], lines)
    ]
    if not arcs:
        raise AnalysisError(
            tr(
                "this time range does not contain an arc of 60 degrees or more; cut an arc of "
                "this size while recording"
            ),
            "no-arc",
        )
    arcs.sort(key=itemgetter(0))
    number = arc % len(arcs)
    _, line, cut, pair = arcs[number]
    part = demand[cut][:, pair]
    moved = np.append(True, (np.abs(np.diff(part, axis=0)) > 1e-9).any(axis=1))
    ball = ball_bar(part[moved], actual[cut][:, pair][moved])
    axes = slides[pair[0]], slides[pair[1]]
    return Found(Kind.BALL_BAR, ball=ball, arc=(number, len(arcs), line), axes=axes)


def _drawn(slides: tuple[str, ...], demand: FloatArray) -> tuple[str, str]:
    """The two slides that went furthest: a path of three is drawn as it is seen along the third."""
    least = int(np.argmin(np.ptp(demand, axis=0))) if len(slides) > 2 else -1
    first, second = (each for number, each in enumerate(slides) if number != least)
    return first, second


# --- drawings -------------------------------------------------------------------------------------------


def _thinned(points: FloatArray, most: int = MOST_POINTS) -> FloatArray:
    return points[:: max(1, math.ceil(len(points) / most))]


def _path_drawing(found: Found, factor: float, marked: int) -> Drawing:
    path = found.path
    assert path is not None
    seen = [found.slides.index(each) for each in found.axes]
    marks: tuple[tuple[float, float, str], ...] = ()
    if marked < len(found.worst):
        worst = found.worst[marked]
        place = path.magnified(factor)[worst.sample][seen]
        marks = ((float(place[0]), float(place[1]), tr(Message("line {line}", line=worst.line))),)
    soft, curve = _thinned(path.foot[:, seen]), _thinned(path.magnified(factor)[:, seen])
    return Drawing(soft, (curve,), (), marks, names=_axis_names(found))


def _axis_names(found: Found) -> tuple[str, str, str]:
    across, up = (f"{letter}  {{unit}}" for letter in found.axes)
    return up, "", across


def _thread_drawing(found: Found) -> Drawing:
    assert found.thread is not None
    curves = tuple(_thinned(np.column_stack([each.turns, each.off])) for each in found.thread.passes[:8])
    below = tuple(
        _thinned(np.column_stack([each.turns, speed]))
        for each, speed in zip(found.thread.passes[:8], found.speeds, strict=False)
        if np.isfinite(speed).all()
    )
    names = tr("THREAD DEVIATION") + "  {unit}", Message("{title}  rpm", title=tr("SPINDLE")), tr("turns")
    return Drawing(curves=curves, below=below, equal=False, names=names)


def _response_drawing(found: Found) -> Drawing:
    if found.spindle is not None:
        return spindle_drawing(found.spindle)
    move = found.test.move if found.test is not None else found.response
    return response_drawing(move) if move is not None else Drawing()


def _ball_drawing(found: Found, factor: float) -> Drawing:
    ball = found.ball
    assert ball is not None
    angles = np.radians(ball.angles)
    out = np.column_stack([np.cos(angles), np.sin(angles)])
    seen = (ball.radius + factor * ball.deviation)[:, None] * out
    return Drawing(_thinned(ball.radius * out), (_thinned(seen),), names=_axis_names(found))


# --- figures --------------------------------------------------------------------------------------------


def _length(mm: float, metric: bool) -> str:
    return f"{formats.length(mm, metric)} {tr('mm') if metric else tr('in')}"


def _path_sheet(title: str, found: Found, metric: bool, marked: int) -> Sheet:
    path = found.path
    assert path is not None
    rows = tuple(
        Row((str(each.line), *(formats.length(way, metric) for way in (each.distance, *each.place))))
        for each in found.worst
    )
    lathe = len(found.slides) == 2
    notes = (
        tr(Message("Largest error: {distance}", distance=_length(path.greatest, metric))),
        *((tr("Positive values are to the left of the direction of travel."),) if lathe else ()),
        tr("The table shows the worst point of each line."),
        tr("Axis positions are measured from home, X as a radius.")
        if lathe
        else tr("Axis positions are measured from home."),
    )
    heads = (tr("LINE"), tr("PATH DEVIATION"), *found.slides)
    shares = (0.16, 0.3, 0.27, 0.27) if lathe else (0.11, 0.23, 0.22, 0.22, 0.22)
    figures = frozenset(range(1, len(heads)))
    return Sheet(title, heads, shares, rows, min(marked, len(rows) - 1), notes=notes, figures=figures)


def _thread_sheet(title: str, thread: Thread, vmax: float, metric: bool, marked: int) -> Sheet:
    rows = tuple(
        Row(
            (
                str(number),
                formats.length(abs(each.depth - thread.passes[0].depth), metric),
                f"{formats.fixed(each.entry, 2)}°",
                formats.length(each.lead - thread.lead, metric),
                formats.fixed(each.drop, 0),
            )
        )
        for number, each in enumerate(thread.passes, 1)
    )
    limit = fastest(thread.lead, vmax) if vmax else math.inf
    notes = (
        tr(Message("Lead: {lead} per revolution", lead=_length(abs(thread.lead), metric))),
        tr(
            Message(
                "The thread entry angles agree within {angle}°", angle=formats.fixed(thread.entry_spread, 2)
            )
        ),
        tr("Flank infeed shifts the entry angle with the depth."),
        tr(Message("The axis is fast enough to cut this lead at up to {rpm} rpm", rpm=formats.rpm(limit))),
    )
    heads = (tr("PASS"), tr("ADDED DEPTH"), tr("ENTRY ANGLE"), tr("LEAD ERROR"), tr("RPM DROP"))
    shares = (0.12, 0.24, 0.2, 0.24, 0.2)
    figures = frozenset({1, 2, 3, 4})
    return Sheet(title, heads, shares, rows, min(marked, len(rows) - 1), notes=notes, figures=figures)


def _response_sheet(title: str, found: Found, metric: bool) -> Sheet:
    if found.test is not None:
        return figures_sheet(title, found.test, metric)
    if found.spindle is not None:
        return spindle_sheet(title, found.spindle)
    if found.response is not None:
        return response_sheet(title, found.response, metric)
    return Sheet(title, ("",), (1.0,), ())


def _response_words(found: Found, metric: bool) -> str:
    if found.test is not None:
        return shown_words(found.test.path, metric)
    if found.spindle is not None:
        return tr("last spindle speed change: commanded and actual speed over time in seconds")
    return tr("last move: commanded position, actual position and following error over time in seconds")


def _ball_sheet(title: str, ball: BallBar, found: Found, metric: bool) -> Sheet:
    u, v = found.axes

    def lean(value: float) -> str:
        return (
            Message("{fixed} mm/m", fixed=formats.fixed(value, 3))
            if math.isfinite(value)
            else formats.NOTHING
        )

    def told(value: float) -> str:
        return _length(value, metric) if math.isfinite(value) else formats.NOTHING

    rows = (
        Row((tr("ROUNDNESS"), told(ball.roundness))),
        Row((tr(Message("BACKLASH {axis}", axis=u)), told(ball.backlash[0]))),
        Row((tr(Message("BACKLASH {axis}", axis=v)), told(ball.backlash[1]))),
        Row((tr(Message("REVERSAL SPIKE {axis}", axis=u)), told(ball.spike[0]))),
        Row((tr(Message("REVERSAL SPIKE {axis}", axis=v)), told(ball.spike[1]))),
        Row((tr("SQUARENESS ERROR"), lean(ball.squareness))),
        Row((tr(Message("SCALE OF {value} RELATIVE TO {v}", value=u, v=v)), lean(ball.scale))),
        Row((tr("RADIUS ERROR"), told(ball.size))),
    )
    number, count, line = found.arc
    notes = (
        tr(
            Message(
                "Line {line}, arc {number} of {count}: radius {radius}, {angle}°",
                line=line,
                number=number + 1,
                count=count,
                radius=_length(ball.radius, metric),
                angle=formats.fixed(ball.covered, 0),
            )
        ),
        tr("A dash means that the arc is too short to calculate the value."),
        tr("The encoder cannot measure backlash between the encoder and the tool."),
    )
    return Sheet(title, ("", ""), (0.52, 0.48), rows, notes=notes, figures=frozenset({1}))


def scaled(drawing: Drawing, factor: float) -> Drawing:
    """In another unit of length, both ways of equal axes, else upwards."""
    by = np.array([factor if drawing.equal else 1.0, factor if drawing.lengths else 1.0])
    marks = tuple((x * by[0], y * by[1], word) for x, y, word in drawing.marks)
    curves = tuple(each * by for each in drawing.curves)
    below = tuple(each * by for each in drawing.below) if drawing.lengths_below else drawing.below
    unit = "mm" if factor == 1.0 else tr("in")
    upper, lower, across = (each.replace("{unit}", unit) for each in drawing.names)
    soft, names = drawing.soft * by, (upper, lower, across)
    return replace(drawing, soft=soft, curves=curves, marks=marks, below=below, names=names)
