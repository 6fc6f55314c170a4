"""One target under atheris, in its own process: ``python -m tests.fuzz.guided TARGET SECONDS FOLDER``."""

from __future__ import annotations

import json
import logging
import random
import sys
import warnings
from pathlib import Path

import atheris

_LONGEST, _MEMORY = 6000, 3000  # bytes of an input, MiB
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
    for number, seed in enumerate(target.seeds()):
        (corpus / f"seed{number}").write_bytes(seed)
    examined = Examined(target, folder / "faults.jsonl")

    def change(data: bytes, most: int, seed: int) -> bytes:
        chance = random.Random(seed)
        if target.mutate is not None and chance.random() < _OURS:
            return target.mutate(data, chance)[:most]
        return bytes(atheris.Mutate(data, most))

    def one(data: bytes) -> None:
        """libFuzzer ends the process by itself: what is known is written on the way."""
        examined(data)
        if examined.runs % _TOLD == 0:
            figures = {"runs": examined.runs, "refused": examined.refused, "slowest_s": examined.slowest}
            (folder / "runs.json").write_text(json.dumps(figures))

    words = ["fuzz", str(corpus), f"-max_total_time={seconds:.0f}", f"-max_len={_LONGEST}", "-timeout=60"]
    words += [f"-rss_limit_mb={_MEMORY}", "-print_final_stats=1", f"-artifact_prefix={folder}/"]
    atheris.Setup(words, one, custom_mutator=change)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
