"""An inverter family as a table: line, registers, commands, polled values, faults and parameters.

``family_files.py`` reads these tables from TOML files, whose keys are declared here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.key_declaration import FileUnit, KeyRange, Pair, Words, declare_key, make_key_table
from core.table_schema import TableDescription

MODBUS, HUANYANG = "modbus", "huanyang"
_ADDRESS = KeyRange(0, 0xFFFF)
_COUNT_RANGE = KeyRange(0.01, 10_000.0)
ABSENT_REGISTER = -1  # Used for an address or value that is not in the file.


@make_key_table
class FamilyKeys:
    """The name of the inverter and the protocol of its frames."""

    name: str = declare_key(meaning="Name of the inverter, for messages.")
    manual: str = declare_key(meaning="Manual from which the registers come, with its number or date.")
    protocol: str = declare_key(
        choices=(MODBUS, HUANYANG), meaning="Frames on the line: Modbus RTU, or those of a Huanyang HY."
    )


@make_key_table
class SerialLineKeys:
    """The serial line settings that the inverter supports."""

    baud: Pair = declare_key(KeyRange(110, 1_000_000), meaning="Lowest and highest bit rate.")
    parity: Words = declare_key(meaning="Parities: `N`, `E` and `O`.")
    write_multiple: bool = declare_key(
        default=False, meaning="Registers are written with function 16. Default: function 6."
    )


@make_key_table
class FrequencyKeys:
    """A frequency in one or two registers."""

    register: int = declare_key(_ADDRESS, meaning="Address of the register in the frame.")
    counts_per_hz: float = declare_key(_COUNT_RANGE, meaning="Register value for 1 Hz.")
    words: int = declare_key(
        KeyRange(1, 2), default=1, meaning="Number of registers; of two, the first has the high word."
    )
    signed: bool = declare_key(default=False, meaning="A negative value is the reverse direction.")

    @property
    def max_hz(self) -> float:
        """Return the highest frequency in Hz that the registers can contain."""
        bits = 16 * self.words - self.signed
        return float((1 << bits) - 1) / self.counts_per_hz

    def encode_hz(self, hz: float) -> tuple[int, ...]:
        """Return the register values for a frequency in Hz.

        The sign is ignored unless ``signed`` is True.
        """
        counts = round((hz if self.signed else abs(hz)) * self.counts_per_hz)
        return tuple(counts >> 16 * place & 0xFFFF for place in reversed(range(self.words)))

    def decode_hz(self, words: Mapping[int, int]) -> float:
        """Return the frequency in Hz from register values by address.

        The result is never negative.
        """
        counts = 0
        for address in range(self.register, self.register + self.words):
            counts = counts << 16 | words[address]
        if self.signed and counts >> 16 * self.words - 1:
            counts = (1 << 16 * self.words) - counts
        return counts / self.counts_per_hz


@make_key_table
class OutputCurrentKeys:
    """The keys of the table for the register that contains the output current."""

    register: int = declare_key(_ADDRESS, meaning="Address of the register.")
    counts_per_a: float = declare_key(_COUNT_RANGE, meaning="Register value for 1 A.")


@make_key_table
class StateKeys:
    """Condition for an inverter state: a coil that is on, or a register with one of several values."""

    register: int = declare_key(_ADDRESS, default=ABSENT_REGISTER, meaning="Address of the register.")
    coil: int = declare_key(
        _ADDRESS, default=ABSENT_REGISTER, meaning="Address of the coil, if not a register."
    )
    mask: int = declare_key(_ADDRESS, default=0xFFFF, meaning="Bits of the register that matter.")
    values: tuple[float, ...] = declare_key(
        _ADDRESS, default=(), meaning="One to four values of these bits for which the state is on."
    )

    def is_active(self, words: Mapping[int, int], coils: Mapping[int, bool]) -> bool:
        """Return whether the state is active, according to register values and coils by address."""
        if self.coil != ABSENT_REGISTER:
            return coils[self.coil]
        return words[self.register] & self.mask in self.values


@make_key_table
class FaultCodeKeys:
    """The register that contains the fault code; 0 means no fault."""

    register: int = declare_key(_ADDRESS, meaning="Address of the register.")
    mask: int = declare_key(_ADDRESS, default=0xFFFF, meaning="Bits of the register that matter.")
    shown: str = declare_key(
        default="{code}",
        meaning="How the manual writes the number: `{code:04X}H` (0021H), `E{code:02d}` (E33).",
    )


@make_key_table
class ReadRequestKeys:
    """A read request of each poll."""

    register: int = declare_key(_ADDRESS, default=ABSENT_REGISTER, meaning="Address of the first register.")
    coil: int = declare_key(
        _ADDRESS, default=ABSENT_REGISTER, meaning="Address of the first coil, if not a register."
    )
    count: int = declare_key(KeyRange(1, 125), default=1, meaning="Number of registers or coils.")


@make_key_table
class WriteRequestKeys:
    """A write request of a command."""

    register: int = declare_key(_ADDRESS, default=ABSENT_REGISTER, meaning="Address of the register.")
    value: int = declare_key(_ADDRESS, default=ABSENT_REGISTER, meaning="Value for the register.")
    coil: int = declare_key(
        _ADDRESS, default=ABSENT_REGISTER, meaning="Address of the coil, if not a register."
    )
    on: bool = declare_key(default=False, meaning="Whether the coil is switched on.")


@make_key_table
class CommandKeys:
    """The settings for sending commands."""

    repeat: bool = declare_key(
        default=True,
        meaning="Every frequency is followed by the run command. false: only after a change.",
    )
    reset_tries: int = declare_key(
        KeyRange(1, 3), default=3, meaning="Number of times that a reset is sent without a response."
    )
    reset_pause_s: float = declare_key(
        KeyRange(0.0, 3.0, FileUnit.SECONDS),
        name="reset_pause_s",
        default=0.0,
        meaning="Time after a reset in which the inverter does not respond.",
    )


@make_key_table
class ParameterKeys:
    """A parameter that TurnDesk checks at each connection."""

    name: str = declare_key(meaning="Number of the parameter at the keypad.")
    register: int = declare_key(_ADDRESS, meaning="Address of the register.")
    value: int = declare_key(_ADDRESS, default=ABSENT_REGISTER, meaning="Value that the parameter must have.")
    counts_per_s: float = declare_key(
        KeyRange(0.1, 1000.0),
        default=0.0,
        meaning="In place of a value: this is the communication timeout, which must be `comm_loss_s`.",
    )
    why: str = declare_key(default="", meaning="What the value does, for the message.")
    write: bool = declare_key(
        default=False, meaning="TurnDesk writes the value if it differs. false: TurnDesk only reports it."
    )


@make_key_table
class MaxFrequencyKeys:
    """Parameter of the inverter that limits its output frequency."""

    name: str = declare_key(meaning="Number of the parameter at the keypad.")
    register: int = declare_key(_ADDRESS, meaning="Address of the register.")
    counts_per_hz: float = declare_key(_COUNT_RANGE, meaning="Register value for 1 Hz.")


@make_key_table
class LimitKeys:
    """The limits of the inverter that are independent of its parameters."""

    max_hz: float = declare_key(
        KeyRange(1.0, 5000.0), default=0.0, meaning="Highest output frequency. Default: that of the register."
    )


STATE_NAMES = ("run", "reverse", "asked_reverse", "fault")
COMMAND_NAMES = ("stop", "forward", "reverse", "reset")


def _table(path: str, keys: type, *, purpose: str) -> TableDescription:
    return TableDescription(f"{path} of a family file", purpose, keys)


# Tables of a family file, for the reference of the machine file.
FAMILY_TABLES = (
    _table(
        "(top)",
        purpose="The keys before the first table. A family file describes the registers of an "
        "inverter; `spindle.vfd.family` names it.",
        keys=FamilyKeys,
    ),
    _table(
        "line",
        purpose="The serial line. The machine file selects the settings.",
        keys=SerialLineKeys,
    ),
    _table(
        "frequency",
        purpose="The register for the commanded frequency. This and the next tables are for Modbus.",
        keys=FrequencyKeys,
    ),
    _table(
        "command",
        purpose="The commands. `stop`, `forward`, `reverse` and `reset` are lists of writes, as the "
        "next table describes them.",
        keys=CommandKeys,
    ),
    _table(
        "command.stop",
        purpose="One write of a command; `forward`, `reverse` and `reset` are alike.",
        keys=WriteRequestKeys,
    ),
    _table(
        "read",
        purpose="One read, `[[read]]`. TurnDesk sends all reads in their order, one request for each.",
        keys=ReadRequestKeys,
    ),
    _table(
        "report.output",
        purpose="The output frequency; `setpoint` has the same keys and is the frequency command as "
        "the inverter reports it.",
        keys=FrequencyKeys,
    ),
    _table(
        "report.current",
        purpose="The output current.",
        keys=OutputCurrentKeys,
    ),
    _table(
        "report.run",
        purpose="The run command as the inverter reports it, off from the stop command on. The same "
        "keys are for `reverse` (the motor turns in reverse), `asked_reverse` (reverse is "
        "commanded) and `fault` (the inverter has tripped; optional).",
        keys=StateKeys,
    ),
    _table(
        "report.fault_code",
        purpose="The fault code. If it is not in a read, TurnDesk reads it when `fault` is on. The "
        'optional table `[faults]` has a text for each code, such as `0x07 = "over-current"`.',
        keys=FaultCodeKeys,
    ),
    _table(
        "parameter",
        purpose="One parameter, `[[parameter]]`, that TurnDesk checks when it connects. Optional.",
        keys=ParameterKeys,
    ),
    _table(
        "highest",
        purpose="The parameter with the highest output frequency. Optional.",
        keys=MaxFrequencyKeys,
    ),
    _table(
        "limits",
        purpose="Limits of the inverter itself. Optional.",
        keys=LimitKeys,
    ),
)


@dataclass(frozen=True, slots=True)
class RegisterTable:
    """The registers and coils of an inverter on Modbus, with commands by name and fault texts by code."""

    commanded_frequency: FrequencyKeys
    command_settings: CommandKeys
    command_writes: Mapping[str, tuple[WriteRequestKeys, ...]]
    read_requests: tuple[ReadRequestKeys, ...]
    output_frequency: FrequencyKeys
    reported_setpoint: FrequencyKeys
    output_current: OutputCurrentKeys
    state_conditions: Mapping[str, StateKeys]
    fault_code: FaultCodeKeys
    fault_texts: Mapping[int, str]

    @property
    def is_fault_code_polled(self) -> bool:
        """Return whether a poll contains the fault code.

        Otherwise, the code is read only after a trip.
        """
        return any(
            each.register <= self.fault_code.register < each.register + each.count
            for each in self.read_requests
            if each.register != ABSENT_REGISTER
        )


@dataclass(frozen=True, slots=True)
class FamilyTable:
    """An inverter family.

    ``register_table`` is None for a family that does not use Modbus.
    """

    name: str
    protocol: str
    serial_line: SerialLineKeys
    parameters: tuple[ParameterKeys, ...] = ()
    max_frequency_parameter: MaxFrequencyKeys | None = None
    inverter_limits: LimitKeys = field(default_factory=LimitKeys)
    register_table: RegisterTable | None = None

    @property
    def max_hz(self) -> float:
        """Return the highest output frequency in Hz that can be commanded."""
        own = self.register_table.commanded_frequency.max_hz if self.register_table else 0xFFFF / 100.0
        return min(own, self.inverter_limits.max_hz or own)

    @property
    def setpoint_step_hz(self) -> float:
        """Return the resolution of the reported setpoint in Hz."""
        if self.register_table is None:
            return 0.01
        return 1.0 / min(
            self.register_table.commanded_frequency.counts_per_hz,
            self.register_table.reported_setpoint.counts_per_hz,
        )
