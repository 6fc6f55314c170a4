"""What a process holds of its computer, and the result files that ``docs/reliability.md`` is written from."""

from __future__ import annotations

import gc
import json
import os
import platform
import threading
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

RESULTS = Path(__file__).parent / "results"
_PAGE = os.sysconf("SC_PAGE_SIZE")
_STATM_RESIDENT = 1  # the second figure of /proc/PID/statm


@dataclass(frozen=True, slots=True)
class Footprint:
    """Resident memory in MiB, open files, threads, bytes of store and of everything else that is kept."""

    rss_mib: float
    files: int
    threads: int
    objects: int  # that Python's collector knows
    store_bytes: int
    log_bytes: int
    folder_bytes: int


def footprint(home: Path, pid: int | None = None) -> Footprint:
    """Of this process, or of ``pid``, whose objects and threads by Python's count are then not known."""
    process = Path("/proc") / (str(pid) if pid is not None else "self")
    resident = int((process / "statm").read_text().split()[_STATM_RESIDENT]) * _PAGE
    own = pid is None
    return Footprint(
        rss_mib=round(resident / 2**20, 1),
        files=len(list((process / "fd").iterdir())),
        threads=threading.active_count() if own else len(list((process / "task").iterdir())),
        objects=len(gc.get_objects()) if own else 0,
        store_bytes=size_of(home, "turndesk.db*"),
        log_bytes=size_of(home / "logs", "*"),
        folder_bytes=size_of(home, "*"),
    )


def size_of(folder: Path, pattern: str) -> int:
    """Bytes of the files below a folder; one that goes meanwhile counts nothing."""
    total = 0
    for path in folder.rglob(pattern):
        try:
            total += path.stat().st_size if path.is_file() else 0
        except FileNotFoundError:
            continue
    return total


def keep_result(name: str, figures: Mapping[str, object], folder: Path | None = None) -> Path:
    """Write the figures of a measurement with date and machine; answers where."""
    where = (folder or RESULTS) / f"{name}.json"
    where.parent.mkdir(parents=True, exist_ok=True)
    about = {"date": time.strftime("%Y-%m-%d", time.gmtime()), "machine": machine()}
    where.write_text(json.dumps({**about, **figures}, indent=1, sort_keys=True) + "\n")
    return where


def machine() -> str:
    """The computer in a few words: processor, cores that may be used, Python."""
    model = next(
        (
            line.partition(":")[2].strip()
            for line in Path("/proc/cpuinfo").read_text().splitlines()
            if line.startswith("model name")
        ),
        platform.machine(),
    )
    cores = len(os.sched_getaffinity(0))
    return f"{model}, {cores} cores, {platform.system()}, Python {platform.python_version()}"


def plain(marks: Mapping[str, Footprint]) -> dict[str, dict[str, float]]:
    """Footprints by name, as a result file has them."""
    return {name: asdict(mark) for name, mark in marks.items()}
