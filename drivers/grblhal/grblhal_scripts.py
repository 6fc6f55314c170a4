"""Scripts for tasks with several requests: connect, verify modes, stop, clear an alarm and home.

Each script is a generator, which ``GrblController.run_cycle`` advances. A script that fails raises
ScriptError.
"""

from __future__ import annotations

from collections.abc import Callable, Generator

from core.message import Message
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_config import ESTOP, HARDWARE
from drivers.grblhal.grblhal_controller import GrblController
from drivers.grblhal.grblhal_report import ControllerIdentity, parse_identity
from drivers.grblhal.grblhal_settings import (
    find_required_settings,
    format_setting,
    is_same_setting,
    parse_settings,
)
from drivers.grblhal.grblhal_transport import Script, ScriptError, ScriptStep, SentLine

# --- Parts of scripts: one line with its reply, a full report, the modes.


REPLY_TIMEOUT_S = 2.0  # Seconds for a line.
NO_REPORTS_TEXT = "the controller does not send status reports"
_TRIES = 3


def request_full_report(controller: GrblController, timeout_s: float = REPLY_TIMEOUT_S) -> Script:
    """Request a full status report and wait for it."""
    before = controller.full_report_count
    controller.request_report(full=True)
    yield lambda: controller.full_report_count > before, timeout_s, NO_REPORTS_TEXT


def synchronize_controller(controller: GrblController) -> Script:
    """Synchronize with the controller.

    The script clears a partial line and a stored error, and waits for the reply to ``$G``. After this
    reply, the driver assigns each reply to a line again.
    """
    # The controller reads these lines before ``$G``.
    slow = max(
        (controller.get_line_wait_s(ask.line_text) for ask in controller.line_sender.unacknowledged_lines),
        default=0.0,
    )
    for _ in range(_TRIES):
        controller.line_sender.discard_lines()
        controller.send_realtime_bytes(ord("\n"))
        ask, by = controller.send_line("$G"), controller.clock.now() + REPLY_TIMEOUT_S / _TRIES + slow
        yield _by(controller, ask, by), REPLY_TIMEOUT_S + slow, ""
        if ask.is_acknowledged:
            return
    raise ScriptError("no response from the controller to '$G'")


def _by(c: GrblController, ask: SentLine, by: float) -> Callable[[], bool]:
    return _ready_by(c, lambda: ask.is_acknowledged, by)


def _ready_by(c: GrblController, ready: Callable[[], bool], deadline_s: float) -> Callable[[], bool]:
    """Return a function that returns true when ``ready`` returns true or the deadline has passed."""
    return lambda: ready() or c.clock.now() >= deadline_s


def query_line(
    controller: GrblController, line: str, timeout_s: float = REPLY_TIMEOUT_S
) -> Generator[ScriptStep, None, list[str]]:
    """Send a line, wait for the reply ``ok``, and return the lines received before the ``ok``.

    Raises ScriptError if the controller rejects the line.
    """
    ask = controller.send_line(line)
    yield (
        lambda: ask.is_acknowledged,
        timeout_s + controller.get_line_wait_s(line),
        Message("no response from the controller to {line}", line=f"{line!r}"),
    )
    if ask.error_code:
        raise ScriptError(grblhal_codes.describe_line_error(ask.error_code, line))
    return ask.received_lines


def send_required_modes(controller: GrblController) -> Script:
    """Send the required modes, cancel modes that another host has left active, and verify the result."""
    yield from query_line(controller, "".join(grblhal_codes.REQUIRED_MODES))
    modes = yield from _read_modes(controller)
    cures = dict.fromkeys(
        grblhal_codes.MODE_RESETS[_mode_stem(word)]
        for word in modes
        if _mode_stem(word) in grblhal_codes.MODE_RESETS
    )
    for cure in cures:
        yield from query_line(controller, cure)
    modes = (yield from _read_modes(controller)) if cures else modes
    missing = [
        mode
        for mode in grblhal_codes.REQUIRED_MODES
        if mode not in modes and mode not in grblhal_codes.UNREPORTED_MODES
    ]
    kept = [word for word in modes if _mode_stem(word) in grblhal_codes.MODE_RESETS]
    if missing or kept:
        template = (
            "{wrong}; the controller reports [GC:{details}]; check that the controller is in lathe mode "
            "($32=2)"
            if "G8" in missing
            else "{wrong}; the controller reports [GC:{details}]"
        )
        wrong = (
            Message("the controller does not stay in mode {missing}", missing=" ".join(missing))
            if missing
            else Message("the controller stays in mode {saved}", saved=" ".join(kept))
        )
        raise ScriptError(template, wrong=wrong, details=" ".join(modes))


def _mode_stem(word: str) -> str:
    """Return the basic code of a word, for example G43 for ``G43.1`` or G51 for ``G51:X``."""
    return word.partition(":")[0].partition(".")[0]


def _read_modes(c: GrblController) -> Generator[ScriptStep, None, list[str]]:
    """Request the parser state and return all its words, including words that the driver does not use."""
    modes_text = " ".join(line for line in (yield from query_line(c, "$G")) if line.startswith("[GC:"))
    return modes_text.removeprefix("[GC:").rstrip("]").split()


def require_axes_and_estop(controller: GrblController, identity: ControllerIdentity) -> None:
    """Raise ScriptError if the controller lacks an axis of the machine file or the E-stop input."""
    missing = [axis.name for axis in controller.wired_axes if axis.name not in identity.axis_letters]
    if missing:
        raise ScriptError(
            "the controller has axes {axes}, but not {missing}",
            axes=identity.axis_letters,
            missing=", ".join(missing),
        )
    estop = controller.config.inputs.get(ESTOP)
    if estop is not None and not identity.has_input_pin(estop.terminal.removeprefix("pn.")):
        raise ScriptError(
            "the controller's board does not have the input {terminal} for the E-stop: it reports "
            "[SIGNALS:{signals}]. Use a board or firmware that has this input; if the E-stop only cuts "
            'the power, write io.in.estop = {{ at = "{hardware}" }}',
            "controller-estop",
            terminal=estop.terminal,
            signals=identity.control_input_letters,
            hardware=HARDWARE,
        )


# --- Stops that preserve the position.
# 0x18 and 0x19 do not brake. Both stop the step pulses at once, and only 0x18 reports by ALARM:3 that the
# position is lost. After 0x19, the line that is being planned enters the cleared planner and moves. Therefore
# a feed hold or a jog cancel is sent first, and 0x18 after the axes are at rest.


_STOP_DETECTION_S = 0.4  # Seconds in addition to the ramp until a stop is detected.
_BANNER = 3.0  # Duration of a reset in s.
_NO_RESET = "the controller does not respond after its reset; check that the E-stop is released"
_STALE_REPORT_S = 0.5  # Seconds in which reports from before a reset may still arrive.
_NO_REPORT_S = (
    0.4  # Seconds without a report in a thread, which then waits for its index and reacts only to a stop.
)
_INDEX = 7.0  # Longest duration of that wait in s.


def stop(controller: GrblController, *, in_thread_pass: bool = False) -> Script:
    """Brake the axes, and then reset the controller to clear its queue.

    The position is lost only if an axis does not come to rest. ``in_thread_pass`` means that a threading
    pass is active, which may be waiting at rest for the index. In this case, byte 18h would lose the
    position, so byte 19h is used, which then acts as a reset. An active alarm is not changed.
    """
    if controller.state_name != "Home":  # Only a reset ends the state Home.
        yield from _brake(controller)
    if controller.state_name == "Alarm":
        return
    if not (in_thread_pass and controller.clock.now() - controller.last_report_s > _NO_REPORT_S):
        yield from reset_controller(controller)
        return
    before, reports = controller.reset_count, controller.report_count
    controller.expect_driver_reset()
    controller.send_realtime_bytes(grblhal_codes.STOP)
    yield (
        lambda: controller.reset_count > before or controller.report_count > reports,
        _INDEX,
        NO_REPORTS_TEXT,
    )
    if controller.state_name != "Alarm" and controller.reset_count == before:
        yield from reset_controller(controller)


def reset_controller(controller: GrblController) -> Script:
    """Perform a soft reset and wait for the startup message of the controller.

    If reports arrive instead, the controller has ignored the reset and the script fails.
    """
    before, reports, began = controller.reset_count, controller.report_count, controller.clock.now()

    def has_newer_report() -> bool:
        return controller.report_count > reports and controller.last_report_s > began + _STALE_REPORT_S

    controller.expect_driver_reset()
    controller.send_realtime_bytes(grblhal_codes.RESET)
    yield lambda: controller.reset_count > before or has_newer_report(), _BANNER, _NO_RESET
    yield lambda: controller.reset_count > before, 0.0, _NO_RESET


def _brake(c: GrblController) -> Generator[ScriptStep, None, None]:
    """Brake, and wait until the axes are at rest, the stopping time is over or no report arrives."""
    after, began = c.report_count + 1, c.clock.now()  # One earlier report may still arrive.
    by = began + _stopping_time(c)
    c.send_realtime_bytes(grblhal_codes.JOG_CANCEL, grblhal_codes.HOLD)

    def is_at_rest() -> bool:
        return c.report_count > after and c.report is not None and not c.report.moves

    yield lambda: is_at_rest() or c.clock.now() >= by, _stopping_time(c) + 1.0, NO_REPORTS_TEXT


def _stopping_time(c: GrblController) -> float:
    """Return the seconds that the slowest axis needs to brake.

    If the controller has reported its settings, both the settings and the machine file are considered.
    """
    ramps = [axis.max_velocity / axis.max_acceleration for axis in c.wired_axes]
    for axis in c.wired_axes:
        speed, accel = c.get_max_axis_speed(axis.name), c.read_axis_setting(120, axis.name)
        if speed and accel:
            ramps.append(speed / accel)
    return _STOP_DETECTION_S + max(ramps)


# --- Settings: read, corrected according to the machine file, and read back.


_LISTED = 6.0  # Seconds for all settings, which are a few hundred lines.


def write_settings(controller: GrblController) -> Script:
    """Write the settings that differ from the required values, and read them back."""
    there = controller.settings = parse_settings((yield from query_line(controller, "$$", _LISTED)))
    wrong = {
        n: value
        for n, value in find_required_settings(controller, there).items()
        if not is_same_setting(there.get(n), value)
    }
    if not wrong:
        return
    for n, value in wrong.items():
        yield from query_line(controller, f"${n}={format_setting(value)}")
    there = controller.settings = parse_settings((yield from query_line(controller, "$$", _LISTED)))
    for n, value in wrong.items():
        if not is_same_setting(there.get(n), value):
            raise ScriptError(
                "${number}={written} was written, but the setting reads back as {number2}",
                number=n,
                written=format_setting(value),
                number2=there.get(n, "nothing"),
            )


_BOOT = 6.0  # Seconds; some boards restart when their port is opened.
_HOMING = 120.0
_COASTING, _LOOK = 8.0, 0.1  # Seconds for the spindle to stop, and between two checks.
_STANDSTILL_RPM = 5.0  # rpm
_MODES_TIMEOUT_S = 0.5  # Seconds for the modes by a real-time byte, which firmware before 2020 ignores.
_RESET_MODES = ("G8", "G18")  # Required modes that a reset would change.
_AT_ZERO = 0.002  # Mm; reports have three decimals.
_SINGLE_AXIS_BIT = 2  # Bit of $22: axes can be homed one at a time.


def connect_controller(controller: GrblController) -> Script:
    """Set up a controller after its connection is opened.

    An alarm remains active until the operator clears it.
    """
    yield from request_full_report(controller, _BOOT)
    yield from _set_up(controller)


def reconnect_controller(controller: GrblController) -> Script:
    """Set up a controller after a lost connection, and record the accessories that were still on."""
    unheard = controller.clock.now() - controller.last_report_s
    yield from request_full_report(controller, _BOOT)
    yield from detect_restart(controller)
    on = controller.reported_accessories[1] if controller.reported_accessories is not None else ""
    yield from _set_up(controller)
    controller.active_at_silence = (unheard, on) if on else None


def detect_restart(controller: GrblController) -> Script:
    """Detect whether the controller restarted while it was silent.

    After a restart, the active modes differ from those of TurnDesk, because ``gc_init`` of grblHAL selects
    G17. The position then counts from 0, so a position other than 0 proves that there was no restart.
    """
    by = controller.clock.now() + _MODES_TIMEOUT_S
    controller.request_parser_modes()
    yield _ready_by(controller, lambda: controller.reported_modes != "", by), REPLY_TIMEOUT_S, ""
    modes = controller.reported_modes.removeprefix("[GC:").rstrip("]").split()
    places = controller.report.position if controller.report is not None else None
    if all(mode in modes for mode in _RESET_MODES) or any(abs(place) > _AT_ZERO for place in places or ()):
        return
    controller.has_restarted = True
    controller.home_origin.clear()


def _set_up(c: GrblController) -> Script:
    if c.report is not None and c.report.state not in {"Idle", "Alarm"}:
        yield from stop(c)
    yield from synchronize_controller(c)
    identity = parse_identity((yield from query_line(c, "$I")))
    require_axes_and_estop(c, identity)
    c.identity = identity
    c.line_sender.set_buffer_size(c.identity.buffer_byte_count)
    number = _present_alarm(c)
    if number not in grblhal_codes.CRITICAL_ALARMS:
        yield from write_settings(c)
    yield from request_full_report(c)
    number = _present_alarm(c)
    if number:
        c.alarm_number = number
        c.is_position_reliable = c.is_position_reliable and number not in grblhal_codes.POSITION_LOST_ALARMS
        if number != grblhal_codes.HOMING_REQUIRED_ALARM:
            c.set_fault(grblhal_codes.describe_alarm(number), grblhal_codes.get_alarm_code(number))
        return
    yield from _switch_accessories_off(c)
    yield from verify_modes(c)


def _switch_accessories_off(c: GrblController) -> Script:
    """Switch spindle and coolant off, because they may still be on if the control was killed."""
    for code in grblhal_codes.OFF_CODES:
        yield from query_line(c, code)
    by = c.clock.now() + _COASTING
    while _is_spindle_turning(c) and c.clock.now() < by:
        yield _past(c, c.clock.now() + _LOOK), 2.0 * _LOOK, ""
        yield from request_full_report(c)


def _is_spindle_turning(c: GrblController) -> bool:
    """Return whether the encoder shows that the controller's own spindle is turning."""
    measured = c.report.measured if c.report is not None else None
    return c.config.has_own_spindle and (measured or 0.0) > _STANDSTILL_RPM


def _past(c: GrblController, t: float) -> Callable[[], bool]:
    return lambda: c.clock.now() >= t


def verify_modes(controller: GrblController) -> Script:
    """Send and verify the required modes, and clear active offsets.

    Raises ScriptError if X is not a radius or an offset remains. Also raises ScriptError if the controller
    rejects a line, or is in a state other than Idle or Jog.
    """
    yield from synchronize_controller(controller)
    yield from send_required_modes(controller)
    yield from request_full_report(controller)
    if any(abs(offset) > 1e-9 for offset in controller.work_offset):
        yield from query_line(
            controller, "G10L2P1" + "".join(f"{letter}0" for letter in controller.reported_axis_letters)
        )
        yield from query_line(controller, "G92.1")
        yield from query_line(controller, "G49")
        yield from request_full_report(controller)
    if any(abs(offset) > 1e-9 for offset in controller.work_offset):
        raise ScriptError(
            "the controller applies offsets {offset}, but TurnDesk sends blocks in machine coordinates",
            "controller-modes",
            offset=controller.work_offset,
        )
    if controller.is_diameter_mode:
        raise ScriptError("X is in diameter mode (D:1) although G8 is active", "controller-modes")
    if controller.report is None or controller.report.state not in {"Idle", "Jog"}:
        raise ScriptError(
            "the controller is in state {state}, not Idle",
            state=controller.report.state if controller.report else "unknown",
        )
    controller.is_ready = controller.fault == ""


def abort_and_verify_modes(controller: GrblController) -> Script:
    """Stop the motion, discard the queue and verify the modes.

    The position is preserved if this is possible.
    """
    waits = controller.waits_for_index
    controller.discard_pending_lines()
    if controller.alarm_number:
        yield from reset_controller(
            controller
        )  # An alarm stops only the axes; a reset stops spindle and coolant.
        return
    if _present_alarm(controller):
        return
    yield from stop(controller, in_thread_pass=waits)
    yield from request_full_report(controller)
    if not (_present_alarm(controller) or _is_door_open(controller)):
        yield from verify_modes(controller)


def recover_from_alarm(controller: GrblController) -> Script:
    """Reset, unlock and verify the controller after the operator has cleared an alarm.

    The planner is empty afterward.
    """
    controller.discard_pending_lines()
    unheard = controller.is_silent
    yield from request_full_report(controller)
    if unheard:
        yield from detect_restart(controller)
    if controller.report is not None and "E" in controller.report.pins:
        raise ScriptError(
            "E-stop is pressed at the controller: release it, then press Reset", "controller-estop"
        )
    if controller.report is not None and controller.report.moves:
        yield from stop(controller)
    yield from reset_controller(controller)
    yield from request_full_report(controller)
    if _is_door_open(controller):
        raise ScriptError(
            "{door}: close the door, then press Reset", "door", door=grblhal_codes.DOOR_OPEN_TEXT
        )
    number = _present_alarm(controller)
    if number == grblhal_codes.HOMING_REQUIRED_ALARM:
        return
    yield from synchronize_controller(controller)
    if number:
        yield from query_line(controller, "$X")
    yield from write_settings(controller)
    yield from verify_modes(controller)


def home_axis(controller: GrblController, axis_letter: str) -> Script:
    """Home one axis on its switch, or set the current position to the home position."""
    axis = next(axis for axis in controller.config.axes if axis.name == axis_letter)
    yield from synchronize_controller(controller)
    if axis.home_position_mm is not None:
        yield from request_full_report(controller)
        controller.home_origin[axis_letter] = (
            controller.position[axis_letter]
            + controller.home_origin.get(axis_letter, 0.0)
            - axis.home_position_mm
        )
    elif not (
        axis.has_absolute_encoder and not controller.homing_setting_bits
    ):  # Otherwise the operator confirms the position.
        yield from _look_for_switch(controller, axis_letter)
    yield from request_full_report(controller)
    # With "homing on startup required", the controller stays locked until all axes are homed.
    controller.alarm_number = _present_alarm(controller)
    if not controller.alarm_number:
        yield from verify_modes(controller)


def _look_for_switch(c: GrblController, letter: str) -> Script:
    c.home_origin.pop(letter, None)
    if not c.homing_setting_bits or c.homing_setting_bits & _SINGLE_AXIS_BIT:
        yield from query_line(c, f"$H{letter}", _HOMING)
    elif not c.is_axis_homed(letter):
        yield from query_line(
            c, "$H", _HOMING
        )  # All axes are homed together, so the next one is already homed.


def finish_canceled_jog(controller: GrblController) -> Script:
    """Wait until the axes are at rest after a canceled jog, and then verify the modes.

    The check is necessary because the controller discards lines when a jog is canceled.
    """
    began = controller.report_count
    yield (
        lambda: (
            controller.report_count > began + 1
            and controller.report is not None
            and not controller.report.moves
        ),
        REPLY_TIMEOUT_S,
        "the jog was canceled, but the axes do not stop",
    )
    yield from verify_modes(controller)


def _is_door_open(c: GrblController) -> bool:
    """Return whether the safety door is open; the controller then does not read lines."""
    return c.report is not None and c.report.state == "Door"


def _present_alarm(c: GrblController) -> int:
    """Return the alarm number in the last report, or 0 if no alarm is active."""
    if c.report is None or c.report.state != "Alarm":
        return 0
    return c.report.sub or c.alarm_number or grblhal_codes.LOCKED_ALARM
