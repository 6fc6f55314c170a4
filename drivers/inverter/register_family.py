"""An inverter on Modbus that is controlled by the register table of its family."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from core.message import Message
from core.ports import Clock
from drivers.inverter.family_table import ABSENT_REGISTER, FamilyTable, RegisterTable, WriteRequestKeys
from drivers.inverter.inverter_family import InverterState, write_and_check_parameters
from drivers.inverter.modbus_rtu import MAX_TRIES, ModbusMaster


class RegisterInverter:
    """An ``InverterFamily`` with a register table and exclusive use of its line."""

    required_response_count = 1

    def __init__(
        self, table: FamilyTable, registers: RegisterTable, line: ModbusMaster, clock: Clock
    ) -> None:
        self._table, self._registers, self._line, self._clock = table, registers, line, clock
        self._said: Sequence[WriteRequestKeys] = ()  # Run command that is known to be active.

    @property
    def is_stop_pending(self) -> Callable[[], bool]:
        """Return the function with which the serial line checks whether a stop is pending."""
        return self._line.is_stop_pending

    @is_stop_pending.setter
    def is_stop_pending(self, is_stop_pending: Callable[[], bool]) -> None:
        """Set the function that returns whether a stop is pending and other requests must be canceled."""
        self._line.is_stop_pending = is_stop_pending

    @property
    def valid_response_count(self) -> int:
        """Return the number of consecutive valid responses."""
        return self._line.valid_response_count

    def check_parameters(self, comm_timeout_s: float, max_hz: float) -> list[str]:
        """Check the parameters of the table, and return the messages for the operator.

        ``comm_timeout_s`` is in seconds, and ``max_hz`` is in Hz.
        """
        self._said = ()
        return write_and_check_parameters(
            self._table,
            comm_timeout_s,
            max_hz,
            lambda register: self._line.read_registers(register)[0],
            self._write,
        )

    def stop_motor(self) -> None:
        """Stop the motor by the inverter's ramp."""
        self._said = ()
        for each in self._registers.command_writes["stop"]:
            self._send(each)

    def command_frequency_hz(self, hz: float) -> None:
        """Send the frequency, and then the run command.

        The frequency is sent first, so that the inverter never starts with an old frequency.
        """
        frequency = self._registers.commanded_frequency
        words = frequency.encode_hz(hz)
        if len(words) > 1:
            self._line.write_registers(frequency.register, words, is_canceled_by_stop=True)
        else:
            self._write(frequency.register, words[0], gives_way=True)
        writes = self._registers.command_writes["reverse" if hz < 0.0 else "forward"]
        if writes == self._said and not self._registers.command_settings.repeat:
            return
        self._said = ()  # Until all writes are acknowledged.
        for each in writes:
            self._send(each, gives_way=True)
        self._said = writes

    def iter_poll_steps(self) -> Iterator[InverterState | None]:
        """Poll the inverter read request by read request.

        The iterator yields None between requests and the state at the end.
        """
        words: dict[int, int] = {}
        coils: dict[int, bool] = {}
        for each in self._registers.read_requests:
            if each.coil == ABSENT_REGISTER:
                words |= enumerate(self._line.read_registers(each.register, each.count), each.register)
            else:
                coils |= enumerate(self._line.read_coils(each.coil, each.count), each.coil)
            yield None
        yield self._look(words, coils)

    def reset_trip(self) -> None:
        """Reset a trip of the inverter.

        Afterward, all requests of the next command are sent again.
        """
        self._said = ()
        sending = self._registers.command_settings
        for each in self._registers.command_writes["reset"]:
            self._send(each, sending.reset_tries)
        if sending.reset_pause_s:
            self._clock.sleep_until(self._clock.now() + sending.reset_pause_s)

    def close(self) -> None:
        """Close the line."""
        self._line.wire.close()

    def _send(self, each: WriteRequestKeys, tries: int = MAX_TRIES, *, gives_way: bool = False) -> None:
        if each.coil == ABSENT_REGISTER:
            self._write(each.register, each.value, tries, gives_way=gives_way)
        else:
            self._line.write_coil(each.coil, each.on, tries, is_canceled_by_stop=gives_way)

    def _write(self, register: int, value: int, tries: int = MAX_TRIES, *, gives_way: bool = False) -> None:
        if self._table.serial_line.write_multiple:
            self._line.write_registers(register, (value,), tries, is_canceled_by_stop=gives_way)
        else:
            self._line.write_register(register, value, tries, is_canceled_by_stop=gives_way)

    def _look(self, words: Mapping[int, int], coils: Mapping[int, bool]) -> InverterState:
        table = self._registers
        on = {name: state.is_active(words, coils) for name, state in table.state_conditions.items()}
        return InverterState(
            output_hz=table.output_frequency.decode_hz(words),
            setpoint_hz=table.reported_setpoint.decode_hz(words),
            is_running=on["run"],
            is_reverse_direction=on["reverse"],
            is_reverse_commanded=on["asked_reverse"],
            trip_text=self._describe_trip(words) if on.get("fault", True) else "",
            current_a=words[table.output_current.register] / table.output_current.counts_per_a,
        )

    def _describe_trip(self, words: Mapping[int, int]) -> str:
        """Return the fault text of the inverter for its fault code.

        In a family without a fault state, code 0 means no fault, and the result is an empty string.
        """
        table = self._registers
        register = table.fault_code.register
        code = words[register] if table.is_fault_code_polled else self._line.read_registers(register)[0]
        code &= table.fault_code.mask
        if code == 0 and "fault" not in table.state_conditions:
            return ""
        number = table.fault_code.shown.format(code=code)
        return table.fault_texts.get(code, Message("fault code {code} in the inverter manual", code=number))
