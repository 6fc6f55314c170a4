"""Simulator of the HAL backend, which runs the real bridge on a simulated machine.

The servo thread of HAL is simulated component by component, from the same description that generates the
HAL file. A wiring error in the file therefore has the same effect in the simulator.
"""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Callable, Iterator
from functools import cache
from typing import NamedTuple

from core.ports import Clock, DriverError
from drivers.hal.bridge.hal_bridge import HalBridge
from drivers.hal.hal_config import HalAxis, HalConfig
from drivers.hal.hal_section import HalSection, build_hal_section
from drivers.hal.hal_session import create_bridge_config
from drivers.process_messages import ReceivedMessage, decode_message
from drivers.simulators.hal_components import (
    RowFifo,
    SignalCells,
    ThreadProgram,
    create_sampler,
    create_streamer,
    watchdog,
)
from drivers.simulators.plant import SimulatedPlant
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_controls import PlantControls
from drivers.simulators.servo_axis import SimulatedServo

_ROUND, _REPORT = 2, 4  # Periods between two rounds of the bridge and between two reports.
_STATION_NAMES = frozenset({"estop", "start", "hold", "spindle_auto"})
_COMPARE_TOLERANCE = 1e-9
_PACKET_ERRORS = 5  # hm2_eth: packet-error-limit 10 divided by packet-error-increment 2.
_INDEX_REV = 0.3  # Position of the spindle's index in revolutions.


class ServoThread:
    """Servo thread with the functions of TurnDesk's section, in the order of the HAL file.

    The keys of ``cells`` are the names of signals or pins.
    """

    def __init__(self, hal_section: HalSection) -> None:
        self.cells: SignalCells = {}
        self._cell: dict[str, str] = {
            pin: signal for signal, pins in hal_section.pins_by_signal.items() for pin in pins
        }
        self.machine_cells = {
            link.pin_name: link.turndesk_signals[0] for link in hal_section.machine_links
        }  # Cells of the machine's pins.
        self.cells.update(dict.fromkeys([*hal_section.pins_by_signal, *self.machine_cells.values()], 0.0))
        self.setpoint_fifos = (RowFifo(), RowFifo())
        self.sample_fifo = RowFifo()
        component = {name: kind for kind, names in hal_section.module_instances.items() for name in names}
        values = dict(hal_section.pin_values)
        program = ThreadProgram(self.cells)
        for call in hal_section.function_calls:
            self._add(program, call, component, values)
        self.run_period = (
            program.compile_calls()
        )  # Runs one period of the thread; the argument is its length in s.

    def find_cell_name(self, pin: str) -> str:
        """Return the name of the cell for one of TurnDesk's pins.

        The cell is created if it does not exist.
        """
        cell = self._cell.get(pin, pin)
        self.cells.setdefault(cell, 0.0)
        return cell

    def _add(
        self, program: ThreadProgram, call: str, component: dict[str, str], values: dict[str, float]
    ) -> None:
        if call.startswith("streamer."):
            fifo = self.setpoint_fifos[int(call.removeprefix("streamer."))]
            program.add_call(
                create_streamer(
                    self.cells, fifo, self.find_cell_name(f"{call}.enable"), self._list_pins(call)
                )
            )
        elif call == "sampler.0":
            program.add_call(create_sampler(self.cells, self.sample_fifo, self._list_pins(call)))
        elif call == "watchdog.process":
            input_, enable, out = (
                self.find_cell_name(f"watchdog.{pin}") for pin in ("input-0", "enable-in", "ok-out")
            )
            program.add_call(watchdog(self.cells, input_, enable, out, values["watchdog.timeout-0"]))
        elif call in component:
            program.add_component(
                component[call], call, self.find_cell_name, lambda pin: values.get(pin, 0.0)
            )

    def _list_pins(self, call: str) -> list[str]:
        """Return the cells of the numbered pins of a streamer or sampler, in the order of their numbers."""
        numbered = re.compile(rf"{re.escape(call)}\.pin\.(\d+)")
        found = {int(m[1]): cell for pin, cell in self._cell.items() if (m := numbered.fullmatch(pin))}
        return [found[n] for n in range(len(found))]


class BridgePins:
    """Pins of the bridge's HAL component, mapped to the cells of the servo thread."""

    def __init__(self, thread: ServoThread) -> None:
        self._cells = thread.cells
        self._at = cache(lambda name: thread.find_cell_name(f"turndesk.{name}"))

    def __getitem__(self, name: str) -> float:
        return self._cells[self._at(name)]

    def __setitem__(self, name: str, value: float) -> None:
        self._cells[self._at(name)] = value


class _AxisCells(NamedTuple):
    """Names of the cells for the pins of one axis; an empty name means that the pin does not exist."""

    axis_name: str
    servo: SimulatedServo
    feedback_cell: str
    fault_cell: str
    home_cell: str
    command_cell: str
    enable_cell: str


class HalPlant(SimulatedPlant):
    """Simulated machine that is connected to the pins of the servo thread."""

    run_periods: Callable[[float], None]

    def advance(self) -> float:
        """Advance the model period by period to the current time of the clock.

        Returns this time in seconds.
        """
        now = self.clock.now()
        with self.lock:
            self._apply_faults(now)
            while self._at + self.config.model_step_s <= now + _COMPARE_TOLERANCE:
                self._at += self.config.model_step_s
                self.spindle.advance_to(max(self._at, self.spindle.time_s))
                self.run_periods(self._at)
        return now

    _at = 0.0

    def trip_drives(self, fault: str) -> None:
        """Set the fault pin of the drive that ``fault`` names before its colon."""
        self.faulty_axes.add(fault.partition(":")[0])

    faulty_axes: set[str]

    def press_estop(self) -> None:
        """Remove the power of the drives and the spindle, as the E-stop circuit does."""
        with self.action_lock:
            now = self.advance()
            self.station_panel.estop = True
            self.spindle.remove_power(now)


class HalSimulator:
    """Implementation of ``BridgeLink`` with a simulated machine, servo thread and bridge on one clock."""

    warnings: tuple[str, ...] = ()

    def __init__(self, config: HalConfig, sim: SimConfig, clock: Clock) -> None:
        self.config = config
        self.plant = HalPlant(sim, clock)
        self.plant.faulty_axes = set()
        self.plant.run_periods = self._period
        self.plant_controls = PlantControls(self.plant)
        self.servo_thread = ServoThread(build_hal_section(config))
        self.is_bridge_killed = False  # The process of the bridge has ended.
        self.is_bridge_suspended = False  # The process of the bridge is suspended.
        self.is_thread_stopped = False  # The servo thread is stopped.
        self.is_cable_disconnected = False  # The board is not reachable; its inputs retain their last values.
        self.board_error_count = (
            0  # Consecutive periods without the board, like the packet errors of hm2_eth.
        )
        self.has_invalid_packets = False  # Sent data is not a valid packet.
        self.has_encoder_index = True  # Phase Z of the spindle encoder is wired.
        self._orients = False
        self._hands: object = None  # State of the controls when last read.
        self.delayed_report_count = 0  # Number of delayed reports.
        self._outbox: deque[bytes] = deque()
        self._count = 0
        self._rpm = 0.0
        self._turns = self._index_at = 0.0  # Encoder count, and count at the last index reset.
        self._axes = [self._wire(axis) for axis in config.driven_axes]
        self._place = {axis.name: 0.0 for axis in config.driven_axes}
        self.bridge = self._start()

    def _wire(self, axis: HalAxis) -> _AxisCells:
        servo, pins = self.plant.servos[self.plant.axis_names.index(axis.name)], axis.pins
        assert pins is not None
        wired = (pins.feedback, pins.fault, pins.home, pins.command, pins.enable)
        return _AxisCells(
            axis.name, servo, *(self.servo_thread.machine_cells[pin] if pin else "" for pin in wired)
        )

    def _start(self) -> HalBridge:
        pins = BridgePins(self.servo_thread)
        streams, samples = self.servo_thread.setpoint_fifos, self.servo_thread.sample_fifo
        bridge = HalBridge(create_bridge_config(self.config), pins, streams, samples, lambda: self.plant._at)
        for name, output in self.config.outputs.items():
            if output.safe_state is None:
                pins[f"out.{name}"] = self.plant.terminals.output_states.get(name, False)
        return bridge

    # --- the link -----------------------------------------------------------------------------------------

    def restart_bridge(self) -> HalSimulator:
        """Restart the bridge if it has ended, and return this simulator.

        Raises DriverError while the cable is disconnected.
        """
        if self.is_cable_disconnected:
            raise DriverError("HAL does not load: hm2_eth: the board does not respond", "hal-setup")
        self.board_error_count = 0
        if self.is_bridge_killed or self.bridge.has_driver_ended:
            self.is_bridge_killed = False
            self.servo_thread, self._hands = ServoThread(build_hal_section(self.config)), None
            self.bridge = self._start()
        self._outbox.clear()
        return self

    def send_packet(self, data: bytes) -> None:
        """Send a packet to the bridge.

        Raises DriverError if the bridge process has ended.
        """
        if self.is_bridge_killed:
            raise DriverError("the HAL bridge process has ended (broken pipe)", "hal-bridge")
        self.bridge.queue_packet(*decode_message(data))

    def receive_packets(self) -> Iterator[ReceivedMessage]:
        """Yield the packets that the bridge has sent.

        Raises DriverError if the bridge process has ended.
        """
        self.plant.advance()
        if self.is_bridge_killed:
            raise DriverError("HAL bridge process has ended", "hal-bridge")
        while len(self._outbox) > self.delayed_report_count:
            data = self._outbox.popleft()
            yield decode_message(data[3:] if self.has_invalid_packets else data)

    has_shut_down = True  # Takes no time in the simulator.

    def stop_bridge(self) -> None:
        """Stop the axes with their ramps and end the bridge."""
        self.bridge.queue_packet({"do": "ramp-off"}, ())
        self.bridge.has_driver_ended = True

    def close(self) -> None:
        """End the bridge."""
        self.bridge.has_driver_ended = True

    # --- one period ---------------------------------------------------------------------------------------

    def _period(self, t: float) -> None:
        period = self.config.hal_table.period
        if not self.is_thread_stopped:
            self._read_board(t)
            self.servo_thread.run_period(period)
        if not self.is_cable_disconnected:
            self._drive_axes(t, period)
        else:
            self._coast(t, period)
        self._count += 1
        if self.is_bridge_killed or self.is_bridge_suspended:
            return
        if self._count % _ROUND == 0:
            self.bridge.run_cycle()
        if self._count % _REPORT == 0:
            self._outbox.append(self.bridge.encode_report())

    def _read_board(self, t: float) -> None:
        """Simulate the function hm2_read of the board.

        If no packets arrive, the function skips reading and reports an error after a few periods.
        """
        if not self.is_cable_disconnected:
            self._read_machine(t)
            return
        self.board_error_count += 1
        if (
            self.board_error_count >= _PACKET_ERRORS
        ):  # io_error: the driver stops reading until it is reloaded.
            self._set(self.config.hal_table.link_fault, True)

    def _coast(self, t: float, period: float) -> None:
        """Simulate the board's watchdog: axes coast, the spindle stops, outputs change to safe states."""
        for axis in self._axes:
            axis.servo.roll(period)
        if self._rpm:
            self._rpm = 0.0
            self.plant.spindle.command_speed(t, 0.0)
        for name, output in self.config.outputs.items():
            if (
                output.safe_state is not None
                and self.plant.terminals.output_states.get(name) is not output.safe_state
            ):
                self.plant.terminals.write(name, output.safe_state, t)

    def _set(self, pin: str, value: float) -> None:
        if pin:
            self.servo_thread.cells[self.servo_thread.machine_cells[pin]] = value

    def _get(self, pin: str) -> float:
        return self.servo_thread.cells[self.servo_thread.machine_cells[pin]] if pin else 0.0

    def _read_machine(self, t: float) -> None:
        """Copy the state of the machine to the cells that HAL reads."""
        plant, config, cells = self.plant, self.config, self.servo_thread.cells
        for axis in self._axes:
            servo = axis.servo
            cells[axis.feedback_cell] = servo.reading
            if axis.fault_cell:
                cells[axis.fault_cell] = axis.axis_name in plant.faulty_axes
            if axis.home_cell:
                cells[axis.home_cell] = servo.p <= servo.switch
        if config.spindle.pins.position:
            self._set_encoder(plant.spindle.counted_revolutions)
        self._set(config.spindle.pins.velocity, plant.spindle.speed / 60.0)
        self._read_station(t)

    def _read_station(self, t: float) -> None:
        """Copy the inputs and pots of the operator station to the cells if they may have changed."""
        hands = self.plant.read_station_and_inputs(t)
        if hands is self._hands:
            return
        self._hands = hands
        (state, inputs), config, cells, theirs = (
            hands,
            self.config,
            self.servo_thread.cells,
            self.servo_thread.machine_cells,
        )
        for name, wired in config.inputs.items():
            on = getattr(state, name) if name in _STATION_NAMES else inputs.get(name)
            cells[theirs[wired.pin_name]] = bool(on) is not wired.is_active_low
        for name, pot in config.pots.items():
            if name == "handwheel":
                self._set(pot.pin_name, state.handwheel)
            else:
                self._set(
                    pot.pin_name, (getattr(state, name) - pot.low_value) / (pot.high_value - pot.low_value)
                )

    def _set_encoder(self, turns: float) -> None:
        """Simulate the spindle encoder; its count resets at the index if the thread requests this."""
        pins, last = self.config.spindle.pins, self._turns
        self._turns = turns
        if pins.index_enable and self._get(pins.index_enable):
            passed = math.floor(turns - _INDEX_REV), math.floor(last - _INDEX_REV)
            if passed[0] != passed[1] and self.has_encoder_index:
                self._index_at = max(passed) + _INDEX_REV
                self._set(pins.index_enable, False)
        self._set(pins.position, turns - self._index_at)

    def _drive_axes(self, t: float, period: float) -> None:
        """Apply the values that HAL writes to the simulated machine; an axis without power coasts.

        If the servo thread is stopped, the boards remove the power.
        """
        plant, config, cells = self.plant, self.config, self.servo_thread.cells
        powered = not self.is_thread_stopped and not plant.station_panel.estop
        for axis in self._axes:
            servo, goal, last = axis.servo, cells[axis.command_cell], self._place[axis.axis_name]
            self._place[axis.axis_name] = goal
            if powered and cells[axis.enable_cell]:
                servo.follow_setpoint(goal, (goal - last) / period, period)
                if goal == last:
                    servo.settle_at_setpoint(goal)
            else:
                servo.roll(period)
        rpm = 0.0 if self.is_thread_stopped else self._get(config.spindle.pins.speed)
        if rpm != self._rpm and not (rpm and plant.station_panel.estop):
            self._rpm = rpm
            plant.spindle.command_speed(t, rpm)
        self._orient(t)
        for name, output in config.outputs.items():
            on = bool(self._get(output.pin_name)) and not (
                self.is_thread_stopped and output.safe_state is False
            )
            if plant.terminals.output_states.get(name) is not on:
                plant.terminals.write(name, on, t)

    def _orient(self, t: float) -> None:
        """Simulate the component ``orient`` and the spindle drive.

        The angle is read at the rising edge of the pin ``orient``.
        """
        pins, spindle = self.config.spindle.pins, self.plant.spindle
        wanted = bool(self._get(pins.orient)) and not self.is_thread_stopped
        if wanted and not self._orients:
            sense = {0: 0, 1: 1, 2: -1}[int(self._get(pins.orient_mode))]
            spindle.orient_spindle(t, self._get(pins.orient_angle), sense)
        elif self._orients and not wanted:
            spindle.cancel_orientation()
        self._orients = wanted
        self._set(pins.is_oriented, spindle.is_oriented)
