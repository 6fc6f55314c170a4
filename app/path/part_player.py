"""Player of the part view, which shows the part at a selected moment of the program.

The moment follows the running program, or the operator selects it on a timeline. A worker thread calculates
the material removal. The screen polls the result once a frame and never waits.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from app.desk.background_work import LatestRequestWorker, WorkRequest
from core.language.diagnostics import Diagnostic
from core.proving.checks.part_checks import is_serious_finding

if TYPE_CHECKING:
    from app.desk.desk import Desk
    from app.path.path_picture import ProgramPicture
    from core.part.picture.solid_picture import PartImage, SolidPicture
    from core.part.picture.solid_view import SolidView
    from core.part.picture.surface_points import Solid
    from core.proving.part_history import PartHistory
    from core.proving.part_instant import PartState

FAST_FACTOR = 10.0  # times the program speed
_REST_TIME_S = 0.1  # seconds after which an image that no longer moves is drawn in full resolution
_SMALL_FRAME_TIME_S = 0.028  # seconds to draw one of 30 images/s, less the time to show it
_LARGE_FRAME_TIME_S = 0.055  # seconds to draw one of 15 images/s
_LARGE_IMAGE_PX = 1_000_000  # pixels from which 15 images/s are enough
_MAX_PIXEL_SIZE = 4  # pixels
_IMAGE_INTERVAL_S = 0.08  # seconds between two images during a long calculation

ZRadius = tuple[float, float]


class SolidImageRequest(NamedTuple):
    """Request for a 3D image: the view of the part and the image size in pixels.

    ``is_coarse`` selects a coarser image. ``is_stock_shown`` draws the transparent stock around the part.
    """

    view: SolidView
    width_px: int
    height_px: int
    is_coarse: bool = False
    is_stock_shown: bool = False


class ProgramInstant(NamedTuple):
    """Moment of a program: the number of finished blocks and the finished fraction of the next block.

    If ``block_end_offset_mm`` is not None, it is used instead of the fraction. It is the offset of the tool
    from the end of the block as (Z, radius), in millimeters.
    """

    finished_block_count: int = 0
    next_block_fraction: float = 0.0
    block_end_offset_mm: ZRadius | None = None
    image_request: SolidImageRequest | None = None


class PlaybackResult(NamedTuple):
    """Result of the worker thread: the part at one moment, and the findings of the whole program."""

    part_instant: PartState
    findings: tuple[Diagnostic, ...] = ()
    picture: PartImage | None = None  # picture of the solid, if a 3D view is shown
    view: SolidView | None = None  # view of this picture in pixels of the screen
    pixel_size: int = 1  # width and height of a pixel of the image in pixels of the screen


@dataclass(slots=True, eq=False)
class PartPlayer:
    """Player of one part view.

    While ``follows_run`` is True, the view shows the running program, and the timeline keys have no effect.
    """

    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("part"))
    read_time_s: Callable[[], float] = time.monotonic
    follows_run: bool = False
    is_playing: bool = False
    is_fast_playback: bool = False
    program_time_s: float = 0.0  # requested program time in seconds
    error_text: str = ""  # reason why no part is shown
    _picture: ProgramPicture | None = None
    _wanted: ProgramInstant = field(default_factory=ProgramInstant)
    _asked: ProgramInstant | None = None
    _played: PlaybackResult | None = None
    _reported: PlaybackResult | None = None  # result at the last update
    _looked: float = 0.0
    _turned: float = 0.0  # time of the last change of the view
    # used only on the worker, as are the following attributes
    _history: tuple[ProgramPicture, PartHistory] | None = None
    _findings: tuple[Diagnostic, ...] | None = None
    _painter: SolidPicture | None = None
    _solid: tuple[PartState, Solid] | None = None
    _draws: int = 0
    _pixel_size: int = 2  # of coarse images; adapted to the time that the images take

    # --- selection of the program --------------------------------------------------------------------

    def load_picture(self, picture: ProgramPicture | None) -> None:
        """Load the picture of a program, or None for no program.

        The part is shown at the end of the program until the operator starts playback.
        """
        if picture is self._picture:
            return
        self.worker.cancel_request()
        before, self._picture = self._picture, picture
        self._asked, self.is_playing, self.error_text = (
            None,
            False,
            picture.no_part if picture is not None else "",
        )
        if picture is None or before is None:
            self._played = None
        if not self.follows_run:
            self.request_part_at_time(self.duration_s)

    def close(self) -> None:
        """Cancel the pending work and stop the worker."""
        self.worker.close()

    @property
    def duration_s(self) -> float:
        """Return the duration of the program in seconds."""
        return float(self._picture.ends[-1]) if self._picture is not None else 0.0

    @property
    def latest_result(self) -> PlaybackResult | None:
        """Return the latest result of the worker, or None before the first result."""
        return self._played

    @property
    def is_outdated(self) -> bool:
        """Return whether the display does not yet show the requested state of the part."""
        return self.worker.is_busy or (self._picture is not None and self._asked != self._wanted)

    # --- update once per frame -----------------------------------------------------------------------

    def update(self) -> bool:
        """Fetch the result of the worker, request the next result, and return whether the view changed."""
        shown, now = self._reported, self.read_time_s()
        gone, self._looked = now - self._looked, now
        self.worker.deliver_results()
        if self.is_playing:
            self._play(gone)
        self._request_image()
        if not self.worker.is_busy or self._is_drawing_old_image():
            self._ask()
        self._reported = self._played
        return self._reported is not shown or self.is_playing

    def wait_for_result(self, timeout_s: float) -> None:
        """Wait until the requested state of the part is calculated.

        This call blocks. Use it only in scripts and tests.
        """
        self._ask()
        self.worker.wait_for_results(timeout_s)

    def _play(self, gone: float) -> None:
        self.request_part_at_time(
            self.program_time_s + min(gone, 0.25) * (FAST_FACTOR if self.is_fast_playback else 1.0)
        )
        if self.program_time_s >= self.duration_s:
            self.is_playing = False

    # --- 3D view -------------------------------------------------------------------------------------

    def set_image_request(self, solid: SolidImageRequest | None) -> None:
        """Set the 3D view to render, or turn off 3D rendering with None."""
        self._wanted = self._wanted._replace(image_request=solid)
        self._turned = self.read_time_s()

    def _request_image(self) -> None:
        """Request a coarse image while the view moves, and a fine image when the view is at rest."""
        solid = self._wanted.image_request
        if solid is not None:
            moving = self.is_playing or self.follows_run or self.read_time_s() - self._turned < _REST_TIME_S
            if solid.is_coarse is not moving:
                self._wanted = self._wanted._replace(image_request=solid._replace(is_coarse=moving))

    def _is_drawing_old_image(self) -> bool:
        """Return whether the worker is drawing an image in full resolution for a view that has changed."""
        asked, wanted = self._asked, self._wanted
        return (
            asked is not None
            and asked.image_request is not None
            and not asked.image_request.is_coarse
            and wanted != asked
        )

    # --- following the run ---------------------------------------------------------------------------

    def follow_run(self, block_number: int, end_offset_mm: ZRadius) -> None:
        """Show the part at the current position of the running program.

        ``end_offset_mm`` is the offset (Z, radius) of the tool from the end of the block, in mm.
        """
        self.is_playing = False
        self._wanted = ProgramInstant(block_number - 1, 0.0, end_offset_mm, self._wanted.image_request)
        if self._picture is not None and 1 <= block_number < len(self._picture.ends):
            self.program_time_s = float(self._picture.ends[block_number])

    # --- the time line -------------------------------------------------------------------------------

    def seek_time(self, time_s: float) -> None:
        """Show the part at a program time in seconds, and cancel an unfinished request for another time."""
        self.request_part_at_time(time_s)
        if self._picture is not None:
            self._ask()

    def make_key_actions(self) -> dict[str, Callable[[], None]]:
        """Return the actions of the timeline keys."""
        return {
            "Play": self.toggle_playback,
            "Play fast": self.toggle_fast_playback,
            "Step back": partial(self.step_by_blocks, -1),
            "Step forward": partial(self.step_by_blocks, 1),
        }

    def toggle_playback(self) -> None:
        """Start or pause playback.

        If the end is shown, playback starts at the beginning.
        """
        if self.follows_run or self._picture is None:
            return
        self.is_playing, self._looked = not self.is_playing, self.read_time_s()
        if self.is_playing and self.program_time_s >= self.duration_s:
            self.seek_time(0.0)

    def toggle_fast_playback(self) -> None:
        """Switch between program speed and fast playback."""
        self.is_fast_playback = not self.is_fast_playback

    def step_by_blocks(self, step_count: int) -> None:
        """Move to the end of the next block with motion (1) or of the previous block with motion (-1)."""
        if self.follows_run or self._picture is None:
            return
        self.is_playing = False
        ends = self._picture.ends
        moves = np.flatnonzero(np.diff(ends) > 0.0) + 1
        there = ends[moves] if len(moves) else np.zeros(1)
        if step_count > 0:
            at = int(np.searchsorted(there, self.program_time_s + 1e-9, side="right"))
            self.seek_time(float(there[min(at, len(there) - 1)]))
        else:
            at = int(np.searchsorted(there, self.program_time_s - 1e-9, side="left")) - 1
            self.seek_time(float(there[at]) if at >= 0 else 0.0)

    def seek_line(self, line_number: int) -> None:
        """Move to the end of the first execution of a source line."""
        if not self.follows_run and self._picture is not None:
            self.is_playing = False
            self.seek_time(float(self._picture.ends[self._picture.find_block_for_line(line_number)]))

    def seek_block(self, block_number: int) -> None:
        """Move to the end of an elementary block."""
        if not self.follows_run and self._picture is not None:
            self.is_playing = False
            self.request_part_at_time(
                float(self._picture.ends[min(block_number, len(self._picture.ends) - 1)])
            )

    def find_error_times(self) -> npt.NDArray[np.float64]:
        """Return the program times at which the part simulation found errors, in seconds."""
        if self._played is None or self._picture is None:
            return np.zeros(0)
        ends = self._picture.ends
        errors = [each.block_number for each in self._played.findings if is_serious_finding(each)]
        return np.array([ends[min(n, len(ends) - 1)] for n in errors])

    def request_part_at_time(self, time_s: float) -> None:
        """Request the part at a program time in seconds.

        The next call of ``update`` starts the work.
        """
        self.program_time_s = min(max(time_s, 0.0), self.duration_s)
        if self._picture is None:
            return
        ends = self._picture.ends
        block = min(int(np.searchsorted(ends, self.program_time_s + 1e-9, side="right")) - 1, len(ends) - 1)
        block = max(block, 0)
        share = 0.0
        if block < len(ends) - 1:
            length = float(ends[block + 1] - ends[block])
            share = (self.program_time_s - float(ends[block])) / length if length > 0.0 else 0.0
        self._wanted = ProgramInstant(block, min(max(share, 0.0), 1.0), None, self._wanted.image_request)

    # --- worker --------------------------------------------------------------------------------------

    def _ask(self) -> None:
        picture = self._picture
        if picture is None or picture.part is None or self._wanted == self._asked:
            return
        self._asked = self._wanted
        self.worker.request_work(partial(self._make_result, picture, self._wanted), self._take, self._failed)

    def _make_result(
        self, picture: ProgramPicture, wanted: ProgramInstant, request: WorkRequest
    ) -> PlaybackResult:
        """Calculate the part at the requested moment, on the worker thread.

        A new program is first simulated to its end, so that all findings are known.
        """
        history = self._history_of(picture)
        watch = partial(self._publish_progress, history, request, [self.read_time_s()])
        if self._findings is None:
            self._findings = history.at(len(picture.ends) - 1, 0.0, watch).findings
        share = wanted.next_block_fraction
        if wanted.block_end_offset_mm is not None:
            share = history.find_executed_fraction(
                wanted.finished_block_count + 1, wanted.block_end_offset_mm
            )
        instant = self._find_instant(history, wanted.finished_block_count, share, watch)
        result = PlaybackResult(instant, self._findings)
        if wanted.image_request is not None:
            for picture_result in self._render_images(history, result, wanted.image_request, request):
                request.publish_result(partial(self._take, picture_result))
                result = picture_result
        return result

    def _find_instant(
        self, history: PartHistory, block: int, share: float, watch: Callable[[], None]
    ) -> PartState:
        """Return the part after ``block`` blocks and the fraction ``share`` of the next block.

        The last result is reused if it is still valid, for example if only the view was rotated.
        """
        if self._solid is not None:
            last = self._solid[0]
            if (last.block_count, last.next_block_fraction) == (block, share) and history.is_current_instant(
                last
            ):
                return last
        return history.at(block, share, watch)

    def _render_images(
        self, history: PartHistory, shown: PlaybackResult, look: SolidImageRequest, request: WorkRequest
    ) -> Iterator[PlaybackResult]:
        """Yield the result with its 3D image, and again with smooth edges if the view is at rest.

        This runs on the worker. Nothing is yielded without a solid.
        """
        from core.part.picture.solid_picture import SolidPicture
        from core.part.picture.solid_view import make_coarse_view

        instant = shown.part_instant
        if self._painter is None:
            self._painter = SolidPicture()
        if self._solid is None or self._solid[0] is not instant:
            solid = history.make_solid(instant)
            if solid is None:
                return
            self._solid, self._draws = (instant, solid), self._draws + 1
        # While the run leads, the view uses the measured C position.
        view = look.view if self.follows_run else replace(look.view, roll_deg=instant.c_angle_deg)
        pixel_size = self._pixel_size if look.is_coarse else 1
        seen = make_coarse_view(view, look.width_px, look.height_px, pixel_size)
        begin = self.read_time_s()
        images = self._painter.refine_picture(
            self._solid[1],
            *seen,
            version=self._draws,
            hit_z_spans=_find_hit_spans(instant),
            scene=history.make_scene_at(instant, has_stock=look.is_stock_shown),
            check_canceled=None if look.is_coarse else request,
        )
        for drawn in images:
            yield shown._replace(picture=drawn, view=view, pixel_size=pixel_size)
            if look.is_coarse:
                self._adapt_pixel_size(look, self.read_time_s() - begin)
                return

    def _adapt_pixel_size(self, look: SolidImageRequest, duration_s: float) -> None:
        """Change the pixel size of coarse images so that they are drawn fast enough."""
        is_large = look.width_px * look.height_px > _LARGE_IMAGE_PX
        limit = _LARGE_FRAME_TIME_S if is_large else _SMALL_FRAME_TIME_S
        size = self._pixel_size
        if duration_s > limit:
            self._pixel_size = min(size + 1, _MAX_PIXEL_SIZE)
        elif size > 1 and duration_s * (size / (size - 1)) ** 2 < 0.8 * limit:
            self._pixel_size = size - 1

    def _history_of(self, picture: ProgramPicture) -> PartHistory:
        from core.proving.part_history import PartHistory

        if self._history is None or self._history[0] is not picture:
            assert picture.part is not None
            self._solid = None
            self._history, self._findings = (picture, PartHistory(picture.part)), None
        return self._history[1]

    def _publish_progress(
        self, history: PartHistory, request: WorkRequest, last_report_time: list[float]
    ) -> None:
        """Publish an intermediate result, or cancel the calculation if cancellation was requested."""
        request()
        now = self.read_time_s()
        if now - last_report_time[0] > _IMAGE_INTERVAL_S:
            last_report_time[0] = now
            request.publish_result(
                partial(self._take, PlaybackResult(history.make_current_part(), self._findings or ()))
            )

    def _take(self, shown: PlaybackResult) -> None:
        self._played = shown

    def _failed(self, why: str) -> None:
        self.error_text, self._played = why, None


def _find_hit_spans(instant: PartState) -> tuple[tuple[float, float], ...]:
    """Return the ranges of Z in which a tool has hit the part."""
    return tuple(
        (
            float(hit.z_positions.min()) - hit.column_width_mm / 2,
            float(hit.z_positions.max()) + hit.column_width_mm / 2,
        )
        for hit in instant.material_hits
    )


class PartPlayers(list[PartPlayer]):
    """All part players of one operator screen.

    They are closed together with the screen.
    """

    def close(self) -> None:
        """Stop all workers."""
        for player in self:
            player.close()


def make_part_player(desk: Desk) -> PartPlayer:
    """Return a new part player. It is closed when ``desk`` is closed."""
    players = desk.page_registry.find_model(PartPlayers)
    if players is None:
        players = PartPlayers()
        desk.page_registry.attach_model(players)
    players.append(PartPlayer())
    return players[-1]
