"""Where the virtual mill of plane switching stands: part of the modal state between two of its moves."""

from __future__ import annotations

from typing import NamedTuple

from core.geometry.face import Face
from core.geometry.side import Side


class Mill(NamedTuple):
    """The frame and the point reached in it; mm, Z a radius on the side of the part. ``theta`` (radians) is
    the polar angle of the point, counted on; ``fresh`` holds until a move or an F: H may still be set."""

    frame: Face | Side
    x: float
    y: float
    z: float
    theta: float = 0.0
    fresh: bool = True
