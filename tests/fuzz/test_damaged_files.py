"""Damaged files of every kind end in their reader's own error; ``bench_damaged_files`` tries many more."""

from __future__ import annotations

import warnings
from itertools import islice
from pathlib import Path

import pytest

from tests.fuzz.damaged_inputs import damaged_inputs
from tests.fuzz.fuzz_files import FILES
from tests.fuzz.fuzz_stores import STORE
from tests.fuzz.fuzz_target import Examined, Target, faults_in

_INPUTS = {"store file": 15}
_USUAL = 80
_SPOILT_SEEDS = {"omniturn", "klartext", "sinumerik", "store file"}  # their seeds are changes themselves


@pytest.mark.parametrize("target", FILES, ids=lambda each: each.name.replace(" ", "-"))
def test_damaged_input_raises_only_the_error_of_its_reader(target: Target, tmp_path: Path) -> None:
    examined = Examined(target, tmp_path / "faults.jsonl")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", category=DeprecationWarning)  # of a library's logger
        for data in damaged_inputs(target, range(_INPUTS.get(target.name, _USUAL))):
            examined(data)
    assert examined.refused or target is STORE  # of a store, rows are refused one by one
    # A busy computer makes an input slow, no computer makes it raise.
    assert [each for each in faults_in(tmp_path / "faults.jsonl") if each.kind != "slow"] == []


@pytest.mark.parametrize("target", FILES, ids=lambda each: each.name.replace(" ", "-"))
def test_undamaged_seeds_are_valid(target: Target) -> None:
    if target.name in _SPOILT_SEEDS:
        return
    for data in islice(target.seeds(), 3):
        assert "" not in list(target.run(data))


def test_same_number_gives_the_same_damage() -> None:
    target = next(each for each in FILES if each.name == "offsets file")
    assert list(damaged_inputs(target, range(3, 9))) == list(damaged_inputs(target, range(9)))[3:]
