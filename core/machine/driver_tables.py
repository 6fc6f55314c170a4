"""Driver tables and analog inputs of a machine file.

This module parses and checks the tables and builds the hardware model.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from core.machine.hardware_model import AnalogInputModel, Hardware, HomingModel
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import (
    DriverDeclaration,
    DriverTable,
    FileFinding,
    FileValues,
    MachineFileReading,
    find_raw_value,
    find_unknown_keys,
    read_named_tables,
    read_table_values,
)

ANALOG_INPUT_NAMES = ("feed_pot", "spindle_pot", "handwheel", "spindle_load")
_AXES = "XYZABC"


def list_driver_tables(drivers: Sequence[DriverDeclaration]) -> tuple[DriverTable, ...]:
    """Return the tables of all drivers in the order of the drivers."""
    return tuple(table for driver in drivers for table in driver.tables)


def list_driver_subtables(drivers: Sequence[DriverDeclaration], table_path: str) -> tuple[str, ...]:
    """Return the names of the subtables that drivers add to the control's own table ``table_path``."""
    parted = (table.path.rpartition(".") for table in list_driver_tables(drivers))
    return tuple(name for parent, _, name in parted if parent == table_path)


class DriverTableReader:
    """Parser of the driver tables of a machine file; ``findings`` contains the errors in these tables."""

    def __init__(self, file: MachineFileReading, drivers: Sequence[DriverDeclaration]) -> None:
        self.file = file
        self._tables = [table for table in list_driver_tables(drivers) if table.path in file.tables]
        self.findings: list[FileFinding] = []
        for table in self._tables:
            raw = file.raw(table.path)
            raw = {} if raw is None and table.is_always_read else raw
            self.findings += read_table_values(
                raw, table.key_class, table.path, file.file_values, table.child_tables
            )
            self.findings += table.read_children(file)
        self.findings += _read_analog(file)

    def build_hardware(self, outputs: Sequence[str]) -> Hardware:
        """Return the hardware model in the model's units.

        Call this method only if the file has no findings.
        """
        file, values = self.file, self.file.file_values
        refreshed = {name: values.read_number(f"io.out.{name}.refresh_ms") for name in outputs}
        return Hardware(
            uses_driver_host=values.read_flag("machine.feeder"),
            continues_without_screen=values.text("machine.screen_lost") == "continue",
            spindle_driver=values.text("spindle.driver"),
            tables={table.path: table.make_model(file) for table in self._tables},
            analog_inputs={
                name: values.make_model(AnalogInputModel, f"io.analog.{name}", name=name)
                for name in file.list_table_keys("io.analog")
            },
            homing_models={
                name: values.make_model(HomingModel, f"axis.{name}.home")
                for name in file.axes
                if values.has_values(f"axis.{name}.home.order")
            },
            refresh_timeouts_s={name: longest for name, longest in refreshed.items() if longest > 0.0},
        )


def list_existing_tables(
    file_data: Mapping[str, object], drivers: Sequence[DriverDeclaration]
) -> tuple[str, ...]:
    """Return the paths of the driver tables that are in the file or are always read."""
    return tuple(
        table.path
        for table in list_driver_tables(drivers)
        if table.is_always_read or find_raw_value(file_data, table.path) is not None
    )


def _read_analog(file: MachineFileReading) -> Iterator[FileFinding]:
    table = file.raw("io.analog")
    if isinstance(table, dict):
        yield from find_unknown_keys(table, list(ANALOG_INPUT_NAMES), "io.analog")
        table = {name: entry for name, entry in table.items() if name in ANALOG_INPUT_NAMES}
    yield from read_named_tables(
        {} if table is None else table, AnalogInputModel, "io.analog", file.file_values
    )


# --- rules between drivers and the rest of the file --------------------------------------------------------


def check_driver_tables(
    file: MachineFileReading, drivers: Sequence[DriverDeclaration]
) -> Iterator[FileFinding]:
    """Yield findings about the backend, spindle driver, ports, refreshed outputs and driver tables."""
    yield from _backend(file, drivers)
    yield from _spindle(file, drivers)
    yield from _check_orientation(file, drivers)
    yield from _check_count_rates(file.file_values, drivers)
    yield from _renewed(file)
    yield from _guard(file)
    yield from _check_serial_ports(file.file_values, drivers)
    for table in list_driver_tables(drivers):
        yield from table.check_rules(file)


def _backend(file: MachineFileReading, drivers: Sequence[DriverDeclaration]) -> Iterator[FileFinding]:
    for driver in drivers:
        path = driver.tables[0].path
        if (
            driver.backend_name
            and path not in file.tables
            and file.file_values.has_text("machine.backend", driver.backend_name)
        ):
            yield FileFinding(
                Message("[{path}]", path=path),
                "",
                Message(
                    'this table is missing but required by machine.backend = "{backend}"',
                    backend=driver.backend_name,
                ),
                "missing",
            )


def _spindle(file: MachineFileReading, drivers: Sequence[DriverDeclaration]) -> Iterator[FileFinding]:
    values, path = file.file_values, "spindle.driver"
    if not values.has_values(path, "machine.backend"):
        return
    word, backend = values.text(path), values.text("machine.backend")
    table_path_by_driver = {
        driver.spindle: driver.tables[0].path
        for driver in drivers
        if driver.spindle and not driver.backend_name
    }
    allowed = [
        *(driver.spindle for driver in drivers if driver.spindle and driver.backend_name == backend),
        *table_path_by_driver,
    ]
    if word not in allowed:
        expected = Message(
            "this value must be {allowed} with machine.backend = {backend}",
            allowed=" or ".join(allowed),
            backend=format_toml_value(backend),
        )
        yield FileFinding(path, format_toml_value(word), expected, "broken-rule")
    elif word in table_path_by_driver and table_path_by_driver[word] not in file.tables:
        yield FileFinding(
            table_path_by_driver[word],
            "",
            Message('this table is missing but required by spindle.driver = "{word}"', word=word),
            "missing",
        )


def _check_orientation(
    file: MachineFileReading, drivers: Sequence[DriverDeclaration]
) -> Iterator[FileFinding]:
    """Yield findings if spindle orientation is enabled but not possible.

    The spindle's driver must support orientation, and the spindle must not be the C axis.
    """
    values, path = file.file_values, "spindle.oriented"
    if not values.has_values(path, "spindle.driver") or not values.read_flag(path):
        return
    word = values.text("spindle.driver")
    can = [driver.spindle for driver in drivers if driver.can_orient_spindle]
    if word not in can:
        expected: str = Message(
            "this value must be false, because only a spindle with spindle.driver = {can} "
            "can be stopped at an angle",
            can=" or ".join(can),
        )
        yield FileFinding(path, "true", expected, "broken-rule")
    lathe = values.has_values("machine.kind", "axis.C.enabled", "axis.C.own_drive")
    lathe = lathe and values.has_text("machine.kind", "lathe")
    if lathe and values.read_flag("axis.C.enabled") and not values.read_flag("axis.C.own_drive"):
        expected = (
            "this value must be false, because the spindle is the C axis and is positioned "
            "as C; alternatively, set axis.C.own_drive = true"
        )
        yield FileFinding(path, "true", expected, "broken-rule")


def _check_count_rates(values: FileValues, drivers: Sequence[DriverDeclaration]) -> Iterator[FileFinding]:
    """Yield a finding for each axis whose counts per second exceed the limit of the backend."""
    rates = {driver.backend_name: driver.max_count_rate for driver in drivers}
    for axis in _AXES:
        path, count = f"axis.{axis}.vmax", f"axis.{axis}.count"
        if not values.has_values(path, count, "machine.backend"):
            continue
        rate, limit = (
            values.read_number(path) / values.read_number(count),
            rates[values.text("machine.backend")],
        )
        if rate > limit:
            yield FileFinding(
                path,
                "",
                Message(
                    "{rate} counts/s exceeds this backend's limit of {limit}; reduce vmax or use a "
                    "larger distance per count",
                    rate=f"{rate:.6g}",
                    limit=f"{limit:.6g}",
                ),
                "broken-rule",
            )


def _renewed(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    for path in file.terminals:
        wanted = path.startswith("io.out.") and values.has_values(f"{path}.refresh_ms", f"{path}.safe")
        if (
            wanted
            and values.read_number(f"{path}.refresh_ms")
            and values.values_by_path[f"{path}.safe"] is not False
        ):
            expected = "an output that switches off when it is not refreshed needs safe = false"
            yield FileFinding(
                f"{path}.refresh_ms",
                f"{1000 * values.read_number(f'{path}.refresh_ms'):g}",
                expected,
                "broken-rule",
            )


def _guard(file: MachineFileReading) -> Iterator[FileFinding]:
    path = "interlocks.guard_stops"
    named = "io.in.guard" in file.terminals or "io.in.guard.at" in file.file_values.invalid_paths
    if file.file_values.has_values(path) and file.file_values.read_flag(path) and not named:
        yield FileFinding(
            path,
            "true",
            "this setting needs an input named guard for the guard switch, which is on "
            "while the guard is closed",
            "broken-rule",
        )


def _check_serial_ports(values: FileValues, drivers: Sequence[DriverDeclaration]) -> Iterator[FileFinding]:
    """Yield a finding for each serial port that is used more than once."""
    taken: dict[str, str] = {}
    for path in (table.serial_port_key for table in list_driver_tables(drivers) if table.serial_port_key):
        if values.has_values(path):
            port = values.text(path)
            first = taken.setdefault(port, path)
            if first != path:
                yield FileFinding(
                    path,
                    format_toml_value(port),
                    Message("{first} already uses this port; choose another port", first=first),
                    "broken-rule",
                )
