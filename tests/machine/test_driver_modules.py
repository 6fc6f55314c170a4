"""Which modules with tables of drivers are loaded for a machine file."""

from __future__ import annotations

import re

import pytest

import resources
from app.compose.machine.driver_modules import (
    DriverModule,
    list_driver_modules,
    load_all_drivers,
    load_used_drivers,
)
from app.compose.machine.machine_files import parse_machine
from core.input_file import parse_toml
from core.machine.machine_file import build_machine
from core.table_schema import MachineFileError

TEXT = resources.read_machine_file("gt75.toml")


@pytest.mark.parametrize("module", list_driver_modules(), ids=lambda each: each.tables[0])
def test_module_lists_names_of_its_driver(module: DriverModule) -> None:
    driver = module.load_driver()
    assert module.tables == tuple(table.path for table in driver.tables)
    assert (module.backend_name, module.spindle) == (driver.backend_name, driver.spindle)
    assert module.is_always_loaded == any(table.is_always_read for table in driver.tables)


@pytest.mark.parametrize(
    ("text", "first_tables"),
    [
        ("", ["sim"]),
        ("[backup]\nkeep = 3", ["sim", "backup"]),
        ('[machine]\nbackend = "hal"', ["sim", "hal"]),
        ('[spindle]\ndriver = "cia402"', ["sim", "canopen"]),
        ("[spindle.encoder]", ["sim", "canopen"]),
        ("machine = 1\nspindle = [2]", ["sim"]),
    ],
)
def test_machine_file_loads_only_drivers_it_needs(text: str, first_tables: list[str]) -> None:
    assert [each.tables[0].path for each in load_used_drivers(parse_toml(text))] == first_tables


@pytest.mark.parametrize("name", sorted(resources.list_machine_names()))
def test_a_shipped_file_gives_the_same_machine_with_all_drivers(name: str) -> None:
    text = resources.read_machine_file(f"{name}.toml")
    data = parse_toml(text)
    few, all_of_them = (
        build_machine(data, text, name, each) for each in (load_used_drivers(data), load_all_drivers())
    )
    assert few == all_of_them


@pytest.mark.parametrize(
    ("old", "new", "known"),
    [
        ('backend = "sim"', 'backend = "him"', "grblhal"),
        ("[collet]", "[grblhall]\n[collet]", "did you mean grblhal?"),
    ],
)
def test_findings_list_values_of_drivers_that_are_not_loaded(old: str, new: str, known: str) -> None:
    assert old in TEXT
    with pytest.raises(MachineFileError, match=re.escape(known)):
        parse_machine(TEXT.replace(old, new), "own.toml")
