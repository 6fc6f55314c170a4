"""Keys of the control's own tables in a machine file.

The ranges of the keys are in the units of the model, which are mm, s and degrees.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from core.key_declaration import (
    FileUnit,
    KeyField,
    KeyRange,
    KeySchema,
    Words,
    declare_key,
    get_declared_keys,
)
from core.machine.driver_tables import list_driver_tables
from core.machine.machine_model import (
    ClampingModel,
    ColletModel,
    Interlocks,
    LimitsModel,
    SpindleModel,
    Timing,
)
from core.table_schema import DriverDeclaration

MACHINE_KINDS = ("lathe", "mill")
LANGUAGES = {"lathe": ("omniturn", "sinumerik"), "mill": ("klartext",)}  # the first one is the default
LINEAR_AXES = {"lathe": ("X", "Z"), "mill": ("X", "Y", "Z")}
# rotary axes that a machine may have; C of a lathe is its spindle
ROTARY_AXES = {"lathe": (), "mill": ("A", "B", "C")}


class GeneralKeys:
    """The keys of [machine], except its times."""

    name: str = declare_key(meaning="Name of the machine, shown on the screen and in reports.")
    units: str = declare_key(
        choices=("inch", "mm"), meaning="Unit of every length, feed and acceleration in this file."
    )
    kind: str = declare_key(
        default="lathe",
        choices=MACHINE_KINDS,
        meaning="Kind of machine. It determines which axes, tables and languages the machine can have.",
    )
    backend: str = declare_key(
        default="sim",
        choices=("sim",),
        meaning="Connection to the machine. Each backend other than the simulated machine needs the "
        "table with the same name.",
    )
    language: str = declare_key(
        default="",
        choices=("omniturn", "sinumerik", "klartext"),
        meaning='Language of MDI blocks. Default: "omniturn" on a lathe, "klartext" on a mill. A lathe '
        'accepts "omniturn" and "sinumerik", a mill only "klartext".',
    )
    control: str = declare_key(
        default="840d",
        choices=("802d", "808d", "828d", "840d"),
        meaning="SINUMERIK control for which the programs were written. It determines how TurnDesk reads "
        "codes that differ between these controls.",
    )
    feeder: bool = declare_key(
        default=False,
        meaning='true: the drivers run in a separate process, the driver host. "canopen" and "hal" always '
        'use it, "grblhal" never.',
    )
    screen_lost: str = declare_key(
        default="hold",
        choices=("hold", "continue"),
        meaning="Reaction to a screen that has not answered for 3 s, or that was killed, during a program. "
        '"hold": feed hold. "continue": the machine finishes the part, and no other part begins before the '
        "screen responds again.",
    )
    x_is: str = declare_key(
        default="diameter",
        choices=("radius", "diameter"),
        meaning="Not used by this version. X is a radius everywhere in this file, and each language "
        "defines X in its programs.",
    )


class CAxisKeys:
    """The keys of [c_axis] of a lathe."""

    feedback: bool = declare_key(
        default=False,
        meaning="true: the drive reports that C has reached its angle. false: TurnDesk calculates when C "
        "arrives and warns if a dwell is too short.",
    )


class ToolingKeys:
    """The keys of [tooling]."""

    kind: str = declare_key(
        default="single",
        choices=("single", "gang", "turret"),
        meaning='"gang": all tools are on one plate, and the proof also checks the neighboring tools. '
        '"single": one tool at a time. "turret" is rejected because TurnDesk does not index turrets.',
    )


class CheckKeys:
    """The keys of [checks]."""

    silenced: Words = declare_key(
        default="",
        meaning="IDs of the checks of the part whose findings are only notes on this machine, such as "
        "`chip-load`; they are listed in [checks.md](../checks.md).",
    )


class MCodeKeys:
    """The keys of an M code that switches an output, in [m_codes.…]."""

    output: str = declare_key(meaning="Name of the output in [io.out] that the code switches.")
    on: bool = declare_key(meaning="State to which the code switches the output.")
    enabled: bool = declare_key(
        default=True, meaning="false: the code is defined, but programs that use it are rejected."
    )


class IgnoredMCodeKeys:
    """The keys of an M code of another machine that has no effect on this machine."""

    ignored: str = declare_key(
        choices=(True,),
        meaning="true: programs may contain this code of another machine, and it does nothing.",
    )
    enabled: bool = declare_key(default=True, meaning="false: programs that use the code are rejected.")


class _SpindleDriver:
    """Key ``driver`` of the table [spindle], whose choices come from the drivers."""

    driver: str = declare_key(
        default="sim",
        choices=("sim",),
        meaning='Driver of the spindle: that of the backend ("cia402" for CANopen), or "vfd" for an '
        "inverter on a serial line, which needs [spindle.vfd].",
    )


def _add_driver_choices(keys: tuple[KeyField, ...], key: str, words: Iterable[str]) -> tuple[KeyField, ...]:
    """Return the keys with the choices of the key ``key`` set to the words that the drivers provide."""
    choices = tuple(word for word in words if word)
    return tuple(replace(each, choices=choices) if each.key == key else each for each in keys)


def get_machine_table_keys(drivers: Sequence[DriverDeclaration]) -> tuple[KeyField, ...]:
    """Return the keys of [machine], including the backends of the drivers."""
    keys = (*get_declared_keys(GeneralKeys), *get_declared_keys(Timing))
    return _add_driver_choices(keys, "backend", (driver.backend_name for driver in drivers))


def list_tables_without_subtables(drivers: Sequence[DriverDeclaration]) -> tuple[tuple[str, KeySchema], ...]:
    """Return the paths and keys of the tables that do not contain other tables.

    The tables axis, io and m_codes contain other tables, some of which have names chosen in the file. The
    names of the spindle drivers come from the drivers.
    """
    spindle = (*get_declared_keys(SpindleModel), *get_declared_keys(_SpindleDriver))
    return (
        ("limits", LimitsModel),
        ("c_axis", CAxisKeys),
        ("spindle", _add_driver_choices(spindle, "driver", (driver.spindle for driver in drivers))),
        ("collet", ColletModel),
        ("interlocks", Interlocks),
        ("clamping", ClampingModel),
        ("tooling", ToolingKeys),
        ("checks", CheckKeys),
    )


def list_top_level_tables(drivers: Sequence[DriverDeclaration]) -> tuple[str, ...]:
    """Return the names of all tables that a file may contain, in the order of the documentation."""
    own = [table for table in list_driver_tables(drivers) if "." not in table.path]
    return (
        *(
            "machine",
            "limits",
            "axis",
            "c_axis",
            "spindle",
            "collet",
            "clamping",
            "tooling",
            "checks",
            "interlocks",
            "io",
            "m_codes",
        ),
        *(table.path for table in own if table.is_always_read),
        "kinematics",
        *(table.path for table in own if not table.is_always_read),
    )


class _NoColletKeys:
    """Substitute for the model of table [collet] on a mill, which has no collet."""

    open_s: float = declare_key(
        KeyRange(0.0, 10.0, FileUnit.SECONDS), default=0.0, meaning="A mill has no collet."
    )
    close_s: float = declare_key(
        KeyRange(0.0, 10.0, FileUnit.SECONDS), default=0.0, meaning="A mill has no collet."
    )


# A mill does not have these tables, and its model contains these defaults.
LATHE_TABLES: dict[str, type] = {"c_axis": CAxisKeys, "collet": _NoColletKeys}
OPTIONAL_TABLES = ("limits", "collet", "clamping", "tooling", "checks", "c_axis", "interlocks", "m_codes")

# M codes with a fixed meaning in the machine's language, which the machine file cannot assign.
FIXED_M_CODES = {
    "omniturn": frozenset((0, 1, 2, 3, 4, 5, 8, 9, 12, 13, 19, 30, 31, 89, *range(91, 100))),
    "sinumerik": frozenset((0, 1, 2, 3, 4, 5, 7, 8, 9, 17, 19, 30, 70, 98, 99)),
    "klartext": frozenset((0, 1, 2, 3, 4, 5, 8, 9, 13, 14, 19, 30, 31, 89, *range(91, 100))),
}
