"""Branches that the tests of a room alone take: ``python -m tests.benchmarks.bench_branches [ROOM …]``.

Each room is measured with coverage, with the processes that its tests start, HAL's bridge under the system's
Python too. Prints the files with most branches that are not taken, and keeps the figures for
``docs/reliability.md``.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import coverage

from tests.benchmarks.footprint import RESULTS, keep_result

ROOMS = {
    "core/motion": ("tests/motion",),
    "core/executor": ("tests/executor",),
    "core/interpreter": ("tests/interpreter", "tests/klartext", "tests/sinumerik"),
    "drivers": (
        "tests/drivers",
        *(f"tests/machine/test_{name}.py" for name in (
            "board_table", "encoder", "hal_table", "hardware", "spindle_c", "wheel"
        )),  # their tables of the machine file
    ),
}  # fmt: skip
SHOWN = 12  # files
_HOW = """\
[run]
branch = true
parallel = true
patch = subprocess, _exit
data_file = {folder}/kept/coverage
source = {room}
[report]
exclude_also =
    if TYPE_CHECKING:
    class .*\\(Protocol\\):
    \\.\\.\\.$
"""
# For a Python that has no coverage of its own, and none of our packages.
_BEGIN = """\
import contextlib
with contextlib.suppress(ImportError):
    import coverage
    coverage.process_startup()
"""


def _opened(folder: Path) -> None:
    """The bridge's process runs as another user where the tests run as root."""
    os.chmod(folder, 0o755)
    kept = folder / "kept"
    kept.mkdir()
    os.chmod(kept, 0o1777)


def _environment(folder: Path) -> dict[str, str]:
    """In which a Python of any kind begins to measure when it starts."""
    for_all = folder / "for_all"
    for_all.mkdir()
    (for_all / "sitecustomize.py").write_text(_BEGIN)
    (for_all / "coverage").symlink_to(Path(coverage.__file__).parent)
    paths = [str(for_all), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def measured(room: str, more: list[str]) -> dict[str, Any]:
    """Branches of the room, those that are taken, and the files by what is not."""
    with tempfile.TemporaryDirectory() as folder:
        how = Path(folder) / "coveragerc"
        _opened(Path(folder))
        how.write_text(_HOW.format(folder=folder, room=Path(room).resolve()))
        tests = [sys.executable, "-m", "coverage", "run", f"--rcfile={how}", "-m", "pytest", "-q"]
        told = subprocess.run(
            [*tests, "-p", "no:cacheprovider", *ROOMS[room], *more],
            capture_output=True,
            text=True,
            check=False,
            env=_environment(Path(folder)),
        )
        report = Path(folder) / "report.json"
        for words in (["combine", "-q"], ["json", "-q", "-o", str(report)]):
            subprocess.run([sys.executable, "-m", "coverage", *words, f"--rcfile={how}"], check=True)
        found = json.loads(report.read_text())
    lines = told.stdout.strip().splitlines()
    return figures(found) | {"tests": lines[-1] if lines else "none"}


def figures(report: dict[str, Any]) -> dict[str, Any]:
    """Of a report of coverage."""
    total = report["totals"]
    files = sorted(
        (
            (each["summary"]["missing_branches"], name, each["missing_branches"])
            for name, each in report["files"].items()
            if each["summary"]["missing_branches"]
        ),
        reverse=True,
    )
    return {
        "branches": total["num_branches"],
        "taken": total["covered_branches"],
        "per cent": round(100.0 * total["covered_branches"] / max(1, total["num_branches"]), 1),
        "not taken": [{"file": name, "lines": missing} for _, name, missing in files],
        "folders": _by_folder(report),
    }


def _by_folder(report: dict[str, Any]) -> dict[str, list[int]]:
    """By folder: branches, and those that are taken."""
    found: dict[str, list[int]] = {}
    for name, each in sorted(report["files"].items()):
        counts, summary = found.setdefault(str(Path(name).parent), [0, 0]), each["summary"]
        counts[0] += summary["num_branches"]
        counts[1] += summary["covered_branches"]
    return found


def main() -> int:
    """Print the table, keep the figures beside those of rooms that were measured before."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rooms", nargs="*", default=tuple(ROOMS), metavar="ROOM", help=", ".join(ROOMS))
    parser.add_argument("--keep", type=Path, default=RESULTS, help="folder of the figures")
    parser.add_argument("--pytest", nargs="*", default=[], help="more words for pytest")
    wanted = parser.parse_args()
    kept = wanted.keep / "branches.json"
    rooms = json.loads(kept.read_text())["rooms"] if kept.exists() else {}
    for room in wanted.rooms:
        found = rooms[room] = measured(room, wanted.pytest)
        sys.stdout.write(
            f"{room:20s}{found['taken']:6d} of {found['branches']:6d} branches, {found['per cent']} %  "
            f"({found['tests']})\n"
        )
        for each in found["not taken"][:SHOWN]:
            sys.stdout.write(f"    {each['file']}: {each['lines']}\n")
        sys.stdout.flush()
        keep_result("branches", {"rooms": rooms}, wanted.keep)
    return 0


if __name__ == "__main__":
    sys.exit(main())
