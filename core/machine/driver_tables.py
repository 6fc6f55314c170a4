"""Tables that drivers add to a machine file, and pots: reading, checks and construction of the model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from core.machine.hardware_model import AnalogModel, Hardware, HomeModel
from core.message import Message
from core.table_schema import (
    Driver,
    DriverTable,
    FileReading,
    Finding,
    Values,
    raw_at,
    read_named,
    read_table,
    unknown_keys,
    written,
)

ANALOG_NAMES = ("feed_pot", "spindle_pot", "handwheel", "spindle_load")
_AXES = "XYZABC"


def tables_of(drivers: Sequence[Driver]) -> tuple[DriverTable, ...]:
    """Return the tables of all drivers, in the order of the drivers."""
    return tuple(table for driver in drivers for table in driver.tables)


def children_of(drivers: Sequence[Driver], path: str) -> tuple[str, ...]:
    """Return the names of the tables that drivers add inside one of the control's own tables."""
    parted = (table.path.rpartition(".") for table in tables_of(drivers))
    return tuple(name for parent, _, name in parted if parent == path)


class DriverReading:
    """Reads the drivers' tables of a machine file; ``findings`` contains the errors in them."""

    def __init__(self, file: FileReading, drivers: Sequence[Driver]) -> None:
        self.file = file
        self._tables = [table for table in tables_of(drivers) if table.path in file.tables]
        self.findings: list[Finding] = []
        for table in self._tables:
            raw = file.raw(table.path)
            raw = {} if raw is None and table.always else raw
            self.findings += read_table(raw, table.keys, table.path, file.values, table.children)
            self.findings += table.read_children(file)
        self.findings += _read_analog(file)

    def hardware(self, outputs: Sequence[str]) -> Hardware:
        """Return the hardware model in the model's units. The file must not have findings."""
        file, values = self.file, self.file.values
        refreshed = {name: values.number(f"io.out.{name}.refresh_ms") for name in outputs}
        return Hardware(
            feeder=values.flag("machine.feeder"),
            continues_alone=values.text("machine.screen_lost") == "continue",
            spindle_driver=values.text("spindle.driver"),
            tables={table.path: table.model(file) for table in self._tables},
            analog={
                name: values.model(AnalogModel, f"io.analog.{name}", name=name)
                for name in file.names("io.analog")
            },
            homes={
                name: values.model(HomeModel, f"axis.{name}.home")
                for name in file.axes
                if values.has(f"axis.{name}.home.order")
            },
            refresh={name: longest for name, longest in refreshed.items() if longest > 0.0},
        )


def tables_there(data: Mapping[str, object], drivers: Sequence[Driver]) -> tuple[str, ...]:
    """Return the paths of the drivers' tables that a file has, or that always exist."""
    return tuple(
        table.path for table in tables_of(drivers) if table.always or raw_at(data, table.path) is not None
    )


def _read_analog(file: FileReading) -> Iterator[Finding]:
    table = file.raw("io.analog")
    if isinstance(table, dict):
        yield from unknown_keys(table, list(ANALOG_NAMES), "io.analog")
        table = {name: entry for name, entry in table.items() if name in ANALOG_NAMES}
    yield from read_named({} if table is None else table, AnalogModel, "io.analog", file.values)


# --- rules between drivers and the rest of the file --------------------------------------------------------


def broken(file: FileReading, drivers: Sequence[Driver]) -> Iterator[Finding]:
    """Yield findings about backend, spindle driver, ports, refreshed outputs and the driver tables."""
    yield from _backend(file, drivers)
    yield from _spindle(file, drivers)
    yield from _orients(file, drivers)
    yield from _count_rates(file.values, drivers)
    yield from _renewed(file)
    yield from _guard(file)
    yield from _ports(file.values, drivers)
    for table in tables_of(drivers):
        yield from table.rules(file)


def _backend(file: FileReading, drivers: Sequence[Driver]) -> Iterator[Finding]:
    for driver in drivers:
        path = driver.tables[0].path
        if driver.backend and path not in file.tables and file.values.says("machine.backend", driver.backend):
            yield Finding(
                Message("[{path}]", path=path),
                "",
                Message(
                    'this table is missing but required by machine.backend = "{backend}"',
                    backend=driver.backend,
                ),
                "missing",
            )


def _spindle(file: FileReading, drivers: Sequence[Driver]) -> Iterator[Finding]:
    values, path = file.values, "spindle.driver"
    if not values.has(path, "machine.backend"):
        return
    word, backend = values.text(path), values.text("machine.backend")
    beside = {
        driver.spindle: driver.tables[0].path for driver in drivers if driver.spindle and not driver.backend
    }
    allowed = [
        *(driver.spindle for driver in drivers if driver.spindle and driver.backend == backend),
        *beside,
    ]
    if word not in allowed:
        expected = Message(
            "this value must be {allowed} with machine.backend = {backend}",
            allowed=" or ".join(allowed),
            backend=written(backend),
        )
        yield Finding(path, written(word), expected, "broken-rule")
    elif word in beside and beside[word] not in file.tables:
        yield Finding(
            beside[word],
            "",
            Message('this table is missing but required by spindle.driver = "{word}"', word=word),
            "missing",
        )


def _orients(file: FileReading, drivers: Sequence[Driver]) -> Iterator[Finding]:
    """Check that an oriented spindle has a driver for it and is not the C axis."""
    values, path = file.values, "spindle.oriented"
    if not values.has(path, "spindle.driver") or not values.flag(path):
        return
    word = values.text("spindle.driver")
    can = [driver.spindle for driver in drivers if driver.orients]
    if word not in can:
        expected: str = Message(
            "this value must be false, because only a spindle with spindle.driver = {can} "
            "can be stopped at an angle",
            can=" or ".join(can),
        )
        yield Finding(path, "true", expected, "broken-rule")
    lathe = values.has("machine.kind", "axis.C.enabled", "axis.C.own_drive")
    lathe = lathe and values.says("machine.kind", "lathe")
    if lathe and values.flag("axis.C.enabled") and not values.flag("axis.C.own_drive"):
        expected = (
            "this value must be false, because the spindle is the C axis and is positioned "
            "as C; alternatively, set axis.C.own_drive = true"
        )
        yield Finding(path, "true", expected, "broken-rule")


def _count_rates(values: Values, drivers: Sequence[Driver]) -> Iterator[Finding]:
    """Check the counts per second of each axis against the limit of the backend."""
    rates = {driver.backend: driver.count_rate for driver in drivers}
    for axis in _AXES:
        path, count = f"axis.{axis}.vmax", f"axis.{axis}.count"
        if not values.has(path, count, "machine.backend"):
            continue
        rate, limit = values.number(path) / values.number(count), rates[values.text("machine.backend")]
        if rate > limit:
            yield Finding(
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


def _renewed(file: FileReading) -> Iterator[Finding]:
    values = file.values
    for path in file.terminals:
        wanted = path.startswith("io.out.") and values.has(f"{path}.refresh_ms", f"{path}.safe")
        if wanted and values.number(f"{path}.refresh_ms") and values.found[f"{path}.safe"] is not False:
            expected = "an output that switches off when it is not refreshed needs safe = false"
            yield Finding(
                f"{path}.refresh_ms",
                f"{1000 * values.number(f'{path}.refresh_ms'):g}",
                expected,
                "broken-rule",
            )


def _guard(file: FileReading) -> Iterator[Finding]:
    path = "interlocks.guard_stops"
    named = "io.in.guard" in file.terminals or "io.in.guard.at" in file.values.wrong
    if file.values.has(path) and file.values.flag(path) and not named:
        yield Finding(
            path,
            "true",
            "this setting needs an input named guard for the guard switch, which is on "
            "while the guard is closed",
            "broken-rule",
        )


def _ports(values: Values, drivers: Sequence[Driver]) -> Iterator[Finding]:
    """Check that no serial port is used twice."""
    taken: dict[str, str] = {}
    for path in (table.port for table in tables_of(drivers) if table.port):
        if values.has(path):
            port = values.text(path)
            first = taken.setdefault(port, path)
            if first != path:
                yield Finding(
                    path,
                    written(port),
                    Message("{first} already uses this port; choose another port", first=first),
                    "broken-rule",
                )
