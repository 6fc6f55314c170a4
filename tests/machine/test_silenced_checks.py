"""[checks] of the machine file: what the proof of the part only notes on this machine."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine.machine_files import DEFAULT_MACHINE_FILE, parse_machine
from app.compose.part_data import MACHINE_FILE_REASON, make_part_settings
from core.machine.machine_model import Machine
from core.proving.checks.part_checks import PART_CHECKS
from core.table_schema import MachineFileError
from tests.texts import text as wording

ALL_CHECKS = wording("machine.no-part-check", checks=", ".join(PART_CHECKS))


def machine(checks: str) -> Machine:
    return parse_machine(
        resources.read_machine_file(DEFAULT_MACHINE_FILE) + f"\n[checks]\n{checks}\n", "lathe.toml"
    )


def test_checks_are_silenced_by_their_ids() -> None:
    silenced = machine('silenced = ["chip-load", "cuts-air"]')
    assert silenced.silenced_checks == ("chip-load", "cuts-air")
    setting = make_part_settings(silenced, {}, {})
    assert setting.silenced == {"chip-load": MACHINE_FILE_REASON, "cuts-air": MACHINE_FILE_REASON}


@pytest.mark.parametrize("checks", ["", "silenced = []"])
def test_no_check_is_silenced_without_setting(checks: str) -> None:
    assert machine(checks).silenced_checks == ()


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
def test_invalid_list_of_checks_is_rejected_at_its_path(checks: str, told: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        machine(checks)
    assert "checks.silence" in str(caught.value)
    assert told in str(caught.value)
