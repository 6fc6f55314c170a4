"""Inverter on Modbus that is controlled by the register table of its family."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from core.message import Message
from core.ports import Clock
from drivers.inverter.family_table import ABSENT, FamilyTable, RegisterTable, WriteKeys
from drivers.inverter.inverter_family import Look, check_parameters
from drivers.inverter.modbus_rtu import TRIES, Modbus


class RegisterFamily:
    """``Family`` with a register table and the exclusive use of its line."""

    warm_up = 1

    def __init__(self, table: FamilyTable, registers: RegisterTable, line: Modbus, clock: Clock) -> None:
        self._table, self._registers, self._line, self._clock = table, registers, line, clock
        self._said: Sequence[WriteKeys] = ()  # Run command that is known to be active.

    @property
    def hurry(self) -> Callable[[], bool]:
        """The function that returns whether a stop is pending."""
        return self._line.hurry

    @hurry.setter
    def hurry(self, asked: Callable[[], bool]) -> None:
        """Set the function that returns whether a stop is pending and other requests must be canceled."""
        self._line.hurry = asked

    @property
    def good(self) -> int:
        """The number of consecutive valid responses."""
        return self._line.good

    def prepare(self, comm_loss: float, highest: float) -> list[str]:
        """Check the parameters of the table; ``comm_loss`` in seconds, ``highest`` in Hz."""
        self._said = ()
        return check_parameters(
            self._table, comm_loss, highest, lambda register: self._line.registers(register)[0], self._write
        )

    def stop(self) -> None:
        """Stop by the inverter's ramp."""
        self._said = ()
        for each in self._registers.commands["stop"]:
            self._send(each)

    def command(self, hz: float) -> None:
        """Send the frequency first, so that the inverter never starts with an old frequency."""
        frequency = self._registers.frequency
        words = frequency.words_of(hz)
        if len(words) > 1:
            self._line.write_registers(frequency.register, words, gives_way=True)
        else:
            self._write(frequency.register, words[0], gives_way=True)
        writes = self._registers.commands["reverse" if hz < 0.0 else "forward"]
        if writes == self._said and not self._registers.sending.repeat:
            return
        self._said = ()  # Until all writes are acknowledged.
        for each in writes:
            self._send(each, gives_way=True)
        self._said = writes

    def looks(self) -> Iterator[Look | None]:
        """Poll the inverter read by read; yield None between requests and the state at the end."""
        words: dict[int, int] = {}
        coils: dict[int, bool] = {}
        for each in self._registers.reads:
            if each.coil == ABSENT:
                words |= enumerate(self._line.registers(each.register, each.count), each.register)
            else:
                coils |= enumerate(self._line.coils(each.coil, each.count), each.coil)
            yield None
        yield self._look(words, coils)

    def reset(self) -> None:
        """Reset a trip; the next command is then sent completely."""
        self._said = ()
        sending = self._registers.sending
        for each in self._registers.commands["reset"]:
            self._send(each, sending.reset_tries)
        if sending.reset_pause:
            self._clock.sleep_until(self._clock.now() + sending.reset_pause)

    def close(self) -> None:
        """Close the line."""
        self._line.wire.close()

    def _send(self, each: WriteKeys, tries: int = TRIES, *, gives_way: bool = False) -> None:
        if each.coil == ABSENT:
            self._write(each.register, each.value, tries, gives_way=gives_way)
        else:
            self._line.write_coil(each.coil, each.on, tries, gives_way=gives_way)

    def _write(self, register: int, value: int, tries: int = TRIES, *, gives_way: bool = False) -> None:
        if self._table.line.write_multiple:
            self._line.write_registers(register, (value,), tries, gives_way=gives_way)
        else:
            self._line.write_register(register, value, tries, gives_way=gives_way)

    def _look(self, words: Mapping[int, int], coils: Mapping[int, bool]) -> Look:
        table = self._registers
        on = {name: state.applies(words, coils) for name, state in table.states.items()}
        return Look(
            output=table.output.hertz(words),
            setpoint=table.setpoint.hertz(words),
            run=on["run"],
            reverse=on["reverse"],
            asked_reverse=on["asked_reverse"],
            trip=self._trip(words) if on.get("fault", True) else "",
            current=words[table.current.register] / table.current.counts_per_a,
        )

    def _trip(self, words: Mapping[int, int]) -> str:
        """Return the text of the fault code; without a fault state, code 0 means no fault."""
        table = self._registers
        register = table.code.register
        code = words[register] if table.code_is_polled else self._line.registers(register)[0]
        code &= table.code.mask
        if code == 0 and "fault" not in table.states:
            return ""
        number = table.code.shown.format(code=code)
        return table.faults.get(code, Message("fault code {code} in the inverter manual", code=number))
