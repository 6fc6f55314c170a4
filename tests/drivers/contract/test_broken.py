"""Wires that break while everything moves: all slides stop, the reason is told, nothing starts by itself."""

from __future__ import annotations

import pytest

from tests.drivers.contract.rig import NINE
from tests.drivers.contract.rigs import RIGS, make

FULL = "full queue"  # is a load and no fault: test_setpoints, test_program
MISSING = [
    (name, what)
    for name, kind in RIGS.items()
    for what in NINE
    if what not in {*kind.faults, *kind.harmless, FULL}
]


@pytest.mark.parametrize(("name", "what"), MISSING, ids="-".join)
def test_what_a_wire_cannot_have_is_said_in_words(name: str, what: str) -> None:
    """A skip with its reason for each of the nine that a driver has no trial of; without one it fails."""
    assert what in RIGS[name].missing, f"{name} neither has a trial of {what!r} nor says why not"
    pytest.skip(f"{name}: {RIGS[name].missing[what]}")


@pytest.mark.parametrize("name", RIGS)
def test_every_fault_has_its_hammer(name: str) -> None:
    kind, rig = RIGS[name], make(name)
    assert set(rig.acts()) == {*kind.faults, *kind.harmless}
    assert not {*kind.faults, *kind.harmless} & set(kind.missing)
    rig.close()
