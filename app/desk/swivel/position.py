"""The figures of a mill: in the working plane, to go along its axes, and from home."""

from __future__ import annotations

from app.desk import formats
from app.desk.words import tr
from core.executor.snapshot import Snapshot
from core.interpreter.working_plane import Swivel

ANGLE_PLACES = 3  # the display step of a rotary table
_SLIDES = 3


def plane_figures(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """Where the tip stands in the working plane, mm, and the rotary axes as they are shown."""
    return (*swivel.system.place.point(_slides(snapshot.actual)), *_shown(snapshot, swivel))


def home_figures(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """Where the slides stand from home, and the rotary axes as they are shown."""
    return (*_slides(snapshot.actual), *_shown(snapshot, swivel))


def figures_to_go(snapshot: Snapshot, swivel: Swivel) -> tuple[float, ...]:
    """What is left of the block: along the axes of the working plane, and of the rotary axes."""
    end = snapshot.block_end if snapshot.block else snapshot.actual
    here, there = (swivel.system.place.point(_slides(at)) for at in (snapshot.actual, end))
    slides = (goal - at for goal, at in zip(there, here, strict=True))
    return (*slides, *(b - a for a, b in zip(snapshot.actual[_SLIDES:], end[_SLIDES:], strict=True)))


def system_words(swivel: Swivel | None) -> str:
    """Which system the figures count in."""
    if swivel is None:
        return tr("MACHINE")
    if not swivel.system.tilted:
        return tr("WORKPIECE")
    return tr("TILTED PLANE OF LINE {line}").format(line=swivel.system.line)


def angle(degrees: float) -> str:
    """A rotary axis."""
    return formats.fixed(degrees, ANGLE_PLACES)


def _slides(at: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = at[:_SLIDES]
    return x, y, z


def _shown(snapshot: Snapshot, swivel: Swivel) -> list[float]:
    """Rotary axes; of a modulo axis 0 to under 360, and what would be written as 360 is 0."""
    found = []
    for name, at in zip(snapshot.axes[_SLIDES:], snapshot.actual[_SLIDES:], strict=True):
        axis = swivel.system.kinematics.rotary(name)
        wraps = axis is not None and axis.modulo
        found.append(round(at, ANGLE_PLACES) % 360.0 if wraps else at)
    return found
