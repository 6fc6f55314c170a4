"""List of the modules that declare drivers' machine file tables, each loaded only when needed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import NamedTuple

from app.compose.optional_features import extras, insert_items_after
from core.table_schema import DriverDeclaration, find_raw_value


class DriverModule(NamedTuple):
    """Location of a ``DriverDeclaration``, with the names in a machine file that require it.

    - ``tables`` are the paths of its tables.
    - ``backend_name`` and ``spindle`` are the names of a backend and of a spindle driver.
    - ``attribute_name`` is the name of the ``DriverDeclaration`` in the module.
    - ``is_always_loaded`` means that the module is loaded for every file.
    """

    module_name: str
    tables: tuple[str, ...]
    backend_name: str = ""
    spindle: str = ""
    attribute_name: str = "DRIVER"
    is_always_loaded: bool = False

    def load_driver(self) -> DriverDeclaration:
        """Return the ``DriverDeclaration`` of the module."""
        driver: DriverDeclaration = getattr(import_module(self.module_name), self.attribute_name)
        return driver


# The order is that of the findings. The module that assembles a backend is named in ``backend_entry``.
_OWN_MODULES = (
    DriverModule("drivers.simulated.simulated_table", ("sim",), "sim", "sim", is_always_loaded=True),
    DriverModule("drivers.canopen.canopen_table", ("canopen", "spindle.encoder"), "canopen", "cia402"),
    DriverModule("drivers.inverter.inverter_table", ("spindle.vfd",), "", "vfd"),
    DriverModule("drivers.grblhal.grblhal_table", ("grblhal",), "grblhal", "grblhal"),
    DriverModule("drivers.hal.hal_table", ("hal",), "hal", "hal"),
    DriverModule("drivers.hal.boards.board_table", ("board",)),
    DriverModule("core.machine.serial_and_backup_tables", ("dnc",), attribute_name="DNC_DRIVER"),
    DriverModule("core.machine.setter_table", ("setter",), attribute_name="SETTER_DRIVER"),
    DriverModule("core.machine.serial_and_backup_tables", ("backup",), attribute_name="BACKUP_DRIVER"),
)


@cache
def list_driver_modules() -> tuple[DriverModule, ...]:
    """Return the modules of all drivers and optional features.

    The order of the modules is the order in which findings are reported.
    """
    added = [
        (DriverModule(module, tables), extra.preceding_table)
        for extra in extras().values()
        for module, tables in extra.machine_tables.items()
    ]
    return tuple(insert_items_after(_OWN_MODULES, lambda each: each.tables[0], added))


def load_all_drivers() -> tuple[DriverDeclaration, ...]:
    """Return the declarations of all driver modules."""
    return _loaded(list_driver_modules())


def load_used_drivers(file_data: Mapping[str, object]) -> tuple[DriverDeclaration, ...]:
    """Return the drivers that a parsed machine file uses through a table or a name.

    For a file without errors, these drivers and the set of all drivers result in the same machine.
    """
    return _loaded(
        each for each in list_driver_modules() if each.is_always_loaded or _is_used(each, file_data)
    )


def _is_used(module: DriverModule, data: Mapping[str, object]) -> bool:
    return any(_marks(module, data))


def _marks(module: DriverModule, data: Mapping[str, object]) -> Iterator[bool]:
    yield bool(module.backend_name) and find_raw_value(data, "machine.backend") == module.backend_name
    yield bool(module.spindle) and find_raw_value(data, "spindle.driver") == module.spindle
    for path in module.tables:
        yield find_raw_value(data, path) is not None


def _loaded(modules: Iterable[DriverModule]) -> tuple[DriverDeclaration, ...]:
    return tuple(each.load_driver() for each in modules)
