"""The whole way: executor, snapshot, items, lines, an agent that knows the machine by its device model."""

from __future__ import annotations

import dataclasses
import json
import re
import socket
import threading
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from xml.etree import ElementTree

import pytest

import resources
from app.compose.machine.machine_files import load_machine, load_named_machine
from app.compose.screen_desk import build_desk
from app.extras.mtconnect.adapter_setup import make_adapter, make_device_component, make_devices_document
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from core.executor.commands import CycleStart, FeedHold, Reset, SetSwitch
from core.executor.snapshot import MachineState, Snapshot
from core.machine.machine_model import Machine
from tests.cli.conftest import Turndesk, home, turndesk
from tests.executor.rig import Rig
from tests.extras.mtconnect.agent import FakeAgent, kinds_of
from tests.free_port import free_port
from tests.texts import pattern

__all__ = ["home", "turndesk"]

MODEL = MtconnectTable(enabled=True, bind="127.0.0.1", port=0, heartbeat=10.0, device="GT75")
LATHE = load_machine(None)


def with_model(machine: Machine) -> Machine:
    told = dataclasses.replace(machine.hardware, tables={"mtconnect": MODEL})
    return dataclasses.replace(machine, hardware=told)


class Floor:
    """A rig that is looked at after every tick, and an agent that reads on."""

    def __init__(self) -> None:
        self.rig = Rig(machine=with_model(LATHE))
        self.adapter = make_adapter(self.rig.machine, MODEL, lambda: self.rig.shot)
        self.adapter.open()
        self.agent = FakeAgent(make_devices_document(self.rig.machine, datetime.now(UTC)), self.rig.clock)
        self.agent.connect(self.adapter.address)
        self.history("execution")
        self.rig.watch.append(lambda _: self.see())

    def see(self) -> None:
        """One look, whatever the wall clock says."""
        self.adapter.send_changes()
        self.adapter.run_once(0.0)
        self.agent.read()

    def history(self, key: str) -> list[str]:
        """Every value that a key has had, up to what the machine says now."""
        mark = len(self.agent.lines)
        self.agent.send(b"* PING\n")
        while not any(line.startswith("* PONG") for line in self.agent.lines[mark:]):
            self.adapter.run_once(0.001)
            self.agent.read()
        assert (self.agent.unknown, self.agent.bad) == ([], [])
        return re.findall(rf"\|{key}\|([^|\n]*)", "\n".join(self.agent.lines))

    def close(self) -> None:
        self.adapter.close()
        self.agent.hang_up()


@pytest.fixture
def floor() -> Iterator[Floor]:
    one = Floor()
    yield one
    one.close()


def test_program_is_reported_from_power_up_to_its_end(floor: Floor) -> None:
    floor.rig.start("G90G94F300\nM03S500\nX.1\nM30\n")
    floor.rig.until(MachineState.IDLE)
    assert floor.history("execution") == ["STOPPED", "READY", "ACTIVE", "PROGRAM_COMPLETED"]
    assert floor.history("pcount") == ["0", "1"]
    assert floor.history("line") == ["UNAVAILABLE", "2", "3", "UNAVAILABLE"]  # M30 takes no time
    assert float(floor.history("Xabs")[-1]) == pytest.approx(
        2.54, abs=0.006
    )  # .1 in of radius, and the bands
    assert set(floor.history("avail")) == {"AVAILABLE"}


@pytest.mark.parametrize(
    ("program", "told"),
    [("M00(LOOK)", "PROGRAM_STOPPED"), ("M01(LOOK)", "OPTIONAL_STOP")],
)
def test_program_stop_and_optional_stop_are_distinguished(floor: Floor, program: str, told: str) -> None:
    floor.rig.post(SetSwitch("optional_stop", True))
    floor.rig.start(f"G90G94F300\n{program}\nX.1\nM30\n")
    floor.rig.until(MachineState.PROGRAM_STOP)
    assert floor.history("execution")[-1] == told
    floor.rig.run(0.4)
    floor.rig.post(CycleStart())
    floor.rig.until(MachineState.IDLE)
    assert floor.history("execution")[-3:] == [told, "ACTIVE", "PROGRAM_COMPLETED"]


def test_hold_and_program_abort_are_reported(floor: Floor) -> None:
    floor.rig.start("G90G94F10\nX1\nM30\n")
    floor.rig.run(1.0)
    floor.rig.post(FeedHold())
    floor.rig.until(MachineState.HOLD)
    assert floor.history("execution")[-2:] == ["ACTIVE", "FEED_HOLD"]
    floor.rig.post(Reset())
    floor.rig.until(MachineState.IDLE)
    assert floor.history("execution")[-1] == "STOPPED"
    assert floor.history("pcount") == ["0"]


def test_jammed_axis_is_reported_as_an_axis_fault_until_reset(floor: Floor) -> None:
    floor.rig.start("G90G94F60\nX1\nM30\n")
    floor.rig.run(0.5)
    floor.rig.sim.machine.jam("X")
    floor.rig.until(MachineState.FAULT)
    assert floor.history("execution")[-1] == "STOPPED"
    assert [level for level, _ in (floor.agent.active["Xservo"] or {}).values()] == ["FAULT"]
    assert floor.agent.active["Zservo"] == {}
    floor.rig.sim.machine.jam("X", False)
    floor.rig.run(1.0)
    floor.rig.post(Reset())
    assert floor.history("execution")[-1] == "STOPPED"  # the alarm has taken the power
    assert floor.agent.active["Xservo"] == {}


def test_estop_is_reported(floor: Floor) -> None:
    floor.rig.ready()
    floor.rig.sim.machine.press_estop()
    floor.rig.run(0.1)
    assert floor.history("estop") == ["ARMED", "TRIGGERED"]
    assert floor.history("execution")[-1] == "STOPPED"


# --- as it is put together -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", sorted(p.name for p in Path(resources.__file__).parent.glob("machines/*.toml"))
)
def test_reports_of_each_shipped_machine_match_its_device_model(name: str) -> None:
    """A key that the model has and nobody ever tells would stay UNAVAILABLE for ever."""
    machine = load_named_machine(str(Path(resources.__file__).parent / "machines" / name))
    kinds = kinds_of(make_devices_document(with_model(machine), datetime.now(UTC)))
    snapshot = Snapshot(
        t=1.0,
        axes=tuple(axis.name for axis in machine.axes),
        actual=tuple(1.0 for _ in machine.axes),
        homed=tuple(True for _ in machine.axes),
    )
    adapter = make_adapter(machine, MODEL, lambda: snapshot)
    report = adapter._report()
    told = set(report.item_values) - ({"chuck", "chuckil"} if machine.kind == "mill" else set())
    assert told == {key for key, kind in kinds.items() if kind != "CONDITION"}
    assert set(report.active_conditions) == {key for key, kind in kinds.items() if kind == "CONDITION"}
    assert make_device_component(machine, "GT75").name == "GT75"


def machine_file(folder: Path, port: int, **changes: str) -> Path:
    path = folder / "own.toml"
    table = {"enabled": "true", "device": '"GT75"', "port": str(port), **changes}
    lines = "".join(f"{key} = {value}\n" for key, value in table.items())
    path.write_text(resources.read_machine_file("gt75.toml") + f"\n[mtconnect]\n{lines}")
    return path


def threads() -> list[str]:
    return [thread.name for thread in threading.enumerate() if thread.name in {"mtconnect", "status"}]


def test_screen_program_serves_agents_from_start_to_end(home: Path, tmp_path: Path) -> None:
    port = free_port()
    desk = build_desk(str(machine_file(tmp_path, port)))
    try:
        with socket.create_connection(("127.0.0.1", port), 60.0) as wire:
            assert b"|execution|STOPPED|" in wire.recv(65536)
    finally:
        desk.close()
    assert threads() == []
    status = json.loads((home / "status.json").read_text())
    assert (status["machine"], status["available"]) == ("GT-75", False)  # the control has ended
    with pytest.raises(ConnectionError):
        socket.create_connection(("127.0.0.1", port), 60.0)


def test_port_in_use_is_reported_and_the_machine_runs(home: Path, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        desk = build_desk(str(machine_file(tmp_path, port)))
        try:
            assert re.fullmatch(pattern("shopfloor.no-data"), desk.prompt_notice)
            for value in ("[mtconnect]", "127.0.0.1", str(port)):
                assert value in desk.prompt_notice
            assert desk.read_snapshot().state is MachineState.DISABLED
        finally:
            desk.close()
    assert threads() == []


@pytest.mark.parametrize("enabled", ["false", None])
def test_disabled_adapter_does_not_listen(home: Path, tmp_path: Path, enabled: str | None) -> None:
    port = free_port()
    path = machine_file(tmp_path, port, **({"enabled": enabled} if enabled else {}))
    if enabled is None:
        path.write_text(resources.read_machine_file("gt75.toml"))
    desk = build_desk(str(path))
    try:
        assert threads() == ["status"]
        with pytest.raises(ConnectionError):
            socket.create_connection(("127.0.0.1", port), 60.0)
    finally:
        desk.close()


PART = "G90G94F300\nM03S2000\nT1\nX.5Z.1\nM30\n"


def run(turndesk: Turndesk, path: Path, *options: str) -> tuple[int, str]:
    part, offsets = path.with_name("part.nc"), path.with_name("offsets.toml")
    part.write_text(PART)
    offsets.write_text("[tool.1]\nx = -0.5\nz = -1.0\n")
    told = turndesk("run", part, "--headless", "--machine", path, "--offsets", offsets, *options)
    return told.status, told.err


def test_real_time_run_without_a_screen_is_sent_to_agents(turndesk: Turndesk, tmp_path: Path) -> None:
    port = free_port()
    path = machine_file(tmp_path, port)
    heard: list[bytes] = []
    over = threading.Event()

    def listen() -> None:
        while not over.is_set():
            try:
                wire = socket.create_connection(("127.0.0.1", port), 60.0)
            except ConnectionError:  # not open yet
                continue
            with wire:
                while more := wire.recv(65536):
                    heard.append(more)
            return

    agent = threading.Thread(target=listen, name="agent")
    agent.start()
    status, err = run(turndesk, path, "--realtime")
    over.set()
    agent.join()
    told = b"".join(heard).decode()
    assert (status, err.count("shop-floor")) == (0, 0)
    assert "|execution|ACTIVE" in told
    assert "|pcount|1" in told
    assert threads() == []


def test_faster_than_real_time_run_is_not_sent_to_agents(turndesk: Turndesk, tmp_path: Path) -> None:
    status, err = run(turndesk, machine_file(tmp_path, free_port()))
    assert status == 0
    assert "--realtime" in err


def test_run_with_a_port_in_use_reports_it_and_continues(turndesk: Turndesk, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        status, err = run(turndesk, machine_file(tmp_path, port), "--realtime")
    assert status == 0
    assert err.count(str(port)) == 1


# --- the device model as a command -----------------------------------------------------------------------


def test_the_model_is_written_to_stdout(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("machine", "mtconnect", machine_file(tmp_path, 7878))
    assert (told.status, told.err) == (0, "")
    assert ElementTree.fromstring(told.out).tag.endswith("MTConnectDevices")
    assert "execution" in kinds_of(told.out)


def test_model_command_without_the_mtconnect_table_is_rejected(turndesk: Turndesk, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(resources.read_machine_file("gt75.toml"))
    told = turndesk("machine", "mtconnect", path)
    assert (told.status, told.out) == (2, "")
    assert "[mtconnect]" in told.err


def test_device_name_invalid_for_agents_is_rejected(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("machine", "mtconnect", machine_file(tmp_path, 7878, device='"GT 75"'))
    assert (told.status, told.out) == (2, "")
    assert "device = 'GT 75'" in told.err


def test_model_of_a_disabled_adapter_says_so(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("machine", "mtconnect", machine_file(tmp_path, 7878, enabled="false"))
    assert told.status == 0
    assert "enabled = false" in told.err


# --- machine check ---------------------------------------------------------------------------------------


def test_machine_check_tries_the_port(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("machine", "check", machine_file(tmp_path, port := free_port()))
    assert told.status == 0
    assert re.search(rf"mtconnect +127.0.0.1:{port} +ok +device GT75", told.out)
    socket.create_server(("127.0.0.1", port)).close()  # and has let it go


def test_machine_check_reports_a_port_in_use(turndesk: Turndesk, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        told = turndesk("machine", "check", machine_file(tmp_path, port))
    assert told.status == 1
    assert str(port) in told.err


def test_machine_check_reports_an_invalid_device_name(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("machine", "check", machine_file(tmp_path, free_port(), device='"GT 75"'))
    assert told.status == 1
    assert "device = 'GT 75'" in told.err


def test_machine_check_omits_a_disabled_adapter(turndesk: Turndesk, tmp_path: Path) -> None:
    told = turndesk("machine", "check", machine_file(tmp_path, free_port(), enabled="false"))
    assert (told.status, "mtconnect" in told.out) == (0, False)
