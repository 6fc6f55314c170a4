"""From the words of a PLANE block to its frame and the angles of the rotary axes; nothing moves here."""

from __future__ import annotations

from core.geometry.frames import (
    IDENTITY,
    X_AXIS,
    Y_AXIS,
    Z_AXIS,
    Matrix,
    NoFrameError,
    Vector,
    from_points,
    from_spatial,
    product,
    turned,
)
from core.geometry.swivel import Side, choose, fitting
from core.interpreter.klartext import words
from core.interpreter.klartext.standing import WorkingPlane
from core.interpreter.klartext.state import State
from core.language.diagnostics import Diagnostic, Severity
from core.language.klartext import faults
from core.language.klartext.nodes import AxisWord, Plane

_ABOUT = {"SPA": X_AXIS, "SPB": Y_AXIS, "SPC": Z_AXIS}


def working_plane(state: State, line: int, node: Plane) -> WorkingPlane:
    """The plane that the block tells. Raises ProgramError where there is none, or it cannot be reached."""
    if node.form == "AXIAL":
        return _axial(state, line, node)
    frame = _FORMS[node.form](state, line, node)
    side = Side(node.positioning.side) if node.positioning.side else None
    table_rot = node.positioning.rotation == "TABLE ROT"
    found = choose(state.kinematics, frame, state.rotary, side, table_rot=table_rot)
    if found is None:
        asked = f" with {side}" if side else ""
        text = f"No position of the rotary axes inside their ranges gives this plane{asked}."
        raise faults.fault(line, node.column, faults.ANGLE, text, "Look at points, angles and SYM.")
    if side is None and not state.table_known:
        _tell_of_two_ways(state, line, node, frame)
    return WorkingPlane(frame, found.angles, line)


def _tell_of_two_ways(state: State, line: int, node: Plane, frame: Matrix) -> None:
    """Which way the table swivels hangs on where it stands at the start, which no proof knows."""
    if len(fitting(state.kinematics, frame, state.rotary)) > 1:
        text = "Where the table stands at the start decides which of two ways it swivels."
        hint = "Write SYM+ or SYM-, or position the table before."
        state.log.add(Diagnostic(line, node.column, Severity.NOTE, "two-ways", text, hint))


def _axial(state: State, line: int, node: Plane) -> WorkingPlane:
    """The effective angle of each axis, set or added to; basic rotation plays no part."""
    angles = state.targets
    for word in node.words:
        axis = state.kinematics.rotary(word.axis)
        if axis is None:
            text = f"This machine has no rotary axis {word.axis}."
            raise faults.fault(line, word.column, faults.WRONG_AXIS, text, "Take the word out.")
        value = words.number(state, line, word.value, word.axis, words.MOST_ANGLE)
        angle = angles[axis.name] + value if word.incremental else value
        if not axis.inside(angle):
            text = f"{axis.name} {angle:+.7g} is not between {axis.low:g} and {axis.high:g}."
            raise faults.fault(line, word.column, faults.ANGLE, text, "Correct the angle.")
        angles[axis.name] = axis.shown(angle)
    return WorkingPlane(state.kinematics.frame(angles), angles, line)


def _points(state: State, line: int, node: Plane) -> Matrix:
    values = [
        words.number(state, line, word.value, word.axis, words.MOST_POINT) * state.scale
        for word in node.words
    ]
    p1, p2, p3 = (_vector(values[at : at + 3]) for at in (0, 3, 6))
    try:
        return product(state.kinematics.basic, from_points(p1, p2, p3))
    except NoFrameError as problem:
        text = f"{str(problem).capitalize()}."
        raise faults.fault(line, node.column, faults.PLANE_WRONG, text, "Correct the points.") from problem


def _spatial(state: State, line: int, node: Plane) -> Matrix:
    a, b, c = (_angle(state, line, word) for word in node.words)
    return product(state.kinematics.basic, from_spatial(a, b, c))


def _relative(state: State, line: int, node: Plane) -> Matrix:
    """About an axis of the plane in force, or of the workpiece's system where there is none."""
    (word,) = node.words
    base = state.plane.frame if state.plane is not None else product(state.kinematics.basic, IDENTITY)
    return product(base, turned(_ABOUT[word.axis], _angle(state, line, word)))


_FORMS = {"POINTS": _points, "SPATIAL": _spatial, "RELATIV": _relative}


def _angle(state: State, line: int, word: AxisWord) -> float:
    return words.number(state, line, word.value, word.axis, words.MOST_SPATIAL)


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return x, y, z
