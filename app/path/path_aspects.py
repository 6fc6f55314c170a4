"""Views of the path view, the tool tip position in them, and the moves of an approach."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture
    from app.path.polyline import Polyline
    from core.executor.job import Job
    from core.executor.snapshot import Snapshot


class PathViewKind(Enum):
    """The views of a program that the path view can show.

    ``PATH`` is from above (X+ down, Z+ right). ``FACE`` looks at the end of the part, and ``SIDE`` is its
    unrolled side (Z+ right, C+ up). ``SECTION`` is the part cut along its axis, ``SOLID`` is the part in
    3D, and ``OPEN_SOLID`` is the solid part with one quarter removed.
    """

    PATH = "PATH"
    FACE = "FACE"
    SIDE = "SIDE"
    SECTION = "SECTION"
    SOLID = "SOLID"
    OPEN_SOLID = "OPEN"


SPATIAL_ASPECTS = frozenset({PathViewKind.SOLID, PathViewKind.OPEN_SOLID})
PART_ASPECTS = SPATIAL_ASPECTS | {PathViewKind.SECTION}


class TipPosition(NamedTuple):
    """Active block (0 if no block is active) and the tool tip position relative to the part, in mm.

    ``c`` is the programmed C position in degrees while C is locked, and otherwise None.
    ``center_height_mm`` is the height of the center line of a mill. ``stop_position`` is the position at
    which an interrupted block stopped.
    """

    active_block_number: int = 0
    z: float = 0.0
    x: float = 0.0
    c: float | None = None
    center_height_mm: float = 0.0
    stop_position: tuple[float, float] | None = (
        None  # Z and X where an interrupted block stopped, if different
    )


AspectView = tuple[PathViewKind, ...]


def find_tip_position(snapshot: Snapshot, job: Job | None = None) -> TipPosition:
    """Return the current tip position.

    If ``job`` was interrupted, the result also contains the block and position of the interruption.
    """
    modal = snapshot.modal
    x, z, *rotary = snapshot.actual
    turned = rotary[0] - modal.offset_c if rotary and modal.c_locked else None
    h = getattr(modal.mill.frame, "tool_height_mm", 0.0) if modal.mill is not None else 0.0
    tip = TipPosition(snapshot.block, z - modal.drawing_zero_z, x - modal.drawing_zero_x, turned, h)
    found = snapshot.interrupted
    if snapshot.block or found is None or job is None or found.text != job.text_digest:
        return tip
    tool = job.setup.tools.get(found.tool)
    if tool is None:
        return tip
    return tip._replace(
        active_block_number=found.block, stop_position=(found.where[1] - tool.z, found.where[0] - tool.x)
    )


def select_polyline(picture: ProgramPicture | None, aspect: PathViewKind) -> Polyline | None:
    """Return the polyline of a program picture for this view, or None if the view would be empty."""
    if picture is None or aspect is PathViewKind.PATH or aspect in PART_ASPECTS:
        return picture
    return picture.face if aspect is PathViewKind.FACE else picture.side


def list_available_views(picture: ProgramPicture, *, has_part: bool = False) -> list[AspectView]:
    """Return the available views of a program, in the order in which the view key selects them.

    The list starts with the path next to a face or side that is machined with the C axis. Next are the face
    and the side alone. If ``has_part`` is True, the views of the part come last.
    """
    more = [
        aspect
        for aspect in (PathViewKind.FACE, PathViewKind.SIDE)
        if select_polyline(picture, aspect) is not None
    ]
    both = [(PathViewKind.PATH, aspect) for aspect in more]
    views = [*both, *((aspect,) for aspect in more), (PathViewKind.PATH,)]
    if not has_part:
        return views
    if picture.part is None:
        return (
            [*views, (PathViewKind.SECTION,)] if picture.no_part else views
        )  # The section shows the reason.
    return [*views, (PathViewKind.SECTION,), (PathViewKind.SOLID,), (PathViewKind.OPEN_SOLID,)]


# --- legs of an approach ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ApproachLeg:
    """One straight move of an approach to (z, x), relative to the part, in mm, with X as a radius.

    The position is the machine position minus the tool offset. ``label`` is the number and the axis, for
    example ``1 X``. The first leg is only the current tool position, so its ``is_rapid`` is ignored.
    """

    z: float
    x: float
    is_rapid: bool = True
    label: str = ""
