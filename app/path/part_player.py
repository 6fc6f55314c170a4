"""The part view's player: which moment of the program is shown, while it runs or along a time line.

Metal is taken off on a worker; the screen looks at ``shown`` once a frame and never waits.
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

FAST = 10.0  # times
_RESTS = 0.25  # s after which a solid that nobody turns any more is drawn finely
_TELL = 0.08  # s; on a long way the part is shown so often

Place = tuple[float, float]


class SolidLook(NamedTuple):
    """How the part is looked at in space: a picture of so many pixels; ``quick``: a coarser one."""

    view: SolidView
    width: int
    height: int
    quick: bool = False


class Moment(NamedTuple):
    """So many blocks done, and ``share`` of the next; or, if ``behind_end`` is told, as much of it as lies
    before the tool, which is that far (Z, r; mm) off its end."""

    block: int = 0
    share: float = 0.0
    behind_end: Place | None = None
    solid: SolidLook | None = None


class PlayedInstant(NamedTuple):
    """What the worker has made: the part, and what was found in the whole program."""

    instant: PartInstant
    findings: tuple[Diagnostic, ...] = ()
    image: Image | None = None  # of the solid, where that is looked at


@dataclass(slots=True, eq=False)
class PartPlayer:
    """Of one view. While ``bound`` the run leads, and the keys of the time line do nothing."""

    worker: Latest = field(default_factory=lambda: Latest("part"))
    clock: Callable[[], float] = time.monotonic
    bound: bool = False
    playing: bool = False
    fast: bool = False
    t: float = 0.0  # program time of what is wanted, s
    trouble: str = ""  # why there is no part
    _picture: Picture | None = None
    _wanted: Moment = field(default_factory=Moment)
    _asked: Moment | None = None
    _played: PlayedInstant | None = None
    _looked: float = 0.0
    _turned: float = 0.0  # when it was last looked at from elsewhere
    _history: tuple[Picture, PartHistory] | None = None  # the worker's, as is what follows
    _findings: tuple[Diagnostic, ...] | None = None
    _painter: SolidPicture | None = None
    _solid: tuple[PartInstant, Solid] | None = None
    _draws: int = 0

    # --- which program -------------------------------------------------------------------------------

    def show(self, picture: Picture | None) -> None:
        """Another program, or the same with other offsets: seen at its end, until somebody plays it."""
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
        """Give up what is being made and end the worker."""
        self.worker.close()

    @property
    def duration(self) -> float:
        """Program seconds."""
        return float(self._picture.ends[-1]) if self._picture is not None else 0.0

    @property
    def played(self) -> PlayedInstant | None:
        """The latest that the worker has made; None: nothing yet."""
        return self._played

    @property
    def behind(self) -> bool:
        """Whether something else is wanted than what is shown."""
        return self.worker.busy or (self._picture is not None and self._asked != self._wanted)

    # --- once a frame --------------------------------------------------------------------------------

    def look(self) -> bool:
        """Take up what the worker has made, and want the next; whether there is something new to be seen."""
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
        """Wait for what is wanted; for scripts and tests, never for the screen."""
        self._ask()
        self.worker.settle(timeout)

    def _play(self, gone: float) -> None:
        self.want(self.t + min(gone, 0.25) * (FAST if self.fast else 1.0))
        if self.t >= self.duration:
            self.playing = False

    # --- in space ------------------------------------------------------------------------------------

    def look_at(self, solid: SolidLook | None) -> None:
        """The part in space is wanted, as it is looked at; None: it is not."""
        self._wanted = self._wanted._replace(solid=solid)
        self._turned = self.clock()

    def _draw_finely(self) -> None:
        """What moves is drawn in coarser points, and finely when it rests."""
        solid = self._wanted.solid
        if solid is not None:
            moving = self.playing or self.bound or self.clock() - self._turned < _RESTS
            if solid.quick is not moving:
                self._wanted = self._wanted._replace(solid=solid._replace(quick=moving))

    # --- the run leads -------------------------------------------------------------------------------

    def follow(self, block: int, behind_end: Place) -> None:
        """The tool is in this block, so far (Z, r; mm) off the place where it ends."""
        self.playing = False
        self._wanted = Moment(block - 1, 0.0, behind_end, self._wanted.solid)
        if self._picture is not None and 1 <= block < len(self._picture.ends):
            self.t = float(self._picture.ends[block])

    # --- the time line -------------------------------------------------------------------------------

    def seek(self, t: float) -> None:
        """Show the part at this time of the program, s; what was being made for another is given up."""
        self.want(t)
        if self._picture is not None:
            self._ask()

    def play_or_pause(self) -> None:
        """Go on in time, from the beginning when the end is shown; or stay."""
        if self.bound or self._picture is None:
            return
        self.playing, self._looked = not self.playing, self.clock()
        if self.playing and self.t >= self.duration:
            self.seek(0.0)

    def faster(self) -> None:
        """Ten times as fast, or as fast as the machine again."""
        self.fast = not self.fast

    def step(self, blocks: int) -> None:
        """To the end of the next block that moves (1), or of the one before (-1)."""
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
        """To the end of the first pass through a source line."""
        if not self.bound and self._picture is not None:
            self.playing = False
            self.seek(float(self._picture.ends[self._picture.block_of_line(line)]))

    def to_block(self, block: int) -> None:
        """To the end of an elementary block."""
        if not self.bound and self._picture is not None:
            self.playing = False
            self.want(float(self._picture.ends[min(block, len(self._picture.ends) - 1)]))

    def marks(self) -> npt.NDArray[np.float64]:
        """When errors of the part come up, s."""
        if self._played is None or self._picture is None:
            return np.zeros(0)
        ends = self._picture.ends
        errors = [each.n for each in self._played.findings if is_serious(each)]
        return np.array([ends[min(n, len(ends) - 1)] for n in errors])

    def want(self, t: float) -> None:
        """The part at this time of the program, s, as soon as somebody looks at it."""
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

    # --- the worker ----------------------------------------------------------------------------------

    def _ask(self) -> None:
        picture = self._picture
        if picture is None or picture.part is None or self._wanted == self._asked:
            return
        self._asked = self._wanted
        self.worker.ask(partial(self._make, picture, self._wanted), self._take, self._failed)

    def _make(self, picture: Picture, wanted: Moment, request: Request) -> PlayedInstant:
        """On the worker. A new program is first gone through to its end: then it is known what is wrong."""
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
        """The same as before where it is only turned."""
        if self._solid is not None:
            last = self._solid[0]
            if (last.block, last.share) == (block, share) and history.is_current(last):
                return last
        return history.at(block, share, watch)

    def _image(self, history: PartHistory, instant: PartInstant, look: SolidLook) -> Image | None:
        """On the worker: the part drawn in space."""
        from core.part.solid_picture import SolidPicture

        if self._painter is None:
            self._painter = SolidPicture()
        if self._solid is None or self._solid[0] is not instant:
            solid = history.solid(instant)
            if solid is None:
                return None
            self._solid, self._draws = (instant, solid), self._draws + 1
        # While the run leads, the view has C as it is measured.
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
        """On a long way: go on or give up, and show how far it has come."""
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
    """All of a desk; they end with it."""

    def close(self) -> None:
        """End their workers."""
        for player in self:
            player.close()


def player_of(desk: Desk) -> PartPlayer:
    """One more player of this desk."""
    players = desk.pages.find(PartPlayers)
    if players is None:
        players = PartPlayers()
        desk.pages.attach(players)
    players.append(PartPlayer())
    return players[-1]
