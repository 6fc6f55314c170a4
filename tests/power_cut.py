"""The mains fail: at every step of a writer, with nothing on the disk that was not brought there.

What was written and not brought to the disk may be there to any byte after a power cut, and a name that was
given may be the old one. So a file must be on the disk before it gets its name, and the folder after that.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest


class PowerCutError(BaseException):
    """Nothing of the program runs any more."""


class Mains:
    """Counts the steps of a writer that order the disk, and fails before one of them."""

    def __init__(self, fails_at: int | None = None) -> None:
        self.steps: list[str] = []
        self.faults: list[str] = []
        self._fails_at = fails_at
        self._on_disk: dict[tuple[int, int], bytes] = {}
        self._names: set[Path] = set()

    @property
    def lost(self) -> list[str]:
        """What a power cut now would take back or leave by half."""
        return self.faults + [f"the name of {path.name} is not on the disk" for path in sorted(self._names)]

    def fsync(self, file: int) -> None:
        self._step("fsync")
        told = os.fstat(file)
        place = Path(f"/proc/self/fd/{file}")
        if stat.S_ISDIR(told.st_mode):
            folder = place.resolve()
            self._names = {name for name in self._names if name.parent != folder}
        else:
            self._on_disk[told.st_dev, told.st_ino] = place.read_bytes()

    def replace(self, source: str | Path, target: str | Path, rename: Callable[..., None]) -> None:
        self._step("rename")
        source, target = Path(source), Path(target)
        inside = [each for each in source.rglob("*") if each.is_file()] if source.is_dir() else [source]
        for each in inside:
            told = each.stat()
            if self._on_disk.get((told.st_dev, told.st_ino)) != each.read_bytes():
                self.faults.append(f"{each.name} got its name before its bytes were on the disk")
        rename(source, target)
        self._names.add(target.resolve())

    def _step(self, what: str) -> None:
        if len(self.steps) == self._fails_at:
            raise PowerCutError
        self.steps.append(what)


@contextmanager
def mains(fails_at: int | None = None) -> Iterator[Mains]:
    """While this is open the disk is ours; none of it takes time."""
    found, rename, link = Mains(fails_at), os.replace, os.link
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", found.fsync)
        patch.setattr(os, "replace", lambda a, b: found.replace(a, b, rename))
        patch.setattr(os, "link", lambda a, b, **_how: found.replace(a, b, link))
        yield found


def cut_everywhere(write: Callable[[], object], seen: Callable[[], object]) -> list[object]:
    """What is seen after a power cut before each step of ``write``, and at last without one.

    Fails where a whole ``write`` leaves something that a power cut would take back.
    """
    told = []
    for step in range(100):
        with mains(step) as at:
            try:
                write()
            except PowerCutError:
                told.append(seen())
                continue
        assert at.lost == []
        return [*told, seen()]
    raise AssertionError("it does not come to an end")
