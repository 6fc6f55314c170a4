"""Player of the part view: shows the part at a moment of the program, during a run or along a time line.

A worker thread removes the material. The screen polls the result once per frame and never waits.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from app.desk.background_work import Latest, Request
from core.language.diagnostics import Diagnostic
from core.proving.checks.part_checks import is_serious

if TYPE_CHECKING:
    from app.desk.desk import Desk
    from app.path.path_picture import Picture
    from core.part.solid_picture import Image, SolidPicture
    from core.part.solid_view import SolidView
    from core.part.surface_points import Solid
    from core.proving.part_history import PartHistory
    from core.proving.part_instant import PartInstant

FAST = 10.0  # times the program speed
_RESTS = 0.25  # seconds after which an image that no longer moves is drawn in full resolution
_TELL = 0.08  # seconds between two images during a long calculation

Place = tuple[float, float]


class SolidLook(NamedTuple):
    """3D view of the part and the image size in pixels. ``quick`` selects a coarser image."""

    view: SolidView
    width: int
    height: int
    quick: bool = False


class Moment(NamedTuple):
    """Position in the program: ``block`` finished blocks and the ``share`` of the next block.

    If ``behind_end`` is set, it replaces ``share``: the offset of the tool from the end of the block as (Z,
    radius), in millimeters.
    """

    block: int = 0
    share: float = 0.0
    behind_end: Place | None = None
    solid: SolidLook | None = None


class PlayedInstant(NamedTuple):
    """Result of the worker: the part at one instant and the findings of the whole program."""

    instant: PartInstant
    findings: tuple[Diagnostic, ...] = ()
    image: Image | None = None  # image of the solid, if a 3D view is shown


@dataclass(slots=True, eq=False)
class PartPlayer:
    """Player of one view.

    While ``bound`` is set, the run leads and the time line keys do nothing.
    """

    worker: Latest = field(default_factory=lambda: Latest("part"))
    clock: Callable[[], float] = time.monotonic
    bound: bool = False
    playing: bool = False
    fast: bool = False
    t: float = 0.0  # requested program time in seconds
    trouble: str = ""  # reason why no part is shown
    _picture: Picture | None = None
    _wanted: Moment = field(default_factory=Moment)
    _asked: Moment | None = None
    _played: PlayedInstant | None = None
    _looked: float = 0.0
    _turned: float = 0.0  # time of the last change of the view
    # used only on the worker, as are the following attributes
    _history: tuple[Picture, PartHistory] | None = None
    _findings: tuple[Diagnostic, ...] | None = None
    _painter: SolidPicture | None = None
    _solid: tuple[PartInstant, Solid] | None = None
    _draws: int = 0

    # --- selection of the program --------------------------------------------------------------------

    def show(self, picture: Picture | None) -> None:
        """Load a picture. The part is shown at the end of the program until the operator plays it."""
        if picture is self._picture:
            return
        self.worker.give_up()
        before, self._picture = self._picture, picture
        self._asked, self.playing, self.trouble = None, False, picture.no_part if picture is not None else ""
        if picture is None or before is None:
            self._played = None
        if not self.bound:
            self.want(self.duration)

    def close(self) -> None:
        """Cancel the pending work and stop the worker."""
        self.worker.close()

    @property
    def duration(self) -> float:
        """Duration of the program in seconds."""
        return float(self._picture.ends[-1]) if self._picture is not None else 0.0

    @property
    def played(self) -> PlayedInstant | None:
        """Latest result of the worker, or None before the first result."""
        return self._played

    @property
    def behind(self) -> bool:
        """Whether the requested part differs from the displayed part."""
        return self.worker.busy or (self._picture is not None and self._asked != self._wanted)

    # --- update once per frame -----------------------------------------------------------------------

    def look(self) -> bool:
        """Fetch the result of the worker, request the next one, and return whether the view changed."""
        shown, now = self._played, self.clock()
        gone, self._looked = now - self._looked, now
        self.worker.poll()
        if self.playing:
            self._play(gone)
        self._draw_finely()
        if not self.worker.busy:
            self._ask()
        return self._played is not shown or self.playing

    def settle(self, timeout: float) -> None:
        """Wait for the requested part; for scripts and tests only, because the call blocks."""
        self._ask()
        self.worker.settle(timeout)

    def _play(self, gone: float) -> None:
        self.want(self.t + min(gone, 0.25) * (FAST if self.fast else 1.0))
        if self.t >= self.duration:
            self.playing = False

    # --- 3D view -------------------------------------------------------------------------------------

    def look_at(self, solid: SolidLook | None) -> None:
        """Set the 3D view to render. None turns off 3D rendering."""
        self._wanted = self._wanted._replace(solid=solid)
        self._turned = self.clock()

    def _draw_finely(self) -> None:
        """Request a coarse image while the view moves, and a fine image when it rests."""
        solid = self._wanted.solid
        if solid is not None:
            moving = self.playing or self.bound or self.clock() - self._turned < _RESTS
            if solid.quick is not moving:
                self._wanted = self._wanted._replace(solid=solid._replace(quick=moving))

    # --- following the run ---------------------------------------------------------------------------

    def follow(self, block: int, behind_end: Place) -> None:
        """Follow the run in a block.

        The offset (Z, radius) of the tool from the block's end is in mm.
        """
        self.playing = False
        self._wanted = Moment(block - 1, 0.0, behind_end, self._wanted.solid)
        if self._picture is not None and 1 <= block < len(self._picture.ends):
            self.t = float(self._picture.ends[block])

    # --- the time line -------------------------------------------------------------------------------

    def seek(self, t: float) -> None:
        """Show the part at a program time in seconds, and cancel the pending request."""
        self.want(t)
        if self._picture is not None:
            self._ask()

    def play_or_pause(self) -> None:
        """Start or pause playback. Playback starts at the beginning if the end is shown."""
        if self.bound or self._picture is None:
            return
        self.playing, self._looked = not self.playing, self.clock()
        if self.playing and self.t >= self.duration:
            self.seek(0.0)

    def faster(self) -> None:
        """Switch between program speed and fast playback."""
        self.fast = not self.fast

    def step(self, blocks: int) -> None:
        """Move to the end of the next block with motion (1) or of the previous one (-1)."""
        if self.bound or self._picture is None:
            return
        self.playing = False
        ends = self._picture.ends
        moves = np.flatnonzero(np.diff(ends) > 0.0) + 1
        there = ends[moves] if len(moves) else np.zeros(1)
        if blocks > 0:
            at = int(np.searchsorted(there, self.t + 1e-9, side="right"))
            self.seek(float(there[min(at, len(there) - 1)]))
        else:
            at = int(np.searchsorted(there, self.t - 1e-9, side="left")) - 1
            self.seek(float(there[at]) if at >= 0 else 0.0)

    def to_line(self, line: int) -> None:
        """Move to the end of the first pass through a source line."""
        if not self.bound and self._picture is not None:
            self.playing = False
            self.seek(float(self._picture.ends[self._picture.block_of_line(line)]))

    def to_block(self, block: int) -> None:
        """Move to the end of an elementary block."""
        if not self.bound and self._picture is not None:
            self.playing = False
            self.want(float(self._picture.ends[min(block, len(self._picture.ends) - 1)]))

    def marks(self) -> npt.NDArray[np.float64]:
        """Return the program times of the errors of the part, in seconds."""
        if self._played is None or self._picture is None:
            return np.zeros(0)
        ends = self._picture.ends
        errors = [each.n for each in self._played.findings if is_serious(each)]
        return np.array([ends[min(n, len(ends) - 1)] for n in errors])

    def want(self, t: float) -> None:
        """Request the part at a program time in seconds. The next ``look`` starts the work."""
        self.t = min(max(t, 0.0), self.duration)
        if self._picture is None:
            return
        ends = self._picture.ends
        block = min(int(np.searchsorted(ends, self.t + 1e-9, side="right")) - 1, len(ends) - 1)
        block = max(block, 0)
        share = 0.0
        if block < len(ends) - 1:
            length = float(ends[block + 1] - ends[block])
            share = (self.t - float(ends[block])) / length if length > 0.0 else 0.0
        self._wanted = Moment(block, min(max(share, 0.0), 1.0), None, self._wanted.solid)

    # --- worker --------------------------------------------------------------------------------------

    def _ask(self) -> None:
        picture = self._picture
        if picture is None or picture.part is None or self._wanted == self._asked:
            return
        self._asked = self._wanted
        self.worker.ask(partial(self._make, picture, self._wanted), self._take, self._failed)

    def _make(self, picture: Picture, wanted: Moment, request: Request) -> PlayedInstant:
        """Calculate the requested instant, on the worker.

        A new program is first simulated to its end, so that all findings are known.
        """
        history = self._history_of(picture)
        watch = partial(self._tell, history, request, [self.clock()])
        if self._findings is None:
            self._findings = history.at(len(picture.ends) - 1, 0.0, watch).findings
        share = wanted.share
        if wanted.behind_end is not None:
            share = history.share_at(wanted.block + 1, wanted.behind_end)
        image = None
        instant = self._instant(history, wanted.block, share, watch)
        if wanted.solid is not None:
            image = self._image(history, instant, wanted.solid)
        return PlayedInstant(instant, self._findings, image)

    def _instant(
        self, history: PartHistory, block: int, share: float, watch: Callable[[], None]
    ) -> PartInstant:
        """Return the instant, reusing the last one if only the view has turned."""
        if self._solid is not None:
            last = self._solid[0]
            if (last.block, last.share) == (block, share) and history.is_current(last):
                return last
        return history.at(block, share, watch)

    def _image(self, history: PartHistory, instant: PartInstant, look: SolidLook) -> Image | None:
        """Return the 3D image of the part, on the worker, or None without a solid."""
        from core.part.solid_picture import SolidPicture

        if self._painter is None:
            self._painter = SolidPicture()
        if self._solid is None or self._solid[0] is not instant:
            solid = history.solid(instant)
            if solid is None:
                return None
            self._solid, self._draws = (instant, solid), self._draws + 1
        # While the run leads, the view uses the measured C position.
        view = look.view if self.bound else replace(look.view, roll=instant.c)
        spans = tuple(
            (float(hit.z.min()) - hit.wide / 2, float(hit.z.max()) + hit.wide / 2) for hit in instant.hits
        )
        return self._painter.draw(
            self._solid[1],
            view,
            look.width,
            look.height,
            version=self._draws,
            hits=spans,
            quick=look.quick,
            around=history.scene_at(instant),
        )

    def _history_of(self, picture: Picture) -> PartHistory:
        from core.proving.part_history import PartHistory

        if self._history is None or self._history[0] is not picture:
            assert picture.part is not None
            self._solid = None
            self._history, self._findings = (picture, PartHistory(picture.part)), None
        return self._history[1]

    def _tell(self, history: PartHistory, request: Request, told: list[float]) -> None:
        """Continue or cancel a long calculation, and publish an intermediate result."""
        request()
        now = self.clock()
        if now - told[0] > _TELL:
            told[0] = now
            request.publish(partial(self._take, PlayedInstant(history.now(), self._findings or ())))

    def _take(self, shown: PlayedInstant) -> None:
        self._played = shown

    def _failed(self, why: str) -> None:
        self.trouble, self._played = why, None


class PartPlayers(list[PartPlayer]):
    """All part players of one operator screen, closed together with the screen."""

    def close(self) -> None:
        """Stop all workers."""
        for player in self:
            player.close()


def player_of(desk: Desk) -> PartPlayer:
    """Return a new part player that closes together with ``desk``."""
    players = desk.pages.find(PartPlayers)
    if players is None:
        players = PartPlayers()
        desk.pages.attach(players)
    players.append(PartPlayer())
    return players[-1]
