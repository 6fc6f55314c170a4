"""Huanyang HY inverters, which use their own frames with the CRC of Modbus.

The protocol follows LinuxCNC's hy_vfd and the register list published by Bouni. A frame consists of unit,
function, length, data and CRC. The functions are:

- 1 and 2: read and write a parameter PDnnn
- 3: control the inverter and return its state
- 4: read a value
- 5: set the frequency

A response names the requested parameter or value, so a response to an earlier request is detected.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator

from core.ports import Clock
from drivers.inverter.family_table import FamilyTable
from drivers.inverter.inverter_family import InverterState, write_and_check_parameters
from drivers.inverter.modbus_rtu import (
    REQUEST_INTERVAL_S,
    NoResponseError,
    RequestWithheldError,
    append_crc,
    has_valid_crc,
    report_no_pending_stop,
)
from drivers.serial_line import SerialTransport

_READ, _CONTROL, _VALUE, _FREQUENCY = 1, 3, 4, 5
_RUN, _RUN_BACK, _HALT = 0x01, 0x11, 0x08
_SETPOINT, _OUTPUT, _CURRENT = 0, 1, 2
_REPLY_TIMEOUT_S = 0.5  # s
_MAX_TRIES = 2


class HuanyangInverter:
    """A Huanyang HY inverter, which reports its state only in the response to a command.

    Each poll therefore repeats the current command.
    """

    required_response_count = 10

    def __init__(
        self, table: FamilyTable, wire: SerialTransport, clock: Clock, unit_address: int, character_s: float
    ) -> None:
        self._table = table
        self._wire, self._clock, self._unit = wire, clock, unit_address
        self._gap = max(3.5 * character_s, 0.00175)
        self._free = clock.now()
        self._word = _HALT
        self.is_stop_pending: Callable[[], bool] = report_no_pending_stop
        self._good = 0

    @property
    def valid_response_count(self) -> int:
        """Return the number of consecutive valid responses."""
        return self._good

    def check_parameters(self, comm_timeout_s: float, max_hz: float) -> list[str]:
        """Check the parameters, and return the messages for the operator.

        Parameters are never written. The inverter has no communication timeout.
        """
        return write_and_check_parameters(self._table, comm_timeout_s, max_hz, self._parameter, _reject_write)

    def stop_motor(self) -> None:
        """Stop the motor by the inverter's ramp, which requires PD026 = 0."""
        self._word = _HALT
        self._control()

    def command_frequency_hz(self, hz: float) -> None:
        """Send the frequency in Hz, and then the run command.

        A negative frequency runs the motor in reverse.
        """
        value = struct.pack(">H", round(abs(hz) * 100.0))
        self._send_request(_FREQUENCY, value, value)
        self._word = _RUN_BACK if hz < 0.0 else _RUN
        self._control()

    def iter_poll_steps(self) -> Iterator[InverterState | None]:
        """Poll the inverter request by request.

        The iterator yields None between requests and the state at the end. The bits of the state are: 0 run
        command, 2 reverse command, 3 running, 5 running in reverse.
        """
        state = self._control()
        yield None
        values: list[int] = []
        for index in (_SETPOINT, _OUTPUT, _CURRENT):
            values.append(self._value(index))
            yield None
        yield InverterState(
            output_hz=values[1] / 100.0,
            setpoint_hz=values[0] / 100.0,
            is_running=bool(state & 0x01),
            is_reverse_direction=bool(state & 0x20),
            is_reverse_commanded=bool(state & 0x04),
            current_a=values[2] / 10.0,
        )

    def reset_trip(self) -> None:
        """Send a stop, because a trip can be reset only at the keypad.

        Without a trip, the stop makes the inverter ready again.
        """
        self.stop_motor()

    def close(self) -> None:
        """Close the serial line of the inverter."""
        self._wire.close()

    def _control(self) -> int:
        return self._send_request(_CONTROL, bytes((self._word,)), b"")[0]

    def _value(self, index: int) -> int:
        head = bytes((index,))
        return int.from_bytes(self._send_request(_VALUE, head, head)[1:], "big")

    def _parameter(self, which: int) -> int:
        head = bytes((which,))
        return int.from_bytes(self._send_request(_READ, head + b"\0\0", head)[1:], "big")

    def _send_request(self, function: int, data: bytes, begins: bytes) -> bytes:
        """Send a request, and return the data of the response, which must begin with ``begins``.

        Raises NoResponseError without a valid response. Raises RequestWithheldError if the frame could
        start the motor and a stop is pending, and SerialLineError if the line has failed.
        """
        for left in reversed(range(_MAX_TRIES)):
            answer = self._once(function, data, begins)
            if answer is not None:
                self._good += 1
                return answer
            self._good = 0
            if not self.is_stop_pending():
                self._wire.receive(_REPLY_TIMEOUT_S)  # A late response must be discarded.
            if left and self.is_stop_pending() and function in (_READ, _VALUE):
                break
        raise NoResponseError(
            "the inverter does not respond; check the cable, PD163 (id), PD164 and PD165 (line settings)",
            reason="silent",
        )

    def _once(self, function: int, data: bytes, begins: bytes) -> bytes | None:
        self._clock.sleep_until(self._free)
        if self._can_start_motor(function) and self.is_stop_pending():
            raise RequestWithheldError
        self._wire.discard_input()
        began = self._clock.now()
        self._wire.send(append_crc(bytes((self._unit, function, len(data))) + data))
        come = b""
        answer: bytes | None = None
        while answer is None and (left := began + _REPLY_TIMEOUT_S - self._clock.now()) > 0:
            come += self._wire.receive(left)
            answer = self._found(come, function, begins)
        self._free = max(self._clock.now() + self._gap, began + REQUEST_INTERVAL_S)
        return answer

    def _can_start_motor(self, function: int) -> bool:
        """Return whether the next frame can start or accelerate the motor."""
        return function == _FREQUENCY or (function == _CONTROL and self._word != _HALT)

    def _found(self, come: bytes, function: int, begins: bytes) -> bytes | None:
        head = bytes((self._unit, function))
        for start in range(len(come) - 5):
            if come[start : start + 2] == head:
                frame = come[start : start + 5 + come[start + 2]]
                if (
                    len(frame) == 5 + come[start + 2]
                    and has_valid_crc(frame)
                    and frame[3:].startswith(begins)
                ):
                    return frame[3:-2]
        return None


def _reject_write(_parameter: int, _value: int) -> None:
    """Do not write the parameter; this function replaces the write function.

    It is unknown which parameters the inverter accepts during operation.
    """
