"""One target under atheris, in its own process: ``python -m tests.fuzz.guided TARGET SECONDS FOLDER``."""

from __future__ import annotations

import json
import logging
import os
import random
import sys
import time
import warnings
from pathlib import Path

import atheris

_LONGEST, _MEMORY = 6000, 3000  # bytes of an input, or half more than its longest seed; MiB
_WALL = 20.0  # times the processor's time
_TOLD = 25  # runs between two figures
_OURS = 0.6  # of the changes that know the language


def main() -> None:
    """Fuzz until the time is over; figures and faults are in the folder."""
    name, seconds, folder = sys.argv[1], float(sys.argv[2]), Path(sys.argv[3])
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    with atheris.instrument_imports(include=["core", "drivers", "app"]):
        from tests.fuzz.fuzz_target import Examined  # noqa: PLC0415  they are instrumented as they are loaded
        from tests.fuzz.fuzz_targets import TARGETS  # noqa: PLC0415
    target = next(each for each in TARGETS if each.name == name)
    corpus = folder / "corpus"
    corpus.mkdir(parents=True)
    seeds = list(target.seeds())
    for number, seed in enumerate(seeds):
        (corpus / f"seed{number}").write_bytes(seed)
    begun = time.process_time()
    examined = Examined(target, folder / "faults.jsonl")

    def change(data: bytes, most: int, seed: int) -> bytes:
        chance = random.Random(seed)
        if target.mutate is not None and chance.random() < _OURS:
            return target.mutate(data, chance)[:most]
        return bytes(atheris.Mutate(data, most))

    def one(data: bytes) -> None:
        """libFuzzer knows the clock only: on a busy machine the processor's time is what counts."""
        examined(data)
        over = time.process_time() > begun + seconds
        if over or examined.runs % _TOLD == 0:
            figures = {"runs": examined.runs, "refused": examined.refused, "slowest_s": examined.slowest}
            new = folder / "runs.new"
            new.write_text(json.dumps(figures))
            new.replace(folder / "runs.json")
        if over:
            sys.stdout.flush()
            os._exit(0)

    longest = max(_LONGEST, 3 * max(map(len, seeds)) // 2)
    words = ["fuzz", str(corpus), f"-max_total_time={_WALL * seconds:.0f}", f"-max_len={longest}"]
    words += [
        "-timeout=60",
        f"-rss_limit_mb={_MEMORY}",
        "-print_final_stats=1",
        f"-artifact_prefix={folder}/",
    ]
    atheris.Setup(words, one, custom_mutator=change)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
