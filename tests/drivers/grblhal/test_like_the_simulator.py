"""A controller as the firmware's simulator comes: no encoder, no auxiliary ports, its own defaults."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.cli.main import main
from core.executor.commands import Reset
from core.executor.snapshot import MachineState
from drivers.simulators.grblhal_connections import TcpConnection, run_simulator
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.wakeups import RealClock
from tests.drivers.grblhal.bench import SHIPPED, GrblBench, quirky
from tests.drivers.grblhal.test_faults import THREAD
from tests.texts import text as text_of

Captured = pytest.CaptureFixture[str]

# Its defaults: rpm, mm/min and mm/s².
DEFAULTS = {30: 1000.0, **{110 + i: 500.0 for i in range(3)}, **{120 + i: 10.0 for i in range(3)}}
AS_IT_COMES = {"encoder": False, "outputs": 0, "inputs": 0, "settings": DEFAULTS}


@pytest.fixture
def machine_file(tmp_path: Path) -> Iterator[Path]:
    """On a socket, named as pyserial names one."""
    end = TcpConnection("127.0.0.1", 0)
    over = threading.Event()
    firmware = GrblFirmware(RealClock(), quirky(**AS_IT_COMES))
    peer = threading.Thread(target=run_simulator, args=(end, firmware, lambda: not over.is_set()))
    peer.start()
    file = tmp_path / "simulator.toml"
    text = SHIPPED.replace("/dev/ttyACM0", end.device_name.replace("tcp", "socket"))
    file.write_text(text, encoding="utf-8")
    yield file
    over.set()
    peer.join(60.0)
    assert not peer.is_alive()


def test_missing_capabilities_are_reported() -> None:
    warnings = GrblBench(quirks=quirky(**AS_IT_COMES)).machine.ports.warnings
    for values in (
        ("X: ", "500 mm/min", "7620"),
        ("Z: ", "10 mm/s²", "3048"),
        ("$30", "1000 rpm", "3500"),
    ):
        assert any(all(value in line for value in values) for line in warnings), values
    assert text_of("drivers.grblhal-no-encoder") in warnings
    (outputs,) = [line for line in warnings if line.startswith("outputs ")]
    assert "collet (out.0), catcher (out.1), live1 (out.2)" in outputs
    assert " 0 " in outputs


def test_program_runs_with_default_speeds_of_the_controller() -> None:
    bench = GrblBench(quirks=quirky(**AS_IT_COMES))
    bench.start("G90G94F300\nX.1Z.1\nG01X.05F60\nM08\nM09\nM30\n")
    bench.until(MachineState.IDLE)
    assert bench.peer.motion.position == pytest.approx((1.27, 2.54))
    assert bench.shot.parts == 1
    assert not bench.said("alarm")


def test_speed_above_the_controller_limit_is_an_alarm() -> None:
    bench = GrblBench(quirks=quirky(**AS_IT_COMES))
    bench.start("G90G94F300\nM03S1500\nX.1Z.1\nM30\n")
    bench.until(MachineState.FAULT, limit=5.0)
    (alarm,) = bench.shot.alarms
    assert alarm.code == "spindle-off"
    for value in ("1000 rpm ($30)", "1500"):
        assert value in alarm.detail


def test_a_thread_is_refused_before_the_start() -> None:
    bench = GrblBench(quirks=quirky(**AS_IT_COMES))
    bench.start(THREAD.replace("S600", "S900"))
    assert bench.state is MachineState.IDLE
    assert "threads" in bench.shot.start_refusal_reason
    assert bench.wire.lines() == []


def test_reset_during_a_slow_deceleration_retains_the_position() -> None:
    """500 mm/min is 8.3 mm/s: 0.83 s to brake with 10 mm/s²."""
    bench = GrblBench(quirks=quirky(**AS_IT_COMES))
    bench.start("G90G94F300\nX1\nM30\n")
    bench.until_true(lambda _: bench.peer.motion.speed > 8.0, 5.0)
    bench.post(Reset())
    bench.until(MachineState.IDLE, limit=5.0)
    assert bench.peer.abrupt_stop_count == 0
    assert not bench.shot.alarms


def test_inputs_missing_on_the_controller_fail_the_check(machine_file: Path, capsys: Captured) -> None:
    assert main(["machine", "check", str(machine_file)]) == 1
    assert "collet_closed" in capsys.readouterr().err


def test_missing_outputs_fail_the_check_and_the_program_still_runs(
    machine_file: Path, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    lines = machine_file.read_text(encoding="utf-8").splitlines(keepends=True)
    text = "".join(line for line in lines if 'at = "in.' not in line)
    text = text.replace("spindle_with_collet_open = false", "spindle_with_collet_open = true")
    machine_file.write_text(text, encoding="utf-8")
    assert main(["machine", "check", str(machine_file)]) == 1  # its outputs out.N are not there
    told = capsys.readouterr()
    assert text_of("drivers.grblhal-no-encoder") in told.err
    rows = [line.split() for line in told.out.splitlines() if line.startswith("  ")]
    failed = {row[2]: row[4] for row in rows if row[0] == "FAIL"}
    assert failed == dict.fromkeys(failed, "missing")
    assert {"collet", "catcher"} <= failed.keys()
    assert not {"coolant", "estop"} & failed.keys()
    program = tmp_path / "part.nc"
    program.write_text("G90G94F300\nX.02Z.02\nG01X.01F60\nM08\nM09\nM30\n", encoding="utf-8")
    assert main(["run", str(program), "--headless", "--machine", str(machine_file)]) == 0
    assert "complete" in capsys.readouterr().out
