"""Fuzzing by coverage, one target after the other: ``python -m tests.fuzz.fuzz [--minutes 3] [TARGET …]``.

``--minutes`` of processor time are for each target. It needs atheris (``pip install atheris``); without it
it says so and ends. Prints executions, the edges that were reached and the faults, and keeps them for
``docs/reliability.md`` beside those of targets that were fuzzed before.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import re
import subprocess
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tests.benchmarks.footprint import RESULTS, keep_result
from tests.extras.modules import of_extras
from tests.fuzz.fuzz_target import faults_in

NAMES = (
    "omniturn", "klartext", "sinumerik", "machine file", "offsets file", "tools file", "inputs file",
    "profile of a blank", "record", "ring", "setup archive", "EDS file", "serial transfer",
    "controller's lines", "grblHAL's wire", "CAN frames", "store file",
    *(name for kind in ("fuzz_files", "fuzz_targets") for each in of_extras(kind) for name in each.NAMES),
)  # fmt: skip
_EDGES = re.compile(r"cov: (\d+)")
_ENDS = 25.0  # times its time, by the clock, after which a target hangs


def fuzzed(name: str, seconds: float, folder: Path) -> dict[str, Any]:
    """The figures of one target."""
    words = [sys.executable, "-m", "tests.fuzz.guided", name, str(seconds), str(folder)]
    log = folder.with_suffix(".log")
    with log.open("w") as told:
        try:
            status = subprocess.run(
                words, stdout=told, stderr=told, check=False, timeout=_ENDS * seconds + 60.0
            ).returncode
        except subprocess.TimeoutExpired:
            status = 0  # a busy machine; an input that hangs ends it by itself
    text = log.read_text(errors="replace")
    edges = _EDGES.findall(text)
    runs = folder / "runs.json"
    figures = json.loads(runs.read_text()) if runs.exists() else {}
    faults = [asdict(each) for each in faults_in(folder / "faults.jsonl")]
    if status:
        faults.append({"kind": "ended", "where": f"status {status}", "text": text[-300:]})
    return {
        "seconds": seconds,
        "edges at first": int(edges[0]) if edges else 0,
        "edges": int(edges[-1]) if edges else 0,
        "faults": faults,
        **figures,
    }


def main() -> int:
    """Print the table; status 1 when a fault was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="TARGET", help=", ".join(NAMES))
    parser.add_argument("--minutes", type=float, default=3.0)
    parser.add_argument("--keep", type=Path, help="folder of the figures")
    wanted = parser.parse_args()
    if importlib.util.find_spec("atheris") is None:
        sys.stdout.write("skipped: atheris is not installed; pip install atheris, then run this again\n")
        return 0
    kept = (wanted.keep or RESULTS) / "fuzz.json"
    figures: dict[str, Any] = json.loads(kept.read_text())["targets"] if kept.exists() else {}
    with tempfile.TemporaryDirectory() as folder:
        for name in wanted.names or NAMES:
            place = Path(folder) / name.replace(" ", "-").replace("'", "")
            place.mkdir()
            found = figures[name] = fuzzed(name, wanted.minutes * 60.0, place)
            sys.stdout.write(
                f"{name:20s}{found.get('runs', 0):9,d} runs, {found['edges at first']:6d} to "
                f"{found['edges']:6d} edges, slowest {found.get('slowest_s', 0.0):.2f} s, "
                f"{len(found['faults'])} faults\n"
            )
            for fault in found["faults"]:
                sys.stdout.write(f"    {fault['kind']} {fault['where']}: {fault['text']}\n")
            sys.stdout.flush()
            keep_result("fuzz", {"targets": figures}, wanted.keep)
    return int(any(figures[name]["faults"] for name in wanted.names or NAMES))


if __name__ == "__main__":
    sys.exit(main())
