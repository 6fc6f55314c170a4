"""What a restart will do, in words and lines: the state beside the one of now, what starts, the way."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from app.desk import formats
from app.desk.drawing.approach import Leg as Drawn
from app.desk.inforce import InForce, rows_of
from app.desk.words import tr
from core.executor.snapshot import Snapshot
from core.interpreter.actions import Coolant, Output, SpindleLock, SpindleRun
from core.interpreter.begin import Begin, Checkpoint, Leg, Step
from core.interpreter.restart.approach import Choices, Now, begin_at, starting
from core.interpreter.restart.found import Found

_CLEAR = 0.5  # mm short of where the program was clear of the part
_DEEP = 0.1  # mm below the bar's surface


@dataclass(frozen=True, slots=True)
class Beside:
    """One row: what is wanted at the line, what is active now, and whether they differ."""

    label: str
    wanted: str
    now: str

    @property
    def differs(self) -> bool:
        """Whether the restart has to change it."""
        return self.wanted != self.now


@dataclass(frozen=True, slots=True)
class Plan:
    """A restart as the operator sees it before he confirms it."""

    found: Found
    begin: Begin
    rows: tuple[Beside, ...]
    starts: tuple[str, ...]  # what will turn, flow or switch on
    legs: tuple[Drawn, ...]
    trouble: str = ""  # why it cannot be started as the machine stands
    warning: str = ""  # where the way may meet the part


def plan_of(found: Found, snapshot: Snapshot, choices: Choices) -> Plan:
    """The plan from where the machine stands now."""
    now = Now(snapshot.demand, snapshot.modal)
    begin = begin_at(found, now, choices)
    legs = _drawn(begin, snapshot)
    return Plan(
        found=found,
        begin=begin,
        rows=_rows(begin.checkpoint, snapshot),
        starts=tuple(_words(step, found.checkpoint) for step in starting(found, now, choices)),
        legs=legs,
        warning="" if choices.inside else _through_stock(found, legs),
        trouble=_collet(found.checkpoint, snapshot) or _tool(found, snapshot),
    )


def _rows(point: Checkpoint, snapshot: Snapshot) -> tuple[Beside, ...]:
    wanted = (*_places(point, *point.machine), *rows_of(point))
    now = (*_places(point, *snapshot.demand[:2]), *rows_of(_now(snapshot)))
    both = zip(wanted, now, strict=True)
    return tuple(Beside(w.label, w.value, n.value) for w, n in both if w.key != "comment" or w.value)


def _now(snapshot: Snapshot) -> Checkpoint:
    return Checkpoint(snapshot.modal, c=snapshot.demand[2] - snapshot.modal.offset_c)


def _places(point: Checkpoint, x: float, z: float) -> tuple[InForce, ...]:
    """A machine point as the line would read it, with its tool, its unit and its Ø or R."""
    modal = point.modal
    mark, factor = ("Ø", 2.0) if modal.diameter else ("R", 1.0)
    return (
        InForce("x", f"X {mark}", formats.length(factor * (x - modal.offset_x), modal.metric)),
        InForce("z", "Z", formats.length(z - modal.offset_z, modal.metric)),
    )


def _words(step: Step, point: Checkpoint) -> str:
    action = getattr(step, "action", None)
    modal = point.modal
    match action:
        case SpindleRun():
            way = tr("SPINDLE FORWARD") if modal.spindle > 0 else tr("SPINDLE REVERSE")
            speed = next(row.value for row in rows_of(point) if row.key == "speed")
            return f"{way} {speed}"
        case SpindleLock():
            return tr("SPINDLE LOCKED AS C, TURNED TO ITS ANGLE")
        case Coolant():
            return tr("COOLANT")
        case Output(name=name):
            return tr("{name} ON").format(name=name.upper())
        case _:
            return ""


def _drawn(begin: Begin, snapshot: Snapshot) -> tuple[Drawn, ...]:
    """The legs in the frame of the tool that the line works with."""
    modal = begin.checkpoint.modal
    x, z = snapshot.demand[0], snapshot.demand[1]
    drawn = [Drawn(z - modal.tool_z, x - modal.tool_x)]
    for step in begin.way:
        if isinstance(step, Leg):
            x, z = x if step.x is None else step.x, z if step.z is None else step.z
            label = f"{len(drawn)} {step.text}"
            drawn.append(Drawn(z - modal.tool_z, x - modal.tool_x, step.rapid, label))
    return tuple(drawn)


def _tool(found: Found, snapshot: Snapshot) -> str:
    """Another tool than the one of the line may stand in the work, and nobody knows the way out of it."""
    now, wanted = snapshot.modal.tool, found.checkpoint.modal.tool
    if now == wanted or snapshot.demand[1] >= found.clear.z - _CLEAR:
        return ""
    words = tr("T{now} STANDS AT THE PART AND THE LINE WORKS WITH T{wanted}: JOG Z CLEAR OF THE PART FIRST")
    return words.format(now=now, wanted=wanted)


def _through_stock(found: Found, legs: tuple[Drawn, ...]) -> str:
    """A leg towards the spindle at a smaller radius than the program has fed at; in a bore every one is."""
    modal = found.checkpoint.modal
    for start, end in pairwise(legs):
        if end.z < start.z - _CLEAR and abs(end.x) < found.clear.stock - _DEEP:
            at, bar = (formats.length(r, modal.metric) for r in (abs(end.x), found.clear.stock))
            words = tr("LOOK: {leg} COMES IN AT R{at}, AND THE PROGRAM HAS CUT AT R{bar}")
            return words.format(leg=end.label, at=at, bar=bar)
    return ""


def _collet(point: Checkpoint, snapshot: Snapshot) -> str:
    wanted, now = point.modal.collet_closed, snapshot.modal.collet_closed
    if wanted == now:
        return ""
    if wanted:
        return tr("THE COLLET IS OPEN AND MUST BE CLOSED AT THIS LINE: M12 IN MDI")
    return tr("THE COLLET IS CLOSED AND MUST BE OPEN AT THIS LINE: M13 IN MDI")
