"""Simulator of the HAL backend: TurnDesk's part of the HAL file and the real bridge on a simulated machine.

HAL's servo thread is simulated component by component from the same description that becomes the HAL file. A
wiring error in the file therefore appears in the simulator.
"""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

from core.ports import Clock, DriverError
from drivers.hal.bridge.hal_bridge import Bridge
from drivers.hal.bridge.packets import Head, unpack
from drivers.hal.hal_border import Border, border_of
from drivers.hal.hal_config import HalAxis, HalConfig
from drivers.hal.hal_session import bridge_config
from drivers.simulators.hal_components import Cells, Fifo, Program, sampler, streamer, watchdog
from drivers.simulators.plant import Plant
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_hands import PlantHands
from drivers.simulators.servo_axis import Servo

_ROUND, _REPORT = 2, 4  # Periods between two rounds of the bridge and between two reports.
_STATION = frozenset({"estop", "start", "hold", "spindle_auto"})
_HAIR = 1e-9
_PACKET_ERRORS = 5  # hm2_eth: packet-error-limit 10 divided by packet-error-increment 2.
_INDEX = 0.3  # Position of the spindle's index in revolutions.


class HalThread:
    """TurnDesk's part of the servo thread in its order; ``cells`` are indexed by signal or pin."""

    def __init__(self, border: Border) -> None:
        self.cells: Cells = {}
        self._cell: dict[str, str] = {pin: signal for signal, pins in border.nets.items() for pin in pins}
        self.theirs = {link.pin: link.ours[0] for link in border.links}  # Cells of the machine's pins.
        self.cells.update(dict.fromkeys([*border.nets, *self.theirs.values()], 0.0))
        self.streams = (Fifo(), Fifo())
        self.samples = Fifo()
        component = {name: kind for kind, names in border.modules.items() for name in names}
        values = dict(border.values)
        program = Program(self.cells)
        for call in border.calls:
            self._add(program, call, component, values)
        self.run = program.compiled()  # Runs one period of the thread; the argument is its length in s.

    def at(self, pin: str) -> str:
        """Return the cell of one of TurnDesk's pins."""
        cell = self._cell.get(pin, pin)
        self.cells.setdefault(cell, 0.0)
        return cell

    def _add(self, program: Program, call: str, component: dict[str, str], values: dict[str, float]) -> None:
        if call.startswith("streamer."):
            fifo = self.streams[int(call.removeprefix("streamer."))]
            program.add(streamer(self.cells, fifo, self.at(f"{call}.enable"), self._pins(call)))
        elif call == "sampler.0":
            program.add(sampler(self.cells, self.samples, self._pins(call)))
        elif call == "watchdog.process":
            input_, enable, out = (self.at(f"watchdog.{pin}") for pin in ("input-0", "enable-in", "ok-out"))
            program.add(watchdog(self.cells, input_, enable, out, values["watchdog.timeout-0"]))
        elif call in component:
            program.add_component(component[call], call, self.at, lambda pin: values.get(pin, 0.0))

    def _pins(self, call: str) -> list[str]:
        """Return the cells of the numbered pins of a streamer or sampler."""
        numbered = re.compile(rf"{re.escape(call)}\.pin\.(\d+)")
        found = {int(m[1]): cell for pin, cell in self._cell.items() if (m := numbered.fullmatch(pin))}
        return [found[n] for n in range(len(found))]


class ThreadPins:
    """Pins of the bridge's HAL component, mapped to the cells of the thread."""

    def __init__(self, thread: HalThread) -> None:
        self._cells = thread.cells
        self._at = cache(lambda name: thread.at(f"turndesk.{name}"))

    def __getitem__(self, name: str) -> float:
        return self._cells[self._at(name)]

    def __setitem__(self, name: str, value: float) -> None:
        self._cells[self._at(name)] = value


class _AxisCells(NamedTuple):
    """Axis with the cells of its pins; an empty name means that the pin does not exist."""

    name: str
    servo: Servo
    feedback: str
    fault: str
    home: str
    command: str
    enable: str


class HalPlant(Plant):
    """Simulated machine connected to the pins of the thread."""

    periods: Callable[[float], None]

    def advance(self) -> float:
        """Advance the model to the present time of the clock in periods, and return this time in seconds."""
        now = self.clock.now()
        with self.lock:
            self._break(now)
            while self._at + self.config.step <= now + _HAIR:
                self._at += self.config.step
                self.spindle.advance(max(self._at, self.spindle.t))
                self.periods(self._at)
        return now

    _at = 0.0

    def trip(self, fault: str) -> None:
        """Set the fault pin of the drive that is named before the colon."""
        self.faulty.add(fault.partition(":")[0])

    faulty: set[str]

    def press_estop(self) -> None:
        """Remove the power of the drives and the spindle, as the E-stop circuit does."""
        with self.touch:
            now = self.advance()
            self.panel.estop = True
            self.spindle.cut(now)


class HalFarEnd:
    """Simulated machine, servo thread and bridge on one clock, which implements ``BridgeLink``."""

    warnings: tuple[str, ...] = ()

    def __init__(self, config: HalConfig, sim: SimConfig, clock: Clock) -> None:
        self.config = config
        self.plant = HalPlant(sim, clock)
        self.plant.faulty = set()
        self.plant.periods = self._period
        self.machine = PlantHands(self.plant)
        self.thread = HalThread(border_of(config))
        self.killed = False  # The process of the bridge has ended.
        self.stopped = False  # The process of the bridge is suspended.
        self.stands = False  # The servo thread is stopped.
        self.cable_out = False  # The board is not reachable; its inputs retain their last values.
        self.errors = 0  # Consecutive periods without the board, like the packet errors of hm2_eth.
        self.garbled = False  # Sent data is not a valid packet.
        self.has_index = True  # Phase Z of the spindle encoder is wired.
        self._orients = False
        self._hands: object = None  # State of the controls when last read.
        self.late = 0  # Number of delayed reports.
        self._outbox: deque[bytes] = deque()
        self._count = 0
        self._rpm = 0.0
        self._turns = self._index_at = 0.0  # Encoder count, and count at the last index reset.
        self._axes = [self._wire(axis) for axis in config.driven]
        self._place = {axis.name: 0.0 for axis in config.driven}
        self.bridge = self._start()

    def _wire(self, axis: HalAxis) -> _AxisCells:
        servo, pins = self.plant.servos[self.plant.names.index(axis.name)], axis.pins
        assert pins is not None
        wired = (pins.feedback, pins.fault, pins.home, pins.command, pins.enable)
        return _AxisCells(axis.name, servo, *(self.thread.theirs[pin] if pin else "" for pin in wired))

    def _start(self) -> Bridge:
        pins = ThreadPins(self.thread)
        streams, samples = self.thread.streams, self.thread.samples
        bridge = Bridge(bridge_config(self.config), pins, streams, samples, lambda: self.plant._at)
        for name, output in self.config.outputs.items():
            if output.safe is None:
                pins[f"out.{name}"] = self.plant.terminals.outputs.get(name, False)
        return bridge

    # --- the link -----------------------------------------------------------------------------------------

    def open(self) -> HalFarEnd:
        """Restart the bridge if it has ended. Raises DriverError while the cable is disconnected."""
        if self.cable_out:
            raise DriverError("HAL does not load: hm2_eth: the board does not respond", "hal-setup")
        self.errors = 0
        if self.killed or self.bridge.gone:
            self.killed = False
            self.thread, self._hands = HalThread(border_of(self.config)), None
            self.bridge = self._start()
        self._outbox.clear()
        return self

    def send(self, data: bytes) -> None:
        """Send a packet to the bridge. Raises DriverError if its process has ended."""
        if self.killed:
            raise DriverError("the HAL bridge process has ended (broken pipe)", "hal-bridge")
        self.bridge.handle(*unpack(data))

    def receive(self) -> Iterator[tuple[Head, Sequence[float]]]:
        """Yield the packets that the bridge has sent. Raises DriverError if its process has ended."""
        self.plant.advance()
        if self.killed:
            raise DriverError("HAL bridge process has ended", "hal-bridge")
        while len(self._outbox) > self.late:
            data = self._outbox.popleft()
            yield unpack(data[3:] if self.garbled else data)

    down = True  # Takes no time in the simulator.

    def hang_up(self) -> None:
        """Stop the axes by their ramps and end the bridge."""
        self.bridge.handle({"do": "ramp-off"}, ())
        self.bridge.gone = True

    def close(self) -> None:
        """End the bridge."""
        self.bridge.gone = True

    # --- one period ---------------------------------------------------------------------------------------

    def _period(self, t: float) -> None:
        period = self.config.table.period
        if not self.stands:
            self._read_board(t)
            self.thread.run(period)
        if not self.cable_out:
            self._drive(t, period)
        else:
            self._coast(t, period)
        self._count += 1
        if self.killed or self.stopped:
            return
        if self._count % _ROUND == 0:
            self.bridge.round()
        if self._count % _REPORT == 0:
            self._outbox.append(self.bridge.report())

    def _read_board(self, t: float) -> None:
        """Simulate hm2_read, which skips reading without packets and reports an error after a few periods."""
        if not self.cable_out:
            self._read(t)
            return
        self.errors += 1
        if self.errors >= _PACKET_ERRORS:  # io_error: the driver stops reading until it is reloaded.
            self._set(self.config.table.link_fault, True)

    def _coast(self, t: float, period: float) -> None:
        """Simulate the watchdog of the board.

        The axes coast, the spindle stops, and the outputs change to their safe states.
        """
        for axis in self._axes:
            axis.servo.roll(period)
        if self._rpm:
            self._rpm = 0.0
            self.plant.spindle.order(t, 0.0)
        for name, output in self.config.outputs.items():
            if output.safe is not None and self.plant.terminals.outputs.get(name) is not output.safe:
                self.plant.terminals.write(name, output.safe, t)

    def _set(self, pin: str, value: float) -> None:
        if pin:
            self.thread.cells[self.thread.theirs[pin]] = value

    def _get(self, pin: str) -> float:
        return self.thread.cells[self.thread.theirs[pin]] if pin else 0.0

    def _read(self, t: float) -> None:
        """Copy the state of the machine to the cells that HAL reads."""
        plant, config, cells = self.plant, self.config, self.thread.cells
        for axis in self._axes:
            servo = axis.servo
            cells[axis.feedback] = servo.reading
            if axis.fault:
                cells[axis.fault] = axis.name in plant.faulty
            if axis.home:
                cells[axis.home] = servo.p <= servo.switch
        if config.spindle.pins.position:
            self._encode(plant.spindle.counted)
        self._set(config.spindle.pins.velocity, plant.spindle.speed / 60.0)
        self._read_hands(t)

    def _read_hands(self, t: float) -> None:
        """Read inputs and pots if they may have changed."""
        hands = self.plant.hands(t)
        if hands is self._hands:
            return
        self._hands = hands
        (state, inputs), config, cells, theirs = hands, self.config, self.thread.cells, self.thread.theirs
        for name, wired in config.inputs.items():
            on = getattr(state, name) if name in _STATION else inputs.get(name)
            cells[theirs[wired.pin]] = bool(on) is not wired.active_low
        for name, pot in config.pots.items():
            if name == "handwheel":
                self._set(pot.pin, state.handwheel)
            else:
                self._set(pot.pin, (getattr(state, name) - pot.low) / (pot.high - pot.low))

    def _encode(self, turns: float) -> None:
        """Simulate the spindle encoder, whose count restarts at the index on request."""
        pins, last = self.config.spindle.pins, self._turns
        self._turns = turns
        if pins.index_enable and self._get(pins.index_enable):
            passed = math.floor(turns - _INDEX), math.floor(last - _INDEX)
            if passed[0] != passed[1] and self.has_index:
                self._index_at = max(passed) + _INDEX
                self._set(pins.index_enable, False)
        self._set(pins.position, turns - self._index_at)

    def _drive(self, t: float, period: float) -> None:
        """Apply the cells that HAL writes to the machine; axes without power coast.

        If the thread is stopped, the boards remove the power.
        """
        plant, config, cells = self.plant, self.config, self.thread.cells
        powered = not self.stands and not plant.panel.estop
        for axis in self._axes:
            servo, goal, last = axis.servo, cells[axis.command], self._place[axis.name]
            self._place[axis.name] = goal
            if powered and cells[axis.enable]:
                servo.follow(goal, (goal - last) / period, period)
                if goal == last:
                    servo.settle(goal)
            else:
                servo.roll(period)
        rpm = 0.0 if self.stands else self._get(config.spindle.pins.speed)
        if rpm != self._rpm and not (rpm and plant.panel.estop):
            self._rpm = rpm
            plant.spindle.order(t, rpm)
        self._orient(t)
        for name, output in config.outputs.items():
            on = bool(self._get(output.pin)) and not (self.stands and output.safe is False)
            if plant.terminals.outputs.get(name) is not on:
                plant.terminals.write(name, on, t)

    def _orient(self, t: float) -> None:
        """Simulate the component ``orient`` and its drive.

        The angle is read at the rising edge of the pin.
        """
        pins, spindle = self.config.spindle.pins, self.plant.spindle
        wanted = bool(self._get(pins.orient)) and not self.stands
        if wanted and not self._orients:
            sense = {0: 0, 1: 1, 2: -1}[int(self._get(pins.orient_mode))]
            spindle.orient(t, self._get(pins.orient_angle), sense)
        elif self._orients and not wanted:
            spindle.release()
        self._orients = wanted
        self._set(pins.is_oriented, spindle.oriented)
