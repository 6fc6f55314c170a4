"""Simulated grblHAL controller, with buffers, real-time bytes, states, alarms, resets and status reports."""

from __future__ import annotations

import math
from dataclasses import dataclass

from core.ports import Clock
from drivers.simulators.grblhal_motion import GrblMotion, PlannedBlock
from drivers.simulators.grblhal_program import LineInterpreter, ModalState
from drivers.simulators.grblhal_settings import SettingRegisters, SimulatorBehavior
from drivers.simulators.plant_config import SimSpindle
from drivers.simulators.spindle_motor import SimulatedSpindle, SpindleMotor

# --- Effects of the real-time bytes in all states.


_OVERRIDE_STEPS = {0x91: 10, 0x92: -10, 0x93: 1, 0x94: -1}


def execute_realtime_byte(firmware: GrblFirmware, byte: int) -> None:
    """Immediately execute a real-time byte, which bypasses the receive buffer."""
    if byte == 0x18:
        firmware.reset()
    elif byte == 0x19:
        _stop_motion(firmware)
    elif firmware.is_waiting_for_index:
        return  # The firmware reads its flags after the wait; here they are discarded.
    elif byte in {0x80, 0x87}:
        firmware.send_text(firmware.report_generator.format_report(firmware, full=byte == 0x87) + "\r\n")
    elif byte == 0x83:
        firmware.send_text(firmware.program.format_modes() + "\r\n")
    elif byte == 0x82:
        firmware.is_in_hold = firmware.is_in_hold or not (
            firmware.alarm_number or firmware.is_jogging or firmware.behavior.hold_broken
        )
    elif byte == 0x81:
        _go_on(firmware)
    elif byte == 0x85:
        firmware.receive_buffer.clear()
        firmware.program.last_error = 0
        firmware.is_canceling_jog = firmware.is_jogging and bool(firmware.motion.block_queue)
    elif 0x90 <= byte <= 0x9E:
        _override(firmware, byte)


def _stop_motion(m: GrblFirmware) -> None:
    """Stop without deceleration, and clear most alarms.

    While a threading block waits for the spindle index, the controller restarts instead.
    """
    if m.is_reset_required:
        return
    if m.is_waiting_for_index:
        m.restart(False)
        return
    m.abrupt_stop_count += m.motion.is_moving
    m.stop_all_functions()
    m.receive_buffer.clear()
    m.program.modes = ModalState()
    if m.alarm_number not in {11, 12}:
        m.alarm_number = 0
        m.send_text("[MSG:Stop]\r\n")


def _go_on(m: GrblFirmware) -> None:
    if m.motion.is_moving or m.alarm_number or not (m.is_in_hold or m.is_door_open):
        return
    m.is_in_hold = m.is_door_open = False
    if m.is_spindle_paused and not int(m.registers[63]) & 2:
        m.programmed_rpm = 0.0
    m.is_spindle_paused = False
    m.command_spindle_speed(m.programmed_rpm)


def _override(m: GrblFirmware, byte: int) -> None:
    if m.behavior.stubborn:
        return
    m.report_generator.are_overrides_due = True
    if byte == 0x90:
        m.feed_percent = 100
    elif byte in _OVERRIDE_STEPS:
        m.feed_percent = min(max(m.feed_percent + _OVERRIDE_STEPS[byte], 10), 200)
    elif byte in {0x95, 0x96, 0x97}:
        m.rapid_percent = {0x95: 100, 0x96: 50, 0x97: 25}[byte]
    elif byte == 0x99:
        m.spindle_percent = 100
    elif byte - 9 in _OVERRIDE_STEPS:
        m.spindle_percent = min(max(m.spindle_percent + _OVERRIDE_STEPS[byte - 9], 10), 200)
    elif byte == 0x9E and m.is_in_hold and m.programmed_rpm:
        m.is_spindle_paused ^= not (m.behavior.toggle_broken or m.program.active_wait)
    m.command_spindle_speed(m.programmed_rpm)


# --- One step of the machine: homing, the wait for an index, motion and stops.


STEP_S = 0.001  # s
_INDEX_TIMEOUT_S = 5.0  # Seconds that a thread waits for the index.


def advance_firmware_step(firmware: GrblFirmware) -> None:
    """Advance the controller by one step of ``STEP_S`` seconds."""
    if firmware.homing_end_and_axes is not None:
        _home(firmware, *firmware.homing_end_and_axes)
        return
    if firmware.alarm_number:
        return
    slides = firmware.motion
    slides.feed_override, slides.rapid_override = (
        firmware.feed_percent / 100.0,
        firmware.rapid_percent / 100.0,
    )
    first = slides.block_queue[0] if slides.block_queue else None
    resting = (firmware.is_in_hold or firmware.is_door_open) and not slides.is_moving
    if first is not None and not resting and _waits_for_index(firmware, first):
        return
    needs_speed = first is not None and first.is_feed_per_revolution and not first.is_thread
    if needs_speed and abs(firmware.spindle.speed) < 1.0:
        firmware.raise_alarm(14)
        return
    slides.is_in_hold = firmware.is_in_hold or firmware.is_door_open or firmware.is_canceling_jog
    slides.advance(STEP_S, abs(firmware.spindle.speed) / 60.0)
    if firmware.is_canceling_jog and not slides.is_moving:
        firmware.is_canceling_jog = False
        slides.discard_blocks()
        firmware.program.end_position = slides.position
    if not slides.block_queue:
        firmware.is_jogging = False


def _home(m: GrblFirmware, until: float, axes: int) -> None:
    if m.time_s >= until:
        m.homing_end_and_axes, m.homed_axis_mask = None, m.homed_axis_mask | axes
        m.alarm_number = 11 if int(m.registers[22]) & 4 and m.homed_axis_mask & 5 != 5 else 0
        m.send_text("[MSG:]\r\n")
        m.acknowledge_line()


def _waits_for_index(m: GrblFirmware, block: PlannedBlock) -> bool:
    """Return whether a threading block still waits for the second spindle index after its start.

    The controller processes no bytes during this wait. If the index is missing for 5 s, alarm 14 is raised.
    """
    if not block.is_thread or m.motion.has_block_started:
        return False
    if m.index_wait_start_s is None:
        m.index_wait_start_s, m.index_target_rev = m.time_s, math.floor(abs(m.spindle.revolutions)) + 2
    if not m.behavior.index_missing and abs(m.spindle.revolutions) >= m.index_target_rev:
        m.index_wait_start_s = None
        return False
    if m.time_s - m.index_wait_start_s > _INDEX_TIMEOUT_S:
        m.raise_alarm(14)
    return True


# --- Status reports and their contents.


_OFFSETS_BUSY, _OFFSETS_IDLE = 30, 10  # Intervals in reports.
_OVERRIDES_BUSY, _OVERRIDES_IDLE = 20, 10
_BUSY_STATES = frozenset(("Run", "Hold", "Jog", "Home", "Door"))


@dataclass(slots=True)
class ReportGenerator:
    """Generator of status reports, which decides when a report includes offsets and overrides.

    Both are included at intervals and after a change. If both are due at the same time, the report includes
    the overrides, and the next report includes the offsets. A full report includes both. Firmware of 2023
    delays the overrides and never includes them in a full report.
    """

    reports_until_offsets: int = 0
    reports_until_overrides: int = 0
    are_offsets_due: bool = False
    are_overrides_due: bool = False
    are_accessories_due: bool = False

    def format_report(self, firmware: GrblFirmware, *, full: bool) -> str:
        """Return the text of one report without its line end."""
        busy = firmware.state_name.partition(":")[0] in _BUSY_STATES
        overrides = self._overrides(full, busy)
        offsets = self._offsets(full, overrides, busy)
        text = (
            f"<{firmware.format_state(full)}{_motion(firmware)}{_extras(firmware, offsets, overrides, full)}>"
        )
        self.are_accessories_due = False
        return text

    def _overrides(self, full: bool, busy: bool) -> bool:
        is_due = full or self.are_overrides_due or self.reports_until_overrides == 0
        self.reports_until_overrides = (
            (_OVERRIDES_BUSY if busy else _OVERRIDES_IDLE) - 1 if is_due else self.reports_until_overrides - 1
        )
        self.are_overrides_due = False
        return is_due

    def _offsets(self, full: bool, overrides: bool, busy: bool) -> bool:
        wanted = full or self.are_offsets_due or self.reports_until_offsets == 0
        self.reports_until_offsets = (
            (_OFFSETS_BUSY if busy else _OFFSETS_IDLE) - 1 if wanted else self.reports_until_offsets - 1
        )
        self.are_offsets_due = wanted and overrides and not full
        return wanted and not self.are_offsets_due


def _round_to_step(position: float, steps: float) -> float:
    """Round a position to a whole number of motor steps; ``steps`` is the number of steps per mm."""
    return round(position * steps) / steps


def _motion(m: GrblFirmware) -> str:
    scale = 2.0 if m.program.modes.radius == "G7" else 1.0
    x, z = (
        _round_to_step(place, m.registers[number])
        for place, number in zip(m.motion.position, (100, 102), strict=True)
    )
    text = f"|MPos:{x * scale:.3f},0.000,{z:.3f}|Bf:{m.motion.free_block_count},{m.free_receive_byte_count}"
    if m.motion.block_queue and m.motion.block_queue[0].line_number:
        text += f"|Ln:{m.motion.block_queue[0].line_number}"
    text += f"|FS:{60.0 * m.motion.speed:.0f},{abs(m.commanded_rpm):.0f}"
    if m.behavior.encoder:
        text += f",{abs(m.spindle.speed):.0f}"
    return text + (f"|Pn:{m.active_pins}" if m.active_pins else "")


def _extras(m: GrblFirmware, offsets: bool, overrides: bool, full: bool) -> str:
    text = "|WCO:" + ",".join(f"{value:.3f}" for value in m.program.work_offset) if offsets else ""
    text += "|WCS:G54" if full else ""
    text += f"|Ov:{m.feed_percent},{m.rapid_percent},{m.spindle_percent}" if overrides else ""
    accessories = "" if not m.commanded_rpm else "S" if m.commanded_rpm > 0.0 else "C"
    accessories += "F" * m.output_states.get("flood", False) + "M" * m.output_states.get("mist", False)
    has_accessories = full or m.report_generator.are_accessories_due or (overrides and accessories)
    text += f"|A:{accessories}" if has_accessories else ""
    if not full:
        return text
    mask = f",{m.homed_axis_mask}" if int(m.registers[22]) & 2 else ""
    homed = f"|H:{int(m.homed_axis_mask & 5 == 5)}{mask}"
    read = "" if m.last_input_result is None else f"|In:{m.last_input_result}"
    lathe = f"|D:{int(m.program.modes.radius == 'G7')}" if m.registers.is_in_lathe_mode else ""
    return f"{text}|Sc:|MPG:0{homed}{lathe}|T:0|P:0|TLR:0{read}|FW:grblHAL"


_STEP_S = 0.001  # s
_BUFFER_SIZE = 1023  # Bytes for lines; one of the 1024 stays free.
_CRITICAL_ALARMS = frozenset((1, 2, 10, 17))
_BANNER_TEXT = "\r\nGrblHAL 1.1f ['$' or '$HELP' for help]\r\n"
_MIN_FREE_BYTES = 100  # With this many free bytes or fewer, the simulator reads nothing from its socket.


class GrblFirmware:
    """Simulated grblHAL controller.

    The host's bytes enter through ``receive_bytes``, and ``pop_output`` returns the bytes for the host.
    ``send_buffer`` contains bytes for the host, and ``receive_buffer`` contains received bytes that are not
    interpreted yet.
    """

    def __init__(self, clock: Clock, behavior: SimulatorBehavior | None = None) -> None:
        self.clock = clock
        self.behavior = behavior or SimulatorBehavior()
        self.registers = SettingRegisters(self.behavior)
        self.motion = GrblMotion(self.registers, 100)
        self.spindle: SimulatedSpindle = SpindleMotor(SimSpindle())
        self.output_states: dict[str, bool] = {}
        self.active_pins = ""
        self.auxiliary_inputs: dict[int, bool] = {}
        self.last_input_result: int | None = None  # Result of the last M66.
        self.homed_axis_mask = 0  # One bit per axis.
        self.alarm_number = 11 if int(self.registers[22]) & 5 == 5 else 0
        self.is_reset_required = False  # After a critical alarm, only a reset is accepted.
        self.is_door_open = False
        self.lost_byte_count = 0  # Number of bytes lost because the buffer was full.
        self.abrupt_stop_count = 0  # Number of stops without deceleration.
        self.feed_percent, self.rapid_percent, self.spindle_percent = 100, 100, 100
        self.programmed_rpm = 0.0
        self.is_jogging = False
        self.is_in_hold = False
        self.is_spindle_paused = False  # The spindle is stopped during a feed hold.
        self.receive_buffer = bytearray()
        self.send_buffer = bytearray()
        self.time_s = clock.now()
        self.is_canceling_jog = False  # A jog is being canceled.
        self.index_wait_start_s: float | None = None
        self.index_target_rev = 0
        self.homing_end_and_axes: tuple[float, int] | None = None  # End time and axes.
        self.report_generator = ReportGenerator()
        self.program = LineInterpreter(self)
        self._wire = bytearray()  # Bytes not yet read from the socket.
        self._next_byte = 0.0

    # --- the wire -----------------------------------------------------------------------------------------

    def receive_bytes(self, data: bytes) -> None:
        """Receive bytes from the host.

        Real-time bytes take effect immediately. Other bytes are buffered.
        """
        self.advance()
        self._wire += data
        self._take_in()
        self.program.execute_lines()

    def pop_output(self) -> bytes:
        """Remove and return the buffered bytes for the host."""
        self.advance()
        data, self.send_buffer = bytes(self.send_buffer), bytearray()
        return b"" if self.behavior.sends_nothing else data

    def advance(self) -> None:
        """Advance the controller to the current time of the clock."""
        now, idle = self.clock.now(), self._is_idle
        while self.time_s + _STEP_S <= now + 1e-9:
            self.time_s += _STEP_S
            if idle:
                continue
            self.spindle.advance_to(self.time_s)
            advance_firmware_step(self)
            self._take_in()
            self.program.execute_lines()
        if idle:
            self.spindle.advance_to(self.time_s)

    def reset(self) -> None:
        """Perform the reset of byte 18h.

        The modes are lost, and the position is also lost if an axis is moving.
        """
        if "E" in self.active_pins:
            return
        moved = (
            self.motion.is_moving
            or self.homing_end_and_axes is not None
            or self.index_wait_start_s is not None
        )
        self.restart(moved)

    def cycle_power(self) -> None:
        """Switch the power off and on; the position is then 0, and the axes are no longer homed."""
        self.alarm_number, self.homed_axis_mask = 0, 0
        self.is_door_open = self.is_reset_required = False
        self.motion.position = (0.0, 0.0)
        self.restart(False)
        self.alarm_number = 11 if int(self.registers[22]) & 5 == 5 else 0

    # --- inside -------------------------------------------------------------------------------------------

    @property
    def _is_idle(self) -> bool:
        """Return whether nothing except the spindle can change before the host sends bytes."""
        busy = (
            self.motion.block_queue
            or self.homing_end_and_axes is not None
            or not self.program.is_previous_line_complete
        )
        return not (busy or self.receive_buffer or self._wire)

    def _take_in(self) -> None:
        while (
            self._wire
            and self.free_receive_byte_count > _MIN_FREE_BYTES
            and not (self.is_waiting_for_index and self.behavior.mute)
        ):
            if self.time_s < self._next_byte:
                return
            self._next_byte = self.time_s + self.behavior.drip if self.behavior.drip else 0.0
            byte = self._wire.pop(0)
            if byte >= 0x80 or byte in {0x18, 0x19}:
                execute_realtime_byte(self, byte)
            else:
                self.receive_buffer.append(byte)

    def restart(self, position_lost: bool) -> None:
        """Restart the controller; if ``position_lost`` is true, raise alarm 3."""
        self.abrupt_stop_count += self.motion.is_moving
        self.stop_all_functions()
        self.is_reset_required = False
        self.program.modes = ModalState()
        self.receive_buffer.clear()
        self.feed_percent = self.rapid_percent = self.spindle_percent = 100
        self.report_generator = ReportGenerator()
        if position_lost:
            self.alarm_number, self.homed_axis_mask = 3, 0
            self.send_text("ALARM:3\r\n")
        self.send_text(_BANNER_TEXT)
        if self.alarm_number:
            self.send_text("[MSG:'$H'|'$X' to unlock]\r\n")

    def stop_all_functions(self) -> None:
        """Stop motion, spindle, coolant and program immediately."""
        self.motion.discard_blocks()
        self.program.discard_lines()
        self.is_in_hold = self.is_canceling_jog = self.is_jogging = self.motion.is_in_hold = (
            self.is_spindle_paused
        ) = False
        self.index_wait_start_s = self.homing_end_and_axes = None
        self.command_spindle_speed(0.0)
        self.output_states.update(flood=False, mist=False)

    # --- state: alarms, holds, spindle and pending lines ------------------------------------------------

    @property
    def free_receive_byte_count(self) -> int:
        """Return the number of free bytes in the receive buffer."""
        return _BUFFER_SIZE - len(self.receive_buffer)

    @property
    def state_name(self) -> str:
        """Return the name of the state as in status reports."""
        if self.alarm_number:
            return f"Alarm:{self.alarm_number}"
        if self.homing_end_and_axes is not None:
            return "Home"
        if self.is_door_open:
            return "Door:2" if self.motion.is_moving else "Door:1"
        if self.is_in_hold:
            return f"Hold:{int(self.motion.is_moving)}"
        if self.motion.block_queue:
            return "Jog" if self.is_jogging else "Run"
        return "Idle"

    def format_state(self, full: bool) -> str:
        """Return the state in the format of status reports.

        An alarm includes its number in a full report, or if setting ``$10`` requires the number.
        """
        numbered = full or int(self.registers[10]) & 0x400
        return self.state_name if numbered else self.state_name.replace(f"Alarm:{self.alarm_number}", "Alarm")

    @property
    def is_waiting_for_index(self) -> bool:
        """Return whether a threading block is waiting for the spindle index."""
        return self.index_wait_start_s is not None

    @property
    def is_reading_lines(self) -> bool:
        """Return whether the controller currently reads lines."""
        held = (self.is_in_hold or self.is_door_open) and not self.alarm_number
        return not (self.is_waiting_for_index or self.homing_end_and_axes is not None or held)

    @property
    def commanded_rpm(self) -> float:
        """Return the commanded spindle speed in rpm, signed, with the override and the limits applied."""
        if not self.programmed_rpm or self.is_spindle_paused:
            return 0.0
        rpm = abs(self.programmed_rpm) * self.spindle_percent / 100.0
        return math.copysign(min(max(rpm, self.registers[31]), self.registers[30]), self.programmed_rpm)

    def raise_alarm(self, number: int) -> None:
        """Stop immediately and raise an alarm; the current block remains in the planner."""
        self.alarm_number = number
        self.abrupt_stop_count += self.motion.is_moving
        self.motion.speed = 0.0
        self.index_wait_start_s = None
        self.is_reset_required = number in _CRITICAL_ALARMS
        if self.is_reset_required:
            self.receive_buffer.clear()
        self.send_text(f"ALARM:{number}\r\n")

    def start_homing(self, axis_mask: int) -> None:
        """Start to home the axes in the bit mask ``axis_mask``; homing takes 0.5 s in the simulator."""
        self.homing_end_and_axes = self.time_s + 0.5, axis_mask

    def read_next_line(self) -> str | None:
        """Remove and return the next complete line of the buffer, or None if no line is complete."""
        if b"\n" not in self.receive_buffer:
            return None
        line, _, rest = bytes(self.receive_buffer).partition(b"\n")
        self.receive_buffer = bytearray(rest)
        return line.decode("ascii", "replace").strip()

    def queue_block(self, block: PlannedBlock) -> None:
        """Append a block to the planner; a block of zero length is ignored."""
        if block.length_mm > 0.0:
            self.motion.block_queue.append(block)
            self.is_jogging = block.is_jog

    def send_text(self, text: str) -> None:
        """Send text to the host."""
        self.send_buffer += text.encode("ascii")

    def acknowledge_line(self, error_code: int = 0) -> None:
        """Acknowledge a line with ``ok``, or with an error code if ``error_code`` is not 0."""
        if not error_code and self.behavior.garbled_replies:
            self.send_buffer += self.behavior.garbled_replies.pop(0) + b"\r\n"
        else:
            self.send_text(f"error:{error_code}\r\n" if error_code else "ok\r\n")

    def command_spindle_speed(self, rpm: float) -> None:
        """Command the spindle speed in rpm, signed."""
        self.report_generator.are_accessories_due = self.report_generator.are_accessories_due or (
            rpm > 0.0
        ) - (rpm < 0.0) != (self.programmed_rpm > 0.0) - (self.programmed_rpm < 0.0)
        self.programmed_rpm = rpm
        self.spindle.command_speed(self.time_s, self.commanded_rpm)
