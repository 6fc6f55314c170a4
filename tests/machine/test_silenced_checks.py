"""[checks] of the machine file: what the proof of the part only notes on this machine."""

from __future__ import annotations

import pytest

import resources
from app.compose.known_part import OF_MACHINE, known_part
from app.compose.machine.machine_files import SHIPPED, parse_machine
from core.machine.machine_model import Machine
from core.proving.checks.part_checks import CHECKS
from core.table_schema import MachineFileError
from tests.texts import text as wording

ALL_CHECKS = wording("machine.no-part-check", checks=", ".join(CHECKS))


def machine(checks: str) -> Machine:
    return parse_machine(resources.machine_file(SHIPPED) + f"\n[checks]\n{checks}\n", "lathe.toml")


def test_checks_are_silenced_by_their_ids() -> None:
    silenced = machine('silenced = ["chip-load", "cuts-air"]')
    assert silenced.silenced == ("chip-load", "cuts-air")
    setting = known_part(silenced, {}, {})
    assert setting.silenced == {"chip-load": OF_MACHINE, "cuts-air": OF_MACHINE}


@pytest.mark.parametrize("checks", ["", "silenced = []"])
def test_without_one_nothing_is_silenced(checks: str) -> None:
    assert machine(checks).silenced == ()


@pytest.mark.parametrize(
    ("checks", "told"),
    [
        ('silenced = ["chipload"]', ALL_CHECKS),
        ('silenced = ["spindle-off"]', ALL_CHECKS),  # one of the program itself
        ('silenced = "chip-load"', "expected a list of words"),
        ("silenced = [1]", "expected a list of words"),
        ('silenced = ["chip load"]', "expected a list of words"),
        ('silence = ["chip-load"]', "did you mean silenced?"),
    ],
)
def test_what_is_no_list_of_checks_is_refused_with_its_place(checks: str, told: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        machine(checks)
    assert "checks.silence" in str(caught.value)
    assert told in str(caught.value)
