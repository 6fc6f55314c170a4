"""Huanyang HY inverters, which use their own frames with the CRC of Modbus.

The protocol follows LinuxCNC's hy_vfd and the list of Bouni. A frame consists of unit, function, length, data
and CRC. Functions 1 and 2 read and write a parameter PDnnn, 3 controls and returns the state, 4 reads a
value, and 5 sets the frequency. A response names the requested parameter or value, so an old response is
detected.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator

from core.ports import Clock
from drivers.inverter.family_table import FamilyTable
from drivers.inverter.inverter_family import Look, check_parameters
from drivers.inverter.modbus_rtu import PACE, HeldBackError, NoAnswerError, never, sealed, whole
from drivers.serial_line import Wire

_READ, _CONTROL, _VALUE, _FREQUENCY = 1, 3, 4, 5
_RUN, _RUN_BACK, _HALT = 0x01, 0x11, 0x08
_SETPOINT, _OUTPUT, _CURRENT = 0, 1, 2
_TIMEOUT = 0.5  # s
_TRIES = 2


class HuanyangHy:
    """Huanyang HY inverter, which reports its state only in the response to a command.

    Each poll therefore repeats the present command.
    """

    warm_up = 10

    def __init__(self, table: FamilyTable, wire: Wire, clock: Clock, unit: int, character: float) -> None:
        self._table = table
        self._wire, self._clock, self._unit = wire, clock, unit
        self._gap = max(3.5 * character, 0.00175)
        self._free = clock.now()
        self._word = _HALT
        self.hurry: Callable[[], bool] = never
        self._good = 0

    @property
    def good(self) -> int:
        return self._good

    def prepare(self, comm_loss: float, highest: float) -> list[str]:
        """Check the parameters, which are never written; the inverter has no communication timeout.

        Return the messages for the operator.
        """
        return check_parameters(self._table, comm_loss, highest, self._parameter, _never_written)

    def stop(self) -> None:
        """Stop by the inverter's ramp, which requires PD026 = 0."""
        self._word = _HALT
        self._control()

    def command(self, hz: float) -> None:
        """Send the frequency in Hz, then the run command; a negative frequency turns in reverse."""
        value = struct.pack(">H", round(abs(hz) * 100.0))
        self._ask(_FREQUENCY, value, value)
        self._word = _RUN_BACK if hz < 0.0 else _RUN
        self._control()

    def looks(self) -> Iterator[Look | None]:
        """Poll the inverter request by request; yield None between requests and the state at the end.

        State bits: 0 run command, 2 reverse command, 3 running, 5 running in reverse.
        """
        state = self._control()
        yield None
        values: list[int] = []
        for index in (_SETPOINT, _OUTPUT, _CURRENT):
            values.append(self._value(index))
            yield None
        yield Look(
            output=values[1] / 100.0,
            setpoint=values[0] / 100.0,
            run=bool(state & 0x01),
            reverse=bool(state & 0x20),
            asked_reverse=bool(state & 0x04),
            current=values[2] / 10.0,
        )

    def reset(self) -> None:
        """Send a stop, because a trip can be reset only at the keypad.

        Without a trip, the stop makes the inverter ready again.
        """
        self.stop()

    def close(self) -> None:
        self._wire.close()

    def _control(self) -> int:
        return self._ask(_CONTROL, bytes((self._word,)), b"")[0]

    def _value(self, index: int) -> int:
        head = bytes((index,))
        return int.from_bytes(self._ask(_VALUE, head, head)[1:], "big")

    def _parameter(self, which: int) -> int:
        head = bytes((which,))
        return int.from_bytes(self._ask(_READ, head + b"\0\0", head)[1:], "big")

    def _ask(self, function: int, data: bytes, begins: bytes) -> bytes:
        """Return the data of the response, which begins with ``begins``.

        Raises NoAnswerError without a valid response.
        """
        for left in reversed(range(_TRIES)):
            answer = self._once(function, data, begins)
            if answer is not None:
                self._good += 1
                return answer
            self._good = 0
            if not self.hurry():
                self._wire.receive(_TIMEOUT)  # A late response must be discarded.
            if left and self.hurry() and function in (_READ, _VALUE):
                break
        raise NoAnswerError(
            "the inverter does not respond; check the cable, PD163 (id), PD164 and PD165 (line settings)",
            reason="silent",
        )

    def _once(self, function: int, data: bytes, begins: bytes) -> bytes | None:
        self._clock.sleep_until(self._free)
        if self._can_turn(function) and self.hurry():
            raise HeldBackError
        self._wire.discard()
        began = self._clock.now()
        self._wire.send(sealed(bytes((self._unit, function, len(data))) + data))
        come = b""
        answer: bytes | None = None
        while answer is None and (left := began + _TIMEOUT - self._clock.now()) > 0:
            come += self._wire.receive(left)
            answer = self._found(come, function, begins)
        self._free = max(self._clock.now() + self._gap, began + PACE)
        return answer

    def _can_turn(self, function: int) -> bool:
        """Return whether the next frame can start or accelerate the motor."""
        return function == _FREQUENCY or (function == _CONTROL and self._word != _HALT)

    def _found(self, come: bytes, function: int, begins: bytes) -> bytes | None:
        head = bytes((self._unit, function))
        for start in range(len(come) - 5):
            if come[start : start + 2] == head:
                frame = come[start : start + 5 + come[start + 2]]
                if len(frame) == 5 + come[start + 2] and whole(frame) and frame[3:].startswith(begins):
                    return frame[3:-2]
        return None


def _never_written(_parameter: int, _value: int) -> None:
    """Leave the parameter unchanged.

    It is unknown which parameters the inverter accepts during operation.
    """
