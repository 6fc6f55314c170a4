"""Inverter on Modbus that follows the register table of its family."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from core.message import Message
from core.ports import Clock
from drivers.inverter.family_table import ABSENT, FamilyTable, RegisterTable, WriteKeys
from drivers.inverter.inverter_family import Look, check_parameters
from drivers.inverter.modbus_rtu import TRIES, Modbus


class RegisterFamily:
    """``Family`` of a register table, on the line that it alone uses."""

    warm_up = 1

    def __init__(self, table: FamilyTable, registers: RegisterTable, line: Modbus, clock: Clock) -> None:
        self._table, self._registers, self._line, self._clock = table, registers, line, clock
        self._said: Sequence[WriteKeys] = ()  # the run command in force, as far as is known

    @property
    def hurry(self) -> Callable[[], bool]:
        """Whether a stop waits."""
        return self._line.hurry

    @hurry.setter
    def hurry(self, asked: Callable[[], bool]) -> None:
        """``asked`` tells whether a stop waits: what is no stop breaks off, and no run command is sent."""
        self._line.hurry = asked

    @property
    def good(self) -> int:
        """Good answers in a row."""
        return self._line.good

    def prepare(self, comm_loss: float, highest: float) -> list[str]:
        """Check the parameters of the table; ``comm_loss`` in s, ``highest`` in Hz."""
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
        """Send the frequency first, so that the inverter never starts at an old one."""
        frequency = self._registers.frequency
        words = frequency.words_of(hz)
        if len(words) > 1:
            self._line.write_registers(frequency.register, words, gives_way=True)
        else:
            self._write(frequency.register, words[0], gives_way=True)
        writes = self._registers.commands["reverse" if hz < 0.0 else "forward"]
        if writes == self._said and not self._registers.sending.repeat:
            return
        self._said = ()  # until all of it is answered
        for each in writes:
            self._send(each, gives_way=True)
        self._said = writes

    def looks(self) -> Iterator[Look | None]:
        """One look, read by read."""
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
        """Clear a trip. The next command is sent from the beginning."""
        self._said = ()
        sending = self._registers.sending
        for each in self._registers.commands["reset"]:
            self._send(each, sending.reset_tries)
        if sending.reset_pause:
            self._clock.sleep_until(self._clock.now() + sending.reset_pause)

    def close(self) -> None:
        """Let the line go."""
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
        """Return the text of the fault code. Without a fault state, code 0 is no fault."""
        table = self._registers
        register = table.code.register
        code = words[register] if table.code_is_polled else self._line.registers(register)[0]
        code &= table.code.mask
        if code == 0 and "fault" not in table.states:
            return ""
        number = table.code.shown.format(code=code)
        return table.faults.get(code, Message("fault code {code} in the inverter manual", code=number))
