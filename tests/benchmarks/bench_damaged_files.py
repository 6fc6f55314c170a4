"""Damaged files of every kind: ``python -m tests.benchmarks.bench_damaged_files [--count 10000] [KIND …]``.

Each kind has a process of its own. Prints the inputs, those that were refused, the longest processor time of
one of them, the highest memory of the process, and every fault with the input's number.
"""

from __future__ import annotations

import argparse
import logging
import multiprocessing
import resource
import sys
import tempfile
import time
import warnings
from pathlib import Path

from tests.fuzz.damaged_inputs import damaged_inputs
from tests.fuzz.fuzz_files import FILES
from tests.fuzz.fuzz_target import Examined, faults_in


def _examine(name: str, first: int, count: int, folder: str) -> None:
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    target = next(each for each in FILES if each.name == name)
    kept = Path(folder) / "faults.jsonl"
    examined = Examined(target, kept)
    before, begun = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    for data in damaged_inputs(target, range(first, first + count)):
        examined(data)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    faults = faults_in(kept)
    sys.stdout.write(
        f"{name:20}{examined.runs:7,} inputs, {examined.refused:6,} refused, "
        f"slowest {examined.slowest:6.3f} s, all {time.process_time() - begun:6.0f} s, "
        f"memory {peak // 1024:5} MiB ({(peak - before) // 1024:+} MiB), {len(faults)} faults\n"
    )
    for fault in faults:
        sys.stdout.write(f"    {fault.kind} {fault.where}: {fault.text[:160]}  {fault.data[:80]}\n")
    sys.stdout.flush()


def main() -> None:
    """Examine one kind after the other."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="KIND", help=", ".join(each.name for each in FILES))
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    wanted = parser.parse_args()
    for name in wanted.names or [each.name for each in FILES]:
        with tempfile.TemporaryDirectory() as folder:
            words = name, wanted.first, wanted.count, folder
            process = multiprocessing.get_context("spawn").Process(target=_examine, args=words)
            process.start()
            process.join()
            if process.exitcode:
                sys.stdout.write(f"{name:20}ended with status {process.exitcode}\n")


if __name__ == "__main__":
    main()
