"""The table [spindle.vfd] of the machine file: the spindle inverter and its serial line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import KW_ONLY
from pathlib import Path
from typing import TYPE_CHECKING

from core.key_declaration import FileUnit, KeyRange, declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import DriverDeclaration, DriverTable, FileFinding, MachineFileReading

if TYPE_CHECKING:
    from drivers.serial_line import LineSettings

FAMILY_FOLDER = Path(__file__).with_name("families")
FAMILY_NAMES = tuple(sorted(path.stem for path in FAMILY_FOLDER.glob("*.toml")))
_TABLE_PATH = "spindle.vfd"


@make_key_table
class InverterTable:
    """The settings of an inverter and its serial line.

    ``hz_per_rpm`` refers to the spindle, including the belt. ``communication_timeout_s`` is the inverter's
    communication timeout in seconds.
    """

    _: KW_ONLY
    family: str = declare_key(
        meaning=f"Family of the inverter: {', '.join(f'`{name}`' for name in FAMILY_NAMES)}, or the "
        f"name of a "
        "TOML file with its registers, such as `my-drive.toml`, in the folder of the machine file."
    )
    port: str = declare_key(meaning="Serial port of the inverter, such as `/dev/serial/by-id/…`.")
    baud: int = declare_key(KeyRange(110, 1_000_000), default=9600, meaning="Bit rate of the line.")
    parity: str = declare_key(
        default="N", choices=("N", "E", "O"), meaning="Parity: none (N), even (E) or odd (O)."
    )
    stop: int = declare_key(KeyRange(1, 2), default=1, meaning="Stop bits of a character.")
    unit: int = declare_key(
        KeyRange(1, 247), name="id", default=1, meaning="Station number set at the inverter."
    )
    communication_timeout_s: float = declare_key(
        KeyRange(0.2, 10.0, FileUnit.SECONDS),
        name="comm_loss_s",
        default=1.5,
        meaning="Time without a message after which the inverter stops the spindle. A Huanyang does not "
        "have this function.",
    )
    hz_per_rpm: float = declare_key(
        KeyRange(0.001, 1.0),
        meaning="Output frequency in Hz per rpm of the spindle: pole pairs ÷ 60 × belt ratio.",
    )
    rated_current_a: float = declare_key(
        KeyRange(0.1, 1000.0),
        name="rated_a",
        default=0.0,
        meaning="Rated current of the motor in A, for the spindle load in percent. Default: not specified, "
        "and no load is shown.",
    )
    disagree: float = declare_key(
        KeyRange(0.05, 0.5, FileUnit.PERCENT),
        name="disagree_pct",
        default=0.15,
        meaning="Largest difference between the speeds of the encoder and the inverter before alarm 209.",
    )
    rpm_max: float

    @property
    def line_settings(self) -> LineSettings:
        """Return the settings of the serial line, which has eight data bits."""
        from drivers.serial_line import LineSettings  # noqa: PLC0415  few machines have one

        return LineSettings(self.port, self.baud, parity=self.parity, stop_bits=self.stop)


def _check_family(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding if the family is neither a shipped family nor the name of a TOML file.

    The TOML file itself is read only when the serial line to the inverter is opened.
    """
    path = f"{_TABLE_PATH}.family"
    if (
        file.file_values.has_values(path)
        and (name := file.file_values.text(path)) not in FAMILY_NAMES
        and name[-5:] != ".toml"
    ):
        text = "expected one of {families}, or the name of a .toml file in the folder of the machine file"
        yield FileFinding(
            path, format_toml_value(name), Message(text, families=", ".join(FAMILY_NAMES)), "wrong-value"
        )


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            _TABLE_PATH,
            InverterTable,
            lambda file: {"rpm_max": file.file_values.read_pair("spindle.rpm")[1]},
            check_rules=_check_family,
            serial_port_key=f"{_TABLE_PATH}.port",
            purpose='The inverter of the spindle on a serial line (`driver = "vfd"` of [spindle]).',
        ),
    ),
    spindle="vfd",
)
