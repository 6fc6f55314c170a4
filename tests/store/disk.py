"""A small file system of our own, that can be filled to the last byte."""

from __future__ import annotations

import errno
import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from io import RawIOBase
from pathlib import Path

import pytest

_CHUNK = 4096


class Disk:
    """Mounted at ``path``; ``fill`` leaves nothing, ``make_room`` all of what was filled."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._filler = path / "filler"

    def fill(self) -> None:
        """Until it takes nothing more."""
        with self._filler.open("ab", buffering=0) as file:
            while _written(file):
                pass

    def make_room(self) -> None:
        """As somebody does who deletes old files."""
        self._filler.unlink()


def _written(file: RawIOBase) -> bool:
    try:
        return bool(file.write(bytes(_CHUNK)))
    except OSError as error:
        if error.errno != errno.ENOSPC:
            raise
    return False


@contextmanager
def small_disk(path: Path, size: str = "2m") -> Iterator[Disk]:
    """A file system in memory; skips where nobody may mount one."""
    if os.geteuid() != 0:
        pytest.skip("only root can mount a small file system to fill")
    path.mkdir(parents=True)
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(path)], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip(f"no file system can be mounted here: {mounted.stderr.decode().strip()}")
    try:
        yield Disk(path)
    finally:
        subprocess.run(["umount", "-l", str(path)], check=True)
