"""USB sticks and other removable media: where the system has mounted them, and how much room they have."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOTS = (Path("/media"), Path("/run/media"), Path("/mnt"))


@dataclass(frozen=True, slots=True)
class Stick:
    """One medium: its label and where it is mounted; ``free`` bytes."""

    label: str
    path: Path
    free: int


def sticks(
    roots: Sequence[Path] = ROOTS, mounted: Callable[[Path], bool] = os.path.ismount
) -> tuple[Stick, ...]:
    """What is plugged in and mounted now, by label; a folder that is no mount is a medium that has gone."""
    found = {path: Stick(path.name, path, _free(path)) for root in roots for path in _mounts(root, mounted)}
    return tuple(sorted(found.values(), key=lambda stick: stick.label.lower()))


def _mounts(root: Path, mounted: Callable[[Path], bool]) -> Iterator[Path]:
    """Two levels: /media/STICK of some systems, /media/USER/STICK of others."""
    for path in _folders(root):
        if mounted(path):
            yield path
        else:
            yield from (below for below in _folders(path) if mounted(below))


def _folders(path: Path) -> list[Path]:
    try:
        return sorted(below for below in path.iterdir() if below.is_dir())
    except OSError:
        return []


def _free(path: Path) -> int:
    try:
        return shutil.disk_usage(path).free
    except OSError:
        return 0
