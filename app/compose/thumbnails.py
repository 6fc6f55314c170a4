"""Thumbnails of programs: the finished part drawn small, made on a worker and kept by their contents.

Found again by a hash of all that the part depends on, and of the program text that makes it; a damaged file
does not unpack and is made anew.
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

from app.compose.desk_part import PartDesk
from app.programs.program_rows import Thumbnail

if TYPE_CHECKING:
    from app.desk.background_work import Watch
    from core.executor.job import Job
    from core.machine.machine_model import Machine
    from core.part.solid_picture import Image
    from core.proving.program_tools import PartSetting

WIDE, HIGH = 168, 112  # pixels
MOST = 400  # files; of more the oldest fifth goes
_CORE = Path(__file__).parents[2] / "core"
_AZIMUTH, _TILT = 32.0, 32.0


@dataclass(frozen=True, slots=True)
class Thumbnails:
    """In ``folder``, for the programs of one machine."""

    folder: Path
    machine: Machine
    parts: PartDesk
    wide: int = WIDE
    high: int = HIGH

    def of(self, job: Job, watch: Watch) -> Thumbnail | None:
        """The picture of the job's part, ``wide`` by ``high``; None: it makes none. ``watch`` may give up."""
        if self.machine.kind != "lathe":
            return None
        setting = self.parts.setting(job, watch)[0]
        path = self.folder / self._key(job, setting)
        pixels = _found(path, self.wide * self.high)
        if pixels is None:
            image = self._made(job, setting, watch)
            if image is None:
                return None
            pixels = np.ascontiguousarray(image, dtype=np.uint32).tobytes()
            _keep(path, pixels)
        return Thumbnail(pixels, self.wide, self.high)

    def _made(self, job: Job, setting: PartSetting, watch: Watch) -> Image | None:
        from core.part.solid_picture import SolidPicture
        from core.part.solid_view import SolidView, fitted
        from core.proving.part_history import PartGathering, finished_part
        from core.proving.program_timeline import Timeline

        gathered = PartGathering(setting)
        for number, span in enumerate(Timeline.of(job.reading, job.setup, self.machine).spans()):
            gathered.see(span)
            if number % 200 == 0:
                watch(number)
        moves = gathered.moves()
        part = finished_part(moves, watch) if moves is not None else None
        if part is None:
            return None
        scale, centre = fitted(part.back, part.front, part.radius, self.wide, self.high, _AZIMUTH)
        view = SolidView(_AZIMUTH, _TILT, 0.0, scale, centre)
        return SolidPicture().draw(part.solid, view, self.wide, self.high)

    def _key(self, job: Job, setting: PartSetting) -> str:
        """What the picture depends on, in a name."""
        shapes, radii, gang = setting.shapes, setting.nose_radii, setting.gang
        tools = (sorted(shapes.items()), sorted(radii.items()), sorted(gang.items()))
        said = (job.source.name, job.digest, setting.stock, setting.clamping, tools, self.wide, self.high)
        return sha256(f"{_core_version()}\n{said!r}".encode("utf-8", "surrogatepass")).hexdigest()


@lru_cache(maxsize=1)
def _core_version() -> str:
    """A hash of the program text that makes parts: another TurnDesk may make others."""
    total = sha256()
    for path in sorted(_CORE.rglob("*.py")):
        total.update(path.read_bytes())
    return total.hexdigest()


def _found(path: Path, pixels_wanted: int) -> bytes | None:
    try:
        pixels = zlib.decompress(path.read_bytes())
        os.utime(path)  # the oldest that nobody looks at go first
    except (OSError, zlib.error):
        return None
    return pixels if len(pixels) == 4 * pixels_wanted else None


def _keep(path: Path, pixels: bytes) -> None:
    """Written aside and renamed; a disk that takes nothing costs the time to draw it again, no more."""
    aside = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        aside.write_bytes(zlib.compress(pixels))
        aside.replace(path)
        there = sorted(path.parent.iterdir(), key=lambda each: each.stat().st_mtime)
        for old in there[: MOST // 5] if len(there) > MOST else []:
            old.unlink(missing_ok=True)
    except OSError:
        return
