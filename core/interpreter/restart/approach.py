"""The way from where the slides stand to a line in the middle of a program, in the order of a lathe.

Outside: X off the part, Z out, X over the start, spindle and coolant, Z in, X in last. Inside a bore: Z out,
X, spindle and coolant, Z in last. How far is off the part is told by the program, which has been there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import copysign

from core.interpreter.actions import Coolant, Output, SpindleLock, SpindleRun, SpindleStop
from core.interpreter.begin import Begin, Do, Leg, Step, Turn
from core.interpreter.modal import Modal
from core.interpreter.restart.found import Found

_SAME = 1e-6  # mm
_INCH = 25.4
_TURN = 360.0


@dataclass(frozen=True, slots=True)
class Now:
    """The machine as it stands: machine point (x, z, c) and modal state, mm and degrees."""

    at: tuple[float, ...]
    modal: Modal


@dataclass(frozen=True, slots=True)
class Choices:
    """What the operator decides. ``rapid`` and ``last``: mm/s of the legs and of the last one."""

    inside: bool = False
    coolant: bool = True
    rapid: float = 100 * _INCH / 60
    last: float = 20 * _INCH / 60


def begin_at(found: Found, now: Now, choices: Choices) -> Begin:
    """The beginning of a pass that goes on from the line. C counts the turns that it really has made."""
    point, modal = found.checkpoint, found.checkpoint.modal
    if modal.c_locked:
        modal = modal._replace(offset_c=_near(point.c + modal.offset_c, now.at[2]) - point.c)
    modal = modal._replace(coolant=modal.coolant and choices.coolant)
    return Begin(point._replace(modal=modal), found.line, way=way(found, now, choices))


def way(found: Found, now: Now, choices: Choices) -> tuple[Step, ...]:
    """Everything between the standstill of now and the first block of the line."""
    return (*_stops(found.checkpoint.modal, now.modal), *_out(found, now, choices),
            *_starts(found, now, choices), *_in(found, now, choices))  # fmt: skip


def starting(found: Found, now: Now, choices: Choices) -> tuple[Step, ...]:
    """What will start to turn, flow or switch on: the operator has to confirm it."""
    return tuple(step for step in _starts(found, now, choices) if isinstance(step, Do))


def _stops(wanted: Modal, now: Modal) -> Iterator[Step]:
    """What runs and must not, before anything moves."""
    if now.spindle and now.spindle != wanted.spindle:
        yield Do(SpindleStop(), "M05")
    if now.coolant and not wanted.coolant:
        yield Do(Coolant(False), "M09")
    for name in sorted(now.outputs - wanted.outputs):
        yield Do(Output(name, False), f"{name.upper()} OFF")


def _starts(found: Found, now: Now, choices: Choices) -> Iterator[Step]:
    point, wanted = found.checkpoint, found.checkpoint.modal
    if wanted.c_locked:
        yield Do(SpindleLock(orient=False), "M89")
        yield Turn(_near(point.c + wanted.offset_c, now.at[2]), (wanted.c_rpm or 10.0) * 6.0, "C")
    elif wanted.spindle:
        surface = wanted.surface_speed if wanted.css else None
        text = f"{'M03' if wanted.spindle > 0 else 'M04'}"
        yield Do(SpindleRun(wanted.spindle * wanted.rpm, surface), text)
    for name in sorted(wanted.outputs - now.modal.outputs):
        yield Do(Output(name, True), f"{name.upper()} ON")
    if wanted.coolant and choices.coolant:
        yield Do(Coolant(True), "M08")


def _out(found: Found, now: Now, choices: Choices) -> Iterator[Leg]:
    """Off the part and over the start; the legs that are no way at all are left out."""
    x, z = now.at[0], now.at[1]
    goal_x, _ = found.checkpoint.machine
    clear_z = max(found.clear.z, z, found.checkpoint.machine[1])
    if not choices.inside:
        out = _clear_x(found, now.modal.tool, now.modal.tool_x, x)
        yield from _leg(choices.rapid, "X", x=x, to_x=out)
        x = out
    yield from _leg(choices.rapid, "Z", z=z, to_z=clear_z)
    over = goal_x if choices.inside else _over(found)
    yield from _leg(choices.rapid, "X", x=x, to_x=over)


def _in(found: Found, now: Now, choices: Choices) -> Iterator[Leg]:
    goal_x, goal_z = found.checkpoint.machine
    clear_z = max(found.clear.z, now.at[1], goal_z)
    if choices.inside:
        yield from _leg(choices.last, "Z", z=clear_z, to_z=goal_z, rapid=False)
        return
    yield from _leg(choices.rapid, "Z", z=clear_z, to_z=goal_z)
    yield from _leg(choices.last, "X", x=_over(found), to_x=goal_x, rapid=False)


def _over(found: Found) -> float:
    """Machine X at which the tool of the line stands off the part."""
    modal = found.checkpoint.modal
    return _clear_x(found, modal.tool, modal.tool_x, found.checkpoint.machine[0])


def _clear_x(found: Found, tool: int, tool_x: float, x: float) -> float:
    """The machine X farthest off the centre line, on the side of ``x``, where this tool has been."""
    low, high = found.clear.x.get(tool, (x, x))
    return max(high, x) if copysign(1.0, x - tool_x + _SAME) > 0.0 else min(low, x)


def _leg(
    feed: float,
    text: str,
    *,
    x: float = 0.0,
    to_x: float | None = None,
    z: float = 0.0,
    to_z: float | None = None,
    rapid: bool = True,
) -> Iterator[Leg]:
    way_x, way_z = 0.0 if to_x is None else to_x - x, 0.0 if to_z is None else to_z - z
    if abs(way_x) > _SAME or abs(way_z) > _SAME:
        yield Leg(to_x, to_z, feed, rapid, text)


def _near(angle: float, now: float) -> float:
    """The machine angle that stands for ``angle`` and is the nearest to where C is."""
    return angle + round((now - angle) / _TURN) * _TURN
