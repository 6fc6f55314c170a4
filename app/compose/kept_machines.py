"""Shipped machine files as they were read last: kept where Python keeps what it has compiled.

To read one, the table of every driver is loaded and all of its rules are asked: a fifth of a short command.
What is kept is found by content, and it counts only with the very text of the machine file and with the very
modules that have read it; else the file is read again. It is trusted as far as compiled modules are, which
lie beside it.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import sys
import time
from importlib.util import cache_from_source, source_hash
from pathlib import Path

from core.machine.machine_model import Machine

_ROOT = Path(__file__).parents[2]
_READERS = (
    "app.compose.machine_drivers.",
    "core.machine.",
    "core.nearest.",
    "core.table_schema.",
    "drivers.",
)
_BEGUN = time.time_ns()  # of this process: what is put in a reader's place later is not what it has loaded


def find(file: Path, text: str) -> Machine | None:
    """The machine that ``text`` of this shipped file has given before; None where nothing fits."""
    try:
        head, _, rest = _place(file).read_bytes().partition(b"\n")
    except (OSError, NotImplementedError):  # the latter: a Python that keeps nothing
        return None
    if head != _sum(rest, text):
        return None
    readers, _, packed = rest.partition(b"\n\n")
    if any(_stamp(line.split(" ")[0]) != line for line in readers.decode().splitlines()):
        return None
    machine: Machine = pickle.loads(packed)
    return machine


def keep(file: Path, text: str, machine: Machine) -> None:
    """Keep what ``text`` has given, for the next process; where that is not wanted or possible, no harm.

    Nor where a reader was replaced while this process ran, by an update of the product: the machine would
    stand under the stamps of readers that have not read it.
    """
    if sys.dont_write_bytecode:
        return
    found = _readers()
    readers = "\n".join(sorted(_stamp(each.relative_to(_ROOT).as_posix()) for each in found))
    rest = readers.encode() + b"\n\n" + pickle.dumps(machine)
    with contextlib.suppress(OSError, NotImplementedError):
        if any(each.stat().st_ctime_ns > _BEGUN for each in found):
            return
        place = _place(file)
        place.parent.mkdir(parents=True, exist_ok=True)
        aside = place.with_name(f"{place.name}.{os.getpid()}")
        aside.write_bytes(_sum(rest, text) + b"\n" + rest)
        aside.replace(place)


def _place(file: Path) -> Path:
    return Path(cache_from_source(str(file))).with_suffix(".machine")


def _readers() -> list[Path]:
    """The modules that have read machine files in this process, as files."""
    loaded = [module for name, module in sys.modules.items() if f"{name}.".startswith(_READERS)]
    return [Path(module.__file__) for module in loaded if module.__file__ is not None]


def _stamp(path: str) -> str:
    """A file of ours, when it was written and its length; where it is gone, what fits no other."""
    try:
        found = (_ROOT / path).stat()
    except OSError:
        return ""
    return f"{path} {found.st_mtime_ns} {found.st_size}"


def _sum(rest: bytes, text: str) -> bytes:
    return source_hash(rest + text.encode()).hex().encode()
