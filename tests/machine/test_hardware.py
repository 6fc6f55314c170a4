"""What a machine is wired to: the tables of buses, lines and pots, and everything that is refused in them."""

from __future__ import annotations

import re

import pytest

import resources
from app.compose.machine.machine_files import load_machine, parse_machine
from core.machine.serial_and_backup_tables import SerialLineModel
from core.table_schema import FileFinding, MachineFileError
from drivers.canopen.canopen_nodes import CanTerminal, parse_terminal
from drivers.canopen.canopen_table import CanopenTable
from drivers.grblhal.grblhal_table import GrblhalTable
from drivers.inverter.inverter_table import InverterTable
from drivers.simulated.simulated_table import PlannedFault, SimulatedTable
from tests.texts import text as wording

CAN = resources.read_machine_file("gt75-canopen.toml")
SHIPPED = resources.read_machine_file("gt75.toml")


def changed(old: str, new: str, text: str = CAN) -> str:
    """A shipped file with one text replaced, which must be there."""
    assert old in text
    return text.replace(old, new, 1)


def findings(text: str) -> tuple[FileFinding, ...]:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text, "test.toml")
    return caught.value.findings


def assert_refused(text: str, path: str, expected: str) -> None:
    every = findings(text)
    found = [finding for finding in every if finding.path == path]
    assert found, every
    assert expected in str(found[0])


def test_shipped_bus_table_is_read_in_model_units() -> None:
    machine = parse_machine(CAN, "can")
    bus = machine.hardware.find_driver_table(CanopenTable)
    assert bus is not None
    assert (bus.interface, bus.channel, bus.bitrate) == ("socketcan", "can0", 1_000_000)
    assert (bus.sync, bus.heartbeat, bus.record, bus.host_id) == (0.01, 0.1, 0.02, 127)
    assert [(node.name, node.id, node.profile) for node in bus.nodes] == [
        ("X", 1, 402),
        ("Z", 2, 402),
        ("spindle", 3, 402),
        ("io", 10, 401),
    ]
    assert (0x6007, 0, 3) in bus.nodes[0].sdo
    assert bus.nodes[3].sdo == ()  # "all" means the drives
    assert machine.hardware.spindle_driver == "cia402"
    assert machine.hardware.homing_models["X"].method == 1
    assert machine.hardware.homing_models["X"].latch == pytest.approx(6 * 25.4 / 60)
    assert machine.hardware.analog_inputs["feed_pot"].high_value == 1.5


@pytest.mark.parametrize(
    "name",
    [
        "gt75.toml",
        "gt75-canopen.toml",
        "gt75-grblhal.toml",
        "gt75-vfd.toml",
        "gt75-bench.toml",
        "gt75-epos4.toml",
        "gt75-hal.toml",
        "gt75-parport.toml",
        "gt75-mesa-7i76e.toml",
        "gt75-mesa-7i97.toml",
        "gt75-ethercat.toml",
    ],
)
def test_every_shipped_file_is_valid(name: str) -> None:
    assert parse_machine(resources.read_machine_file(name), name).source == name


def test_serial_and_grbl_tables_are_read() -> None:
    machine = parse_machine(resources.read_machine_file("gt75-vfd.toml"), "vfd")
    vfd, dnc = (
        machine.hardware.find_driver_table(InverterTable),
        machine.hardware.find_driver_table(SerialLineModel),
    )
    assert vfd is not None
    assert (vfd.family, vfd.line_settings.baud, vfd.line_settings.parity, vfd.communication_timeout_s) == (
        "delta-vfdb",
        9600,
        "N",
        1.5,
    )
    assert dnc is not None
    assert (dnc.bits, dnc.parity, dnc.flow, dnc.eol) == (7, "E", "xonxoff", "\r\n")
    grbl = parse_machine(resources.read_machine_file("gt75-grblhal.toml"), "grbl").hardware.find_driver_table(
        GrblhalTable
    )
    assert grbl is not None
    assert (grbl.x_mode, grbl.settings) == ("G8", {13: 0, 32: 2})


def test_simulated_faults_are_read() -> None:
    faults = 'faults = [{ at = 12.0, what = "jam", axis = "Z" }, { at = 1, what = "estop" }]'
    machine = parse_machine(changed("[sim]\n", f"[sim]\nrealtime = true\n{faults}\n", SHIPPED), "t")
    sim, shipped = (
        machine.hardware.find_driver_table(SimulatedTable),
        load_machine(None).hardware.find_driver_table(SimulatedTable),
    )
    assert sim is not None
    assert sim.faults == (PlannedFault(12.0, "jam", "Z"), PlannedFault(1.0, "estop"))
    assert sim.realtime
    assert shipped == SimulatedTable()


def test_terminal_addresses_are_parsed() -> None:
    assert parse_terminal("401.6200.1.3") == CanTerminal("401", 0x6200, 1, 3)
    assert parse_terminal("X.60FD.0.16") == CanTerminal("X", 0x60FD, 0, 16)
    assert parse_terminal("401.6401.2") == CanTerminal("401", 0x6401, 2, -1)
    for wrong in ("OUT-1", "401.62.1.0", "401.6200.1.0.0", "401.62000.1", ""):
        assert parse_terminal(wrong) is None


@pytest.mark.parametrize(
    ("old", "new", "path", "expected"),
    [
        ('channel = "can0"\n', "", "canopen.channel", "missing"),
        ("bitrate = 1000000\nsync", "bitrate = 20\nsync", "canopen.bitrate", "10000…1e+06"),
        ("Z = { id = 2,", "Z = { id = 1,", "canopen.nodes.Z.id", "canopen.nodes.X already uses"),
        ("Z = { id = 2,", "Z = { id = 127,", "canopen.nodes.Z.id", "canopen.host_id already uses"),
        ("Z = { id = 2,", "Z = { id = 128,", "canopen.nodes.Z.id", "1…127"),
        (
            "Z = { id = 2,",
            "W = { id = 2,",
            "canopen.nodes.W",
            "named after the axis or spindle that it moves: X, Z, C, spindle",
        ),
        ("Z = { id = 2, counts_per_rev = 4000 }", "", "canopen.nodes.Z", "axis Z needs a drive"),
        ("Z = { id = 2,", "Z = { id = 2, profile = 401,", "canopen.nodes.Z.profile", "402 (drive)"),
        ("spindle = { id = 3 }", "", "canopen.nodes.spindle", 'spindle.driver = "cia402"'),
        ("io = { id = 10, profile = 401 }", "", "io.in.estop.at", "none defined"),
        ('driver = "cia402"', 'driver = "sim"', "spindle.driver", "must be cia402 or vfd"),
        ('driver = "cia402"', 'driver = "vfd"', "spindle.vfd", "missing"),
        ('mode = "pvt"', 'mode = "pv"', "canopen.mode", '"pvt", "csp", "ip", "pp"'),
        ('drive = "epos2"', 'drive = "epos3"', "canopen.drive", '"cia402", "epos2", "epos4", "copley"'),
        ('drive = "epos2"', 'drive = "epos4"', "canopen.nodes.X.drive", '"pvt" needs a drive with a queue'),
        ('drive = "epos2"', "", "canopen.nodes.Z.drive", '"epos2" or "copley"'),
        (", counts_per_rev = 4000", "", "canopen.nodes.X.counts_per_rev", "EPOS2 reports speeds in rpm"),
        ("record_ms = 20", "record_ms = 12.5", "canopen.record_ms", "whole number of milliseconds"),
        ("commit_ms = 140", "commit_ms = 90", "machine.commit_ms", "at least 100"),  # 3 · 20 + 40
        ("heartbeat_ms = 100", "heartbeat_ms = 20\nx = 1", "canopen.x", "unknown key"),
        ("sync_ms = 10", "sync_ms = 60", "canopen.heartbeat_ms", "at least twice sync_ms"),
        (
            '"6007:0" = 3',
            '"6065:0" = 4294967295',
            'canopen.sdo.all."6065:0"',
            wording("machine.monitoring-off"),
        ),
        ('"6007:0" = 3', '"6065:0" = -1', 'canopen.sdo.all."6065:0"', wording("machine.monitoring-off")),
        ('"6007:0" = 3', '"6007" = 3', 'canopen.sdo.all."6007"', '"6007:0"'),
        ('"6007:0" = 3', '"6007:0" = 3.5', 'canopen.sdo.all."6007:0"', "32-bit integer"),
        ('"6007:0" = 3', '"6007:0" = true', 'canopen.sdo.all."6007:0"', "32-bit integer"),
        ("all = {", "everything = {", "canopen.sdo.everything", "unknown key"),
        ('all = { "6007:0" = 3, "605E:0" = 2 }', "all = 3", "canopen.sdo.all", "must be a table"),
        # 127 << 16 | 300 is 8323372; 126 << 16 | 300 is 8257836
        ('"6007:0" = 3', '"1016:1" = 8257836', 'canopen.sdo.all."1016:1"', "8323372"),
        ('"6007:0" = 3', '"1016:1" = 8323172', 'canopen.sdo.all."1016:1"', "timeout of 100 ms"),
        ('at = "401.6200.1.0"', 'at = "OUT-1"', "io.out.coolant.at", '"401.6200.1.0"'),
        ('at = "401.6200.1.0"', 'at = "401.6000.9.0"', "io.out.coolant.at", "6200"),
        ('at = "401.6200.1.0"', 'at = "401.6200.1.8"', "io.out.coolant.at", "from 0 to 7"),
        ('at = "401.6200.1.0"', 'at = "401.6200.9.0"', "io.out.coolant.at", "sub-index 1…8"),
        ('at = "401.6401.1"', 'at = "401.6401.5"', "io.analog.feed_pot.at", "sub-index 1…4"),
        ('at = "401.6200.1.0"', 'at = "io2.6200.1.0"', "io.out.coolant.at", "[canopen.nodes]: io"),
        (
            'at = "401.6200.1.0"',
            'at = "X.60FD.0.1"',
            "io.out.coolant.at",
            wording("machine.drive-inputs-only"),
        ),
        ('at = "401.6401.1"', 'at = "401.6401.1.3"', "io.analog.feed_pot.at", '"401.6401.1"'),
        (
            'at = "401.6401.1"',
            'at = "401.6401.2"',
            "io.analog.spindle_pot.at",
            "io.analog.feed_pot already uses",
        ),
        ('switch = "spindle_auto"', 'switch = "auto"', "io.analog.spindle_pot.switch", "[io.in]"),
        ('safe = "keep"', 'safe = "keep", refresh_ms = 300', "io.out.collet.refresh_ms", "safe = false"),
        ('1.0", safe = false', '1.0", safe = false, refresh_ms = 3', "io.out.coolant.refresh_ms", "50"),
        # bits 0 to 6 of the first byte have their inputs; without spindle_auto bit 6 is free
        (
            'spindle_auto = { at = "401.6000.1.6" }',
            "",
            "io.analog.spindle_pot.switch",
            wording("machine.switch-line", key="spindle_auto", terminal="401.6000.1.6"),
        ),
        ('at = "401.6200.1.1"', 'at = "io.6200.1.0"', "io.out.collet.at", "io.out.coolant already uses"),
        ('at = "401.6000.1.2"', 'at = "401.6000.01.1"', "io.in.hold.at", "io.in.start already uses"),
        # X: -4 in and 4 in of counts of .00005 in are -80000 and 80000
        (
            "all = {",
            'X = { "607D:1" = -79999 }\nall = {',
            'canopen.sdo.X."607D:1"',
            wording("machine.limit-below-travel", path="axis.X.travel", needed=-80000),
        ),
        (
            "all = {",
            'X = { "607D:2" = 79999 }\nall = {',
            'canopen.sdo.X."607D:2"',
            wording("machine.limit-below-travel", path="axis.X.travel", needed=80000),
        ),
        (
            "range = [0, 1.5]",
            "range = [0, 3]",
            "io.analog.feed_pot.range",
            wording("machine.fractions", top=1.5),
        ),
        ("spindle_pot = {", "pot = {", "io.analog.pot", "unknown key"),
        ("method = 1,", "", "axis.X.home.method", "limit switch"),
        ("method = 1,", "method = 99,", "axis.X.home.method", "-128…37"),
    ],
)
def test_invalid_bus_value_is_rejected(old: str, new: str, path: str, expected: str) -> None:
    assert_refused(changed(old, new), path, expected)


@pytest.mark.parametrize(
    ("old", "new", "path", "expected"),
    [
        (
            'backend = "sim"',
            'backend = "canopen"',
            "[canopen]",
            wording("machine.table-required", backend="canopen"),
        ),
        (
            'backend = "sim"',
            'backend = "grblhal"',
            "[grblhal]",
            wording("machine.table-required", backend="grblhal"),
        ),
        (
            "[sim]\n",
            '[sim]\nfaults = [{ at = 1, what = "jam" }]\n',
            "sim.faults.1.axis",
            "one of these axes: X, Z, C",
        ),
        (
            "[sim]\n",
            '[sim]\nfaults = [{ at = 1, what = "estop", axis = "X" }]\n',
            "sim.faults.1.axis",
            "estop is not an axis fault; remove this key",
        ),
        ("[sim]\n", '[sim]\nfaults = [{ at = 1, what = "rust" }]\n', "sim.faults.1.what", "encoder_stuck"),
        (
            "[sim]\n",
            '[sim]\nfaults = [{ at = 1, what = "loose_gib" }]\n',
            "sim.faults.1.axis",
            "one of these axes: X",
        ),
        (
            "[sim]\n",
            '[sim]\nfaults = [{ at = 1, what = "encoder_ripple", axis = "X", turn = 0 }]\n',
            "sim.faults.1.turn",
            "0.1",
        ),
        ("[sim]\n", "[sim]\nfaults = 3\n", "sim.faults", "a list of tables"),
        ("[sim]\n", '[grblhal]\nport = "p"\nsettings = { 13 = 1 }\n[sim]\n', "grblhal.settings.13", "mm"),
        (
            "[sim]\n",
            '[grblhal]\nport = "p"\nsettings = { 32 = 0 }\n[sim]\n',
            "grblhal.settings.32",
            "lathe mode",
        ),
        (
            "[sim]\n",
            '[grblhal]\nport = "p"\nx_mode = "G7"\n[sim]\n',
            "grblhal.x_mode",
            "a reset would change",
        ),
        ("[sim]\n", '[grblhal]\nport = "p"\nsettings = { a = 1 }\n[sim]\n', "grblhal.settings.a", "$13"),
        # travel 8 in = 203.2 mm, 300 in/min = 7620 mm/min, 120 in/s² = 3048 mm/s²
        (
            "[sim]\n",
            '[grblhal]\nport = "p"\nsettings = { 130 = 203 }\n[sim]\n',
            "grblhal.settings.130",
            "203.2",
        ),
        (
            "[sim]\n",
            '[grblhal]\nport = "p"\nsettings = { 112 = 7000 }\n[sim]\n',
            "grblhal.settings.112",
            "7620",
        ),
        (
            "[sim]\n",
            '[grblhal]\nport = "p"\nsettings = { 120 = 3000 }\n[sim]\n',
            "grblhal.settings.120",
            "3048",
        ),
        ("[sim]\n", '[dnc]\nport = "p"\nbits = 6\n[sim]\n', "dnc.bits", "7…8"),
    ],
)
def test_invalid_value_is_rejected_on_simulated_lathe(old: str, new: str, path: str, expected: str) -> None:
    assert_refused(changed(old, new, SHIPPED), path, expected)


def test_a_bus_without_io_names_every_signal() -> None:
    found = findings(changed("io = { id = 10, profile = 401 }", ""))
    assert len(found) == len(re.findall(r'^[^#\n]*at = "401', CAN, re.MULTILINE))


def test_serial_port_used_twice_is_rejected() -> None:
    text = resources.read_machine_file("gt75-vfd.toml").replace('"/dev/ttyUSB1"', '"/dev/ttyUSB0"')
    assert_refused(text, "dnc.port", "spindle.vfd.port already uses")
