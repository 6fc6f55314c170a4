"""Thumbnails of finished parts, drawn in a worker thread and cached in files.

The file name is a hash of all data on which the part depends, including TurnDesk's own code. A damaged file
cannot be decompressed, and its thumbnail is drawn again.
"""

from __future__ import annotations

import os
import zlib
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from app.compose.part_prover import PartProver
from app.programs.program_rows import Thumbnail

if TYPE_CHECKING:
    from app.desk.background_work import ProgressCallback
    from core.executor.job import Job
    from core.machine.machine_model import Machine
    from core.part.picture.part_scene import ImageArray
    from core.proving.program_tools import PartSettings

WIDE, HIGH = 168, 112  # pixels
MAX_FILE_COUNT = 400  # files; beyond this number the oldest fifth is deleted
_CORE_FOLDER = Path(__file__).parents[2] / "core"
_AZIMUTH, _TILT = 32.0, 32.0


@dataclass(frozen=True, slots=True)
class ThumbnailCache:
    """Cache of thumbnails in ``folder`` for the programs of one machine."""

    folder: Path
    machine: Machine
    part_prover: PartProver
    width_px: int = WIDE
    height_px: int = HIGH

    def get_thumbnail(self, job: Job, report_progress: ProgressCallback) -> Thumbnail | None:
        """Return the thumbnail of the job's part, or None if the job does not make a part.

        ``report_progress`` may raise an exception to cancel the drawing.
        """
        if self.machine.kind != "lathe":
            return None
        setting = self.part_prover.read_part_settings(job, report_progress)[0]
        path = self.folder / self._cache_key(job, setting)
        pixels = _found(path, self.width_px * self.height_px)
        if pixels is None:
            image = self._made(job, setting, report_progress)
            if image is None:
                return None
            pixels = np.ascontiguousarray(image, dtype=np.uint32).tobytes()
            _save_cached(path, pixels)
        return Thumbnail(pixels, self.width_px, self.height_px)

    def _made(self, job: Job, setting: PartSettings, watch: ProgressCallback) -> ImageArray | None:
        from core.part.picture.solid_picture import SolidPicture
        from core.part.picture.solid_view import SolidView, fit_view
        from core.proving.finished_part import make_finished_part
        from core.proving.part_history import StepCollector
        from core.proving.program_timeline import Timeline

        gathered = StepCollector(setting)
        for number, span in enumerate(
            Timeline.from_program(job.shared_program, job.setup, self.machine).iter_spans()
        ):
            gathered.add_span(span)
            if number % 200 == 0:
                watch(number)
        moves = gathered.make_program_steps()
        part = make_finished_part(moves, watch) if moves is not None else None
        if part is None:
            return None
        scale, centre = fit_view(
            part.back_z_mm, part.front_z_mm, part.radius_mm, self.width_px, self.height_px, _AZIMUTH
        )
        view = SolidView(_AZIMUTH, _TILT, 0.0, scale, centre)
        return SolidPicture().draw_fine_picture(part.solid, view, self.width_px, self.height_px)

    def _cache_key(self, job: Job, setting: PartSettings) -> str:
        """Return the file name of the thumbnail, which is a hash of all data that affects the picture."""
        shapes, radii, gang = setting.shapes, setting.nose_radii, setting.gang
        tools = (sorted(shapes.items()), sorted(radii.items()), sorted(gang.items()))
        said = (
            job.source.name,
            job.digest,
            setting.stock,
            setting.clamping,
            tools,
            self.width_px,
            self.height_px,
        )
        return sha256(f"{_core_version()}\n{said!r}".encode("utf-8", "surrogatepass")).hexdigest()


@lru_cache(maxsize=1)
def _core_version() -> str:
    """Return a hash of the code that simulates parts.

    The hash is necessary because a different version may produce different parts.
    """
    total = sha256()
    for path in sorted(_CORE_FOLDER.rglob("*.py")):
        total.update(path.read_bytes())
    return total.hexdigest()


def _found(path: Path, pixels_wanted: int) -> bytes | None:
    try:
        pixels = zlib.decompress(path.read_bytes())
        os.utime(path)  # marks the file as used, because the oldest files are deleted first
    except (OSError, zlib.error):
        return None
    return pixels if len(pixels) == 4 * pixels_wanted else None


def _save_cached(path: Path, pixels: bytes) -> None:
    """Write a thumbnail file completely or not at all.

    A disk error is ignored, and the thumbnail is later drawn again.
    """
    aside = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        aside.write_bytes(zlib.compress(pixels))
        aside.replace(path)
        there = sorted(path.parent.iterdir(), key=lambda each: each.stat().st_mtime)
        for old in there[: MAX_FILE_COUNT // 5] if len(there) > MAX_FILE_COUNT else []:
            old.unlink(missing_ok=True)
    except OSError:
        return
