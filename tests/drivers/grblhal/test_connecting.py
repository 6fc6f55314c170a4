"""What another host, a power-up or an alarm has left behind: mended, waited for or told."""

from __future__ import annotations

import socket
import threading

import pytest

from app.compose.backends.grblhal_backend import create_grblhal_config
from core.block_ports import LineOperation
from core.executor.commands import EnableDrives, Reset
from core.executor.snapshot import MachineState
from core.ports import DriverError
from drivers.grblhal.grblhal_machine import GrblMachine
from drivers.grblhal.grblhal_transport import GrblTcpTransport
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.grblhal.bench import GrblBench, LoopWire, grbl_machine, quirky


def connect(firmware: GrblFirmware, clock: ManualClock, *changes: tuple[str, str]) -> GrblMachine:
    return GrblMachine(create_grblhal_config(grbl_machine(*changes)), clock, LoopWire(firmware))


def left_behind(data: bytes, **quirks: object) -> tuple[GrblFirmware, ManualClock]:
    """A controller that another host has spoken to."""
    clock = ManualClock()
    firmware = GrblFirmware(clock, quirky(**quirks))
    firmware.receive_bytes(data)
    clock.advance(0.2)
    firmware.advance()
    firmware.pop_output()
    return firmware, clock


def test_modes_left_by_another_host_are_reset() -> None:
    firmware, clock = left_behind(b"G7G17G20G91G95\nG96S100\nG51\nM53P0\n")
    assert firmware.program.modes.speed == "G96"
    connect(firmware, clock)
    modes = firmware.program.modes
    assert (modes.radius, modes.plane, modes.units, modes.distance) == ("G8", "G18", "G21", "G90")
    assert (modes.feed_mode, modes.speed, modes.scaling, modes.is_hold_disabled) == (
        "G94",
        "G97",
        "G50",
        False,
    )


def test_offsets_left_by_another_host_are_cleared() -> None:
    firmware, clock = left_behind(b"G8G18G21G90\nG10L2P1X5Y0Z-3\n")
    made = connect(firmware, clock)
    assert firmware.program.work_offset == [0.0, 0.0, 0.0]
    made.axes.enable(True)
    made.block_controller.submit_block(LineOperation(1.0, 2.0, 40.0))
    for _ in range(100):
        clock.advance(0.01)
        made.run_cycle()
    assert firmware.motion.position == (1.0, 2.0)


def test_outputs_left_on_by_a_killed_control_are_switched_off() -> None:
    firmware, clock = left_behind(b"G8G18G21G90G97\nM3S800\nM8\n")
    assert firmware.programmed_rpm == 800.0
    connect(firmware, clock)
    assert firmware.programmed_rpm == 0.0
    assert not firmware.output_states["flood"]


def test_partial_line_left_by_another_host_is_discarded() -> None:
    firmware, clock = left_behind(b"G1X5")
    made = connect(firmware, clock)
    assert made.controller.fault == ""
    assert firmware.motion.position == (0.0, 0.0)


def test_program_of_another_host_is_braked_and_discarded() -> None:
    firmware, clock = left_behind(b"G8G18G21G90G94\nG1X80F600\n")
    assert firmware.motion.is_moving
    connect(firmware, clock)
    assert firmware.abrupt_stop_count == 0
    assert not firmware.motion.block_queue
    assert firmware.motion.position[0] < 10.0


def test_firmware_built_for_lathes_connects_without_a_lathe_setting() -> None:
    firmware, clock = left_behind(b"", built_for_lathes=True)
    assert connect(firmware, clock).controller.fault == ""


def test_settings_are_written_after_reset_of_a_critical_alarm() -> None:
    clock = ManualClock()
    firmware = GrblFirmware(clock, quirky(settings={13: 1.0}))
    firmware.raise_alarm(17)
    made = connect(firmware, clock)
    assert "ALARM:17" in made.controller.fault
    assert firmware.registers[13] == 1.0
    made.axes.clear_fault()
    for _ in range(200):
        clock.advance(0.01)
        made.run_cycle()
    assert made.controller.fault == ""
    assert firmware.alarm_number == 0
    assert firmware.registers[13] == 0.0
    assert made.block_controller.state().start_refusal_reason == ""


@pytest.mark.parametrize("at", [0.41, 0.42, 0.43, 0.44, 0.5])
def test_alarm_without_a_number_is_reported(at: float) -> None:
    """Its number is a matter of $10 while it is told plainly; it may come while an input is asked for."""
    bench = GrblBench()
    bench.ready()
    bench.run(at)
    bench.peer.alarm_number = 14
    bench.until(MachineState.FAULT, limit=1.0)
    assert "ALARM" in bench.alarms()


def test_open_door_is_reported_and_cleared_by_reset() -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nX1\nM30\n")
    bench.until_true(lambda _: bench.peer.motion.is_moving)
    bench.peer.is_door_open = True
    bench.until(MachineState.FAULT, limit=2.0)
    assert "safety door" in bench.alarms()
    bench.run(1.5)
    bench.post(Reset())
    bench.run(1.0)
    assert bench.state is MachineState.FAULT  # it still stands open
    bench.peer.is_door_open = False
    bench.run(0.5)
    bench.post(Reset())
    bench.run(1.5)
    bench.post(EnableDrives())
    bench.until(MachineState.IDLE, limit=2.0)
    assert bench.peer.abrupt_stop_count == 0
    assert not bench.peer.motion.block_queue


def test_unknown_fields_of_reports_and_messages_are_ignored() -> None:
    bench = GrblBench()
    bench.ready()
    bench.run(0.5)
    bench.peer.send_text("[MSG:Info: something new]\r\n\r\n[NEW:1,2]\r\n$N0=\r\n>G8:ok\r\n")
    bench.peer.send_text("<Idle|MPos:0.000,0.000,0.000|Bf:100,1023|FS:0,0,0|New:x,y|SD:1|MPG:0|TCP>\r\n")
    bench.run(0.5)
    assert bench.state is MachineState.IDLE
    assert not bench.shot.alarms


def test_reports_with_three_or_more_axes_are_read_by_axis_letter() -> None:
    firmware, clock = left_behind(b"")
    made = connect(firmware, clock)
    firmware.motion.position = (1.25, -2.5)
    for _ in range(50):
        clock.advance(0.01)
        made.run_cycle()
    assert made.controller.position == {"X": 1.25, "Y": 0.0, "Z": -2.5}


@pytest.mark.parametrize("rests", [b"", b"<Idle|MPos:0.000,0.000,0.000>\r\n" * 200])
def test_closing_waits_until_the_other_end_has_sent_everything(rests: bytes) -> None:
    """The simulator ends when it writes to a connection that is gone."""
    listener = socket.create_server(("127.0.0.1", 0))
    broken: list[OSError] = []

    def answer() -> None:
        other, _ = listener.accept()
        try:
            while other.recv(4096):
                continue
            other.sendall(rests)
        except OSError as error:
            broken.append(error)
        other.close()

    end = threading.Thread(target=answer)
    end.start()
    wire = GrblTcpTransport(*listener.getsockname()[:2])
    wire.write(b"\x80")
    wire.close()
    end.join(60.0)
    listener.close()
    assert not end.is_alive()
    assert not broken


def test_controller_in_diameter_mode_is_switched_to_radius_mode() -> None:
    bench = GrblBench(quirks=quirky(diameter=True))
    assert bench.peer.program.modes.radius == "G8"
    assert bench.machine.controller.is_diameter_mode is False


def test_controller_without_lathe_mode_is_rejected() -> None:
    with raises_code(DriverError, "driver", "G8", "error:20"):
        GrblBench(grbl_machine(("{ 13 = 0, 32 = 2 }", "{ 13 = 0 }")), quirky(lathe=False))


def test_estop_input_that_the_board_does_not_have_is_rejected() -> None:
    """The firmware's own simulator tells [SIGNALS:D]: a pin that is never reported is no E-stop."""
    with raises_code(DriverError, "driver", "pn.E", "[SIGNALS:D]"):
        GrblBench(quirks=quirky(signals="D"))


def test_missing_estop_input_is_rejected_during_an_alarm_too() -> None:
    """Else the Reset of the alarm would go by."""
    firmware, clock = left_behind(b"")
    firmware.behavior.signals = "D"
    firmware.raise_alarm(17)
    with raises_code(DriverError, "driver", "pn.E", "[SIGNALS:D]"):
        connect(firmware, clock)


def test_hardware_only_estop_is_reported_and_machine_runs() -> None:
    bench = GrblBench(
        grbl_machine(('estop = { at = "pn.E" }', 'estop = { at = "hardware" }')), quirky(signals="D")
    )
    told = "\n".join(bench.machine.ports.warnings)
    assert "E-stop" in told
    assert "start (pn.S), hold (pn.H)" in told
    bench.start("G90G94F100\nX.1\nM30\n")
    bench.until(MachineState.IDLE)
    assert bench.shot.parts == 1


def test_firmware_that_does_not_list_its_signals_is_accepted() -> None:
    bench = GrblBench(quirks=quirky(signals=None))
    assert not [told for told in bench.machine.ports.warnings if "pn.E" in told]


def test_settings_are_written_once_and_read_back() -> None:
    bench = GrblBench(grbl_machine(("{ 13 = 0, 32 = 2 }", "{ 13 = 0, 32 = 2, 110 = 7620 }")))
    assert bench.peer.registers[110] == 7620.0


class TellsWire(LoopWire):
    """A controller that tells one thing otherwise."""

    def __init__(self, firmware: GrblFirmware, old: bytes, new: bytes) -> None:
        super().__init__(firmware)
        self._old, self._new = old, new

    def read(self) -> bytes:
        return super().read().replace(self._old, self._new)


@pytest.mark.parametrize(
    ("old", "new", "values"),
    [
        (b"[AXS:3:XYZ]", b"[AXS:2:XY]", ("XY", "Z")),
        (b" G8 ", b" G7 ", (" G8;", "[GC:", "$32=2")),
        (b" G18 ", b" G17 ", (" G18;", "[GC:")),
        (b" G50 ", b" G51:X ", (" G51:X;", "[GC:")),
        (b"WCO:0.000", b"WCO:5.000", ("(5.0, 0.0, 0.0)",)),
        (b"|D:0", b"|D:1", ("X ", "D:1", "G8")),
        (b"<Idle|", b"<Check|", ("Check", "Idle")),
    ],
)
def test_controller_that_cannot_be_set_up_is_rejected_with_the_cause(
    old: bytes, new: bytes, values: tuple[str, ...]
) -> None:
    clock = ManualClock()
    firmware = GrblFirmware(clock, quirky())
    with raises_code(DriverError, "driver", *values):
        GrblMachine(create_grblhal_config(grbl_machine()), clock, TellsWire(firmware, old, new))
    assert firmware.motion.position == (0.0, 0.0)
    assert firmware.programmed_rpm == 0.0
