"""Aspects of the path view: from where a program is looked at, where the tip is, legs of an approach."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from app.path.path_picture import Picture
    from app.path.polyline import Polyline
    from core.executor.job import Job
    from core.executor.snapshot import Snapshot


class Aspect(Enum):
    """From above (X+ down, Z+ right), onto the end of the part, onto its side unrolled (Z+ right, C+ up).

    ``SECTION`` is the part itself, cut along its axis, as from above; ``SOLID`` the same in space, ``OPEN``
    with a quarter taken out.
    """

    PATH = "PATH"
    FACE = "FACE"
    SIDE = "SIDE"
    SECTION = "SECTION"
    SOLID = "SOLID"
    OPEN = "OPEN"


IN_SPACE = frozenset({Aspect.SOLID, Aspect.OPEN})
OF_PART = IN_SPACE | {Aspect.SECTION}


class Tip(NamedTuple):
    """Where the program is: block under way (0: none), and the tool tip in the part's frame, mm.

    ``c`` is the program's C while it is locked, degrees, else None; ``h`` the height of a mill's centre line.
    """

    block: int = 0
    z: float = 0.0
    x: float = 0.0
    c: float | None = None
    h: float = 0.0
    stood: tuple[float, float] | None = None  # Z and X where the block was broken off, when elsewhere


View = tuple[Aspect, ...]


def tip_of(snapshot: Snapshot, job: Job | None = None) -> Tip:
    """The tip as the machine stands now; of the interrupted ``job`` what was done of it stays."""
    modal = snapshot.modal
    x, z, *rotary = snapshot.actual
    turned = rotary[0] - modal.offset_c if rotary and modal.c_locked else None
    h = getattr(modal.mill.frame, "h", 0.0) if modal.mill is not None else 0.0
    tip = Tip(snapshot.block, z - modal.base_z, x - modal.base_x, turned, h)
    found = snapshot.interrupted
    if snapshot.block or found is None or job is None or found.text != job.text_digest:
        return tip
    tool = job.setup.tools.get(found.tool)
    if tool is None:
        return tip
    return tip._replace(block=found.block, stood=(found.where[1] - tool.z, found.where[0] - tool.x))


def polyline_of(picture: Picture | None, aspect: Aspect) -> Polyline | None:
    """What is to be seen from there."""
    if picture is None or aspect is Aspect.PATH or aspect in OF_PART:
        return picture
    return picture.face if aspect is Aspect.FACE else picture.side


def views_of(picture: Picture, *, part: bool = False) -> list[View]:
    """What the view key goes through: the path with what is cut at C beside it, then each alone; then the
    ``part``, where there is one to be shown."""
    more = [aspect for aspect in (Aspect.FACE, Aspect.SIDE) if polyline_of(picture, aspect) is not None]
    both = [(Aspect.PATH, aspect) for aspect in more]
    views = [*both, *((aspect,) for aspect in more), (Aspect.PATH,)]
    if not part:
        return views
    if picture.part is None:
        return [*views, (Aspect.SECTION,)] if picture.no_part else views  # where it is told
    return [*views, (Aspect.SECTION,), (Aspect.SOLID,), (Aspect.OPEN,)]


# --- legs of an approach ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class DrawnLeg:
    """One straight move to (z, x) in the part's frame (machine less tool offset); mm, X a radius.

    ``label`` tells what it is and when: ``1 X``, ``2 Z``. The first leg is where the tool stands now; its
    ``rapid`` means nothing.
    """

    z: float
    x: float
    rapid: bool = True
    label: str = ""
