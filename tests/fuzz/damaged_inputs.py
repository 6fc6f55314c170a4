"""Damaged inputs for one target, by number: the same number is the same damage on every computer."""

from __future__ import annotations

import random
import zlib
from collections.abc import Iterable, Iterator
from itertools import islice

from tests.fuzz.damage import damaged
from tests.fuzz.fuzz_target import Target

_MOST_SEEDS = 40


def damaged_inputs(target: Target, numbers: Iterable[int]) -> Iterator[bytes]:
    """Yield the inputs with these numbers."""
    seeds = list(islice(target.seeds(), _MOST_SEEDS))
    for number in numbers:
        chance = random.Random(zlib.crc32(f"{target.name} {number}".encode()))
        yield damaged(target, chance.choice(seeds), chance)
