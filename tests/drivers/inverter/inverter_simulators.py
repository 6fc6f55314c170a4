"""The other end of the line: inverters that turn the simulated spindle's motor, and obey or do not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from core.ports import Clock
from drivers.inverter.modbus_rtu import append_crc, has_valid_crc
from drivers.simulators.plant_config import SimSpindle
from drivers.simulators.spindle_motor import SpindleMotor

HZ_PER_RPM = 1 / 60


class RefusedByDeviceError(Exception):
    """A Modbus exception; its code."""


@dataclass
class Inverter:
    """Frequency, direction and run as understood; the motor follows. ``deaf`` no longer takes a stop."""

    clock: Clock
    motor: SpindleMotor = field(default_factory=lambda: SpindleMotor(SimSpindle()))
    hz: float = 0.0
    running: bool = False
    back: bool = False
    trip: int = 0
    deaf: bool = False
    backwards: bool = False  # its motor cable is on wrongly
    torque_off: bool = False
    resets: int = 0
    stops: int = 0
    heard: float = 0.0  # when the last frame has come; its own watch begins with the first
    patience: float = 0.0  # s without one after which it stops by itself; 0: never

    def obey(self, *, run: bool) -> None:
        """The command as a whole has changed."""
        self.stops += not run
        if self.deaf and not run:
            return
        self.running = run and not self.trip
        self._turn()

    def hold_off(self, *, on: bool) -> None:
        """Safe torque off; let go, it does again whatever it is commanded to."""
        self.torque_off = on
        if on:
            self.motor.remove_power(self.clock.now())
        else:
            self._turn()

    def _turn(self) -> None:
        rpm = self.hz / HZ_PER_RPM * (-1 if self.back else 1) if self.running else 0.0
        if not self.torque_off:
            self.motor.command_speed(self.clock.now(), -rpm if self.backwards else rpm)

    def trip_with(self, code: int) -> None:
        """It trips: the motor runs down."""
        self.trip, self.running = code, False
        self.motor.remove_power(self.clock.now())

    def restart(self) -> None:
        """Its supply has failed for a moment: it stands and waits for a command."""
        self.hz, self.running, self.back = 0.0, False, False
        self.motor.remove_power(self.clock.now())

    def listen(self) -> None:
        """A frame has come."""
        self.watch()
        self.heard = self.clock.now()

    def watch(self) -> None:
        """Its own watch over the line."""
        if self.patience and self.heard and self.running and self.clock.now() > self.heard + self.patience:
            self.running = False
            self.motor.command_speed(self.heard + self.patience, 0.0)

    @property
    def rpm(self) -> float:
        """What the motor really does."""
        self.watch()
        self.motor.advance_to(self.clock.now())
        return self.motor.speed

    @property
    def output(self) -> int:
        """Hundredths of a hertz."""
        self.motor.advance_to(self.clock.now())
        return round(abs(self.motor.speed) * HZ_PER_RPM * 100)

    @property
    def turns_back(self) -> bool:
        """By the motor."""
        return self.motor.speed < -0.5


class Registers(Protocol):
    """A Modbus device's memory."""

    inverter: Inverter

    def word(self, address: int) -> int: ...

    def set_word(self, address: int, value: int) -> None: ...

    def coil(self, _address: int) -> bool: ...

    def set_coil(self, _address: int, _on: bool) -> None: ...


class NoCoils:
    """A device of registers alone."""

    def coil(self, _address: int) -> bool:
        raise RefusedByDeviceError(1)

    def set_coil(self, _address: int, _on: bool) -> None:
        raise RefusedByDeviceError(1)


class DeltaMemory(NoCoils):
    """Registers of a VFD-B."""

    def __init__(self, inverter: Inverter) -> None:
        self.inverter = inverter
        self.settings = {0x0100: 6000, 0x0200: 5, 0x0201: 3, 0x0902: 3, 0x0903: 0}
        self.written: list[tuple[int, int]] = []

    def word(self, address: int) -> int:
        inverter = self.inverter
        turning = {(False, False): 0, (True, False): 1, (False, True): 2, (True, True): 3}
        direction = turning[inverter.turns_back and inverter.output > 0, inverter.back]
        if not inverter.output:
            direction = 3 if inverter.back else 0
        state = 3 if inverter.running else 1 if inverter.output else 0
        shown: Mapping[int, int] = {
            0x2100: inverter.trip,
            0x2101: state | direction << 3,
            0x2102: round(inverter.hz * 100),
            0x2103: inverter.output,
            0x2104: 31,
            **self.settings,
        }
        if address not in shown:
            raise RefusedByDeviceError(2)
        return shown[address]

    def set_word(self, address: int, value: int) -> None:
        inverter = self.inverter
        self.written.append((address, value))
        if address in self.settings:
            self.settings[address] = value
            inverter.patience = self.settings.get(0x0903, 0) / 10 if self.settings[0x0902] == 1 else 0.0
        elif address == 0x2001:
            inverter.hz = value / 100
            if inverter.running:
                inverter.obey(run=True)
        elif address == 0x2000 and value == 0x2000:
            inverter.resets, inverter.trip = inverter.resets + 1, 0
        elif address == 0x2000:
            inverter.back = bool(value & 0x20) if value & 0x30 else inverter.back
            inverter.obey(run=value & 3 == 2)
        else:
            raise RefusedByDeviceError(2)


class HitachiMemory:
    """Coils and registers of a WJ200, by their addresses on the line."""

    def __init__(self, inverter: Inverter) -> None:
        self.inverter = inverter
        self.settings = {0x1200: 3, 0x1201: 3, 0x1203: 600, 0x113C: 2, 0x113D: 0, 0x0011: 0}
        self.coils = {0: False, 1: False, 2: False, 3: False}

    def word(self, address: int) -> int:
        inverter = self.inverter
        shown = {0: 0, 1: round(inverter.hz * 100), 0x1000: 0, 0x1001: inverter.output, 0x1002: 310}
        shown |= self.settings | {0x0011: inverter.trip}
        if address not in shown:
            raise RefusedByDeviceError(2)
        return shown[address]

    def set_word(self, address: int, value: int) -> None:
        if address in self.settings:
            self.settings[address] = value
            self.inverter.patience = self.settings[0x113D] / 100 if self.settings[0x113C] == 4 else 0.0
        elif address == 1:
            self.inverter.hz = value / 100
            if self.inverter.running:
                self.inverter.obey(run=True)
        elif address != 0:
            raise RefusedByDeviceError(2)

    def coil(self, _address: int) -> bool:
        address, inverter = _address, self.inverter
        state = {
            0x0E: inverter.output > 0,
            0x0F: inverter.turns_back,
            0x10: True,
            0x13: True,  # at speed: true in the wrong direction too
            0x17: bool(inverter.trip),
        }
        return state.get(address, False) if address >= 0x0E else self.coils.get(address, False)

    def set_coil(self, _address: int, _on: bool) -> None:
        address, on, inverter = _address, _on, self.inverter
        self.coils[address] = on
        if address == 1:
            inverter.back = on
        if address == 3:
            inverter.resets, inverter.trip, self.coils[3] = inverter.resets + 1, 0, False
        if address in (0, 1):
            inverter.obey(run=self.coils[0])


class MyDriveMemory(NoCoils):
    """Registers of an invented inverter, whose commands can be read back."""

    def __init__(self, inverter: Inverter) -> None:
        self.inverter = inverter
        self.settings = {0x0180: 2, 0x0181: 2, 0x0303: 600, 0x0428: 0, 0x0435: 15}
        self.command = 0
        self._watch()

    def word(self, address: int) -> int:
        inverter = self.inverter
        during_run = inverter.running or inverter.output > 0
        status = (during_run << 0) + (inverter.turns_back << 1) + (1 << 2) + (bool(inverter.trip) << 3)
        shown: Mapping[int, int] = {
            0x0001: self.command if inverter.hz else 0,  # none after a restart
            0x0020: status,
            0x0021: 0,
            0x0022: 0,
            0x0023: round(inverter.hz * 100),
            0x0024: inverter.output,
            0x0025: 2300,
            0x0026: 31,
            0x0080: inverter.trip,
            **self.settings,
        }
        if address not in shown:
            raise RefusedByDeviceError(2)
        return shown[address]

    def set_word(self, address: int, value: int) -> None:
        inverter = self.inverter
        if address in self.settings:
            self.settings[address] = value
            self._watch()
        elif address == 0x0002:
            inverter.hz = value / 100
            if inverter.running:
                inverter.obey(run=True)
        elif address == 0x0001:
            self.command = value
            inverter.back = bool(value & 2) if value & 3 else inverter.back
            if value & 8 and inverter.trip:
                inverter.resets, inverter.trip = inverter.resets + 1, 0
            inverter.obey(run=bool(value & 3))
        else:
            raise RefusedByDeviceError(2)

    def _watch(self) -> None:
        self.inverter.patience = self.settings[0x0435] / 10 if self.settings[0x0428] == 0 else 0.0


Memory = DeltaMemory | HitachiMemory | MyDriveMemory


class RtuSlave:
    """Answers frames of Modbus RTU out of a memory; written apart from the master's code."""

    functions = frozenset((1, 2, 3, 4, 5, 6, 8, 15, 16))

    def __init__(self, memory: Registers, unit: int = 1) -> None:
        self.memory, self.unit = memory, unit

    def answer(self, frame: bytes) -> bytes:
        """The frame that comes back; nothing for noise and for others."""
        if not has_valid_crc(frame) or frame[0] != self.unit:
            return b""
        self.memory.inverter.listen()
        try:
            body = self._body(frame[1], frame[2:-2])
        except RefusedByDeviceError as refused:
            body = bytes((frame[1] | 0x80, int(str(refused))))
        return append_crc(bytes((self.unit,)) + body)

    def _body(self, function: int, data: bytes) -> bytes:
        if function not in self.functions:
            raise RefusedByDeviceError(1)
        memory, first, second = self.memory, int.from_bytes(data[:2], "big"), int.from_bytes(data[2:4], "big")
        if function in (3, 4):
            words = [memory.word(first + n).to_bytes(2, "big") for n in range(second)]
            return bytes((function, 2 * second)) + b"".join(words)
        if function in (1, 2):
            bits = sum(1 << n for n in range(second) if memory.coil(first + n))
            size = (second + 7) // 8
            return bytes((function, size)) + bits.to_bytes(size, "little")
        if function == 5:
            memory.set_coil(first, second == 0xFF00)
        elif function == 6:
            memory.set_word(first, second)
        elif function == 16:
            for n in range(second):
                memory.set_word(first + n, int.from_bytes(data[5 + 2 * n : 7 + 2 * n], "big"))
        elif function == 15:
            for n in range(second):
                memory.set_coil(first + n, bool(data[5 + n // 8] >> n % 8 & 1))
        return bytes((function,)) + data[:4]


class MyDriveSlave(RtuSlave):
    """Three functions, and sixteen registers at most."""

    functions = frozenset((3, 8, 16))

    def _body(self, function: int, data: bytes) -> bytes:
        if function != 8 and int.from_bytes(data[2:4], "big") > 16:
            raise RefusedByDeviceError(3)
        return super()._body(function, data)


class HuanyangSlave:
    """A scripted Huanyang: its own functions."""

    def __init__(self, inverter: Inverter, unit: int = 1) -> None:
        self.inverter, self.unit = inverter, unit
        self.parameters = {1: 2, 2: 2, 5: 40000 // 100 * 15, 4: 5000, 11: 0}

    def answer(self, frame: bytes) -> bytes:
        """The frame that comes back."""
        if not has_valid_crc(frame) or frame[0] != self.unit or frame[2] != len(frame) - 5:
            return b""
        data = self._data(frame[1], frame[3:-2])
        return append_crc(bytes((self.unit, frame[1], len(data))) + data) if data else b""

    def _data(self, function: int, data: bytes) -> bytes:
        inverter = self.inverter
        if function == 1:
            value = self.parameters.get(data[0], 0)
            return data[:1] + (value.to_bytes(2, "big") if value > 255 else bytes((value,)))
        if function == 3:
            before = inverter.running, inverter.back
            inverter.back = bool(data[0] & 0x10) if data[0] & 1 else inverter.back
            if before != (bool(data[0] & 1), inverter.back) or data[0] & 8:
                inverter.obey(run=bool(data[0] & 1))
            run = inverter.running
            turning = inverter.output > 0
            return bytes(
                (run | (inverter.back << 2) | turning << 3 | (turning and inverter.turns_back) << 5,)
            )
        if function == 4:
            values = {0: round(inverter.hz * 100), 1: inverter.output, 2: 31}
            return data[:1] + values[data[0]].to_bytes(2, "big")
        if function == 5:
            inverter.hz = int.from_bytes(data, "big") / 100
            if inverter.running:
                inverter.obey(run=True)
            return data
        return b""
