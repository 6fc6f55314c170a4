"""The HAL file and the bus description of a lathe with EtherCAT drives.

The file uses lcec and cia402 in cyclic synchronous position mode.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from drivers.hal.boards.board_parts import get_c_revolution_pins, get_spindle_command_pins, load_c_components
from drivers.hal.boards.hal_file_builder import BoardTerminal, HalFile, LatheAxis, LatheData

BUS_XML_NAME = "ethercat-conf.xml"
_IO_PATTERN = re.compile(r"lcec\.0\.(DI\.din-([0-7])(?:-not)?|DO\.dout-([0-7]))")
_OUTPUT_PDO = (("6040", 16, "cia-controlword", "u32"), ("6060", 8, "opmode", "s32"),
        ("607A", 32, "target-position", "s32"), ("60FF", 32, "target-velocity", "s32"))  # fmt: skip
_INPUT_PDO = (("6041", 16, "cia-statusword", "u32"), ("6061", 8, "opmode-display", "s32"),
       ("6064", 32, "actual-position", "s32"), ("606C", 32, "actual-velocity", "s32"))  # fmt: skip


def build_ethercat_file(lathe: LatheData) -> HalFile:
    """Build the HAL file for CSP axis drives, a CSV spindle drive, and EL1008 and EL2008 terminals."""
    hint = "a bus terminal: lcec.0.DI.din-0 … din-7 (EL1008), lcec.0.DO.dout-0 … dout-7 (EL2008)"
    file = HalFile(lathe, "EtherCAT drives in cyclic synchronous position mode", _terminal, hint)
    file.pre_motion_checks += [
        ("build the EtherCAT master, linuxcnc-ethercat (lcec) and hal-cia402; Debian does not include them"),
        (
            "read the vendor, product and position of each slave with: ethercat slaves -v; "
            "for the PDO mapping and the clock settings, see the drive manual"
        ),
        (
            "axis.NAME.count: check the increments of object 6064 against a dial gauge over a 10 "
            "mm jog; X positions are radii"
        ),
        (
            "set the window for the following error (object 6065) in the drive too, and set the "
            "drive to make a quick stop when bus communication is lost"
        ),
        (
            "spindle: find the value of object 60FF that gives 1 rpm, and its sign. Object 6064 "
            "is a 32-bit counter that wraps around"
        ),
    ]
    drives = [axis.name.lower() for axis in lathe.driven_axes]
    if _turned(lathe):
        drives.append("spindle")
    _load(file, drives)
    file.connect_link_fault("nand", *_list_healthy_pins(lathe, drives))
    for axis in lathe.driven_axes:
        _axis(file, axis)
    file.start_section("Drive power")
    file.connect_enable_pins(*(f"cia402.{axis.name.lower()}.enable" for axis in lathe.driven_axes))
    if _turned(lathe):
        _spindle(file)
    file.connect_remaining_terminals()
    file.extra_files[BUS_XML_NAME] = build_bus_xml(lathe)
    return file


def _turned(lathe: LatheData) -> bool:
    return lathe.board_table.spindle.channel >= 0


def _list_healthy_pins(lathe: LatheData, drives: list[str]) -> tuple[str, ...]:
    """Return the pins that are on while the bus and all its slaves exchange data.

    ``all-op`` counts only slaves that respond, so ``slave-oper`` of each slave is also monitored.
    """
    slaves = [*drives, *(("DI", "DO") if _has_terminals(lathe) else ())]
    return "lcec.0.link-up", "lcec.0.all-op", *(f"lcec.0.{name}.slave-oper" for name in slaves)


def _has_terminals(lathe: LatheData) -> bool:
    return any(_IO_PATTERN.fullmatch(name) for name in lathe.terminal_names.values())


def _load(file: HalFile, drives: list[str]) -> None:
    lathe = file.lathe
    file.add_load_line(f"loadrt threads name1={lathe.servo_thread} period1={lathe.servo_period_s * 1e9:.0f}")
    file.add_load_line(
        f"loadusr -W lcec_conf {BUS_XML_NAME}", "bus configuration file, in the same folder as this file"
    )
    file.add_load_line("loadrt lcec")
    file.add_load_line(f"loadrt cia402 names={','.join(f'cia402.{name}' for name in drives)}")
    if "spindle" in drives:
        file.add_load_line("loadrt scale names=spindle-per-s")
    file.first_function_calls += ["lcec.read-all", *(f"cia402.{name}.read-all" for name in drives)]
    file.first_function_calls += ["spindle-per-s"] * ("spindle" in drives)
    if lathe.c_axis is not None:
        load_c_components(file, shares_input=True)
    file.last_function_calls += [*(f"cia402.{name}.write-all" for name in drives), "lcec.write-all"]


def _terminal(name: str) -> BoardTerminal | None:
    found = _IO_PATTERN.fullmatch(name)
    if found is None:
        return None
    drives = found[3] is not None
    number = int(found[3] if drives else found[2])
    return BoardTerminal(drives, f"{'EL2008' if drives else 'EL1008'} channel {number + 1}")


def _connect_drive(file: HalFile, name: str) -> None:
    """Connect the objects of one drive to its cia402 component."""
    file.connect_pins(f"{name}-statusword", f"lcec.0.{name}.cia-statusword", f"cia402.{name}.statusword")
    file.connect_pins(
        f"{name}-opmode-display", f"lcec.0.{name}.opmode-display", f"cia402.{name}.opmode-display"
    )
    file.connect_pins(
        f"{name}-drv-pos", f"lcec.0.{name}.actual-position", f"cia402.{name}.drv-actual-position"
    )
    file.connect_pins(
        f"{name}-drv-vel", f"lcec.0.{name}.actual-velocity", f"cia402.{name}.drv-actual-velocity"
    )
    file.connect_pins(f"{name}-controlword", f"cia402.{name}.controlword", f"lcec.0.{name}.cia-controlword")
    file.connect_pins(f"{name}-opmode", f"cia402.{name}.opmode", f"lcec.0.{name}.opmode")
    file.connect_pins(
        f"{name}-target-pos", f"cia402.{name}.drv-target-position", f"lcec.0.{name}.target-position"
    )
    file.connect_pins(
        f"{name}-target-vel", f"cia402.{name}.drv-target-velocity", f"lcec.0.{name}.target-velocity"
    )


def _axis(file: HalFile, axis: LatheAxis) -> None:
    board, name = file.lathe.board_table.axes[axis.name], axis.name.lower()
    place, pin = f"slave {board.channel}", f"cia402.{axis.name.lower()}"
    file.start_section(f"Axis {axis.name}: slave {board.channel}, cyclic synchronous position")
    file.set_pin(f"{pin}.csp-mode", 1)
    sign = -1.0 if board.reversed else 1.0
    file.set_pin(
        f"{pin}.pos-scale", sign / axis.travel_per_count, f"increments per {axis.position_unit}: 1 / count"
    )
    file.set_pin(
        f"{pin}.auto-fault-reset",
        1,
        "a drive fault is reset when power is requested again with Reset and DRIVES ON",
    )
    _connect_drive(file, name)
    file.connect_position_pins(axis.name, [f"{pin}.pos-cmd"], [f"{pin}.pos-fb"], place)
    file.connect_key_pins(f"hal.axes.{axis.name}.fault", f"{name}-fault", f"{pin}.drv-fault", label=place)


def _spindle(file: HalFile) -> None:
    board, pin = file.lathe.board_table.spindle, "cia402.spindle"
    place, sign = f"slave {board.channel}", -1.0 if board.reversed else 1.0
    file.start_section(f"Spindle: slave {board.channel}, cyclic synchronous velocity")
    file.set_pin(f"{pin}.csp-mode", 0)
    file.set_pin(
        f"{pin}.velo-scale", sign * board.velocity_per_rpm, "value of objects 60FF and 606C at 1 rpm"
    )
    if file.lathe.encoder_pulses_per_rev:
        file.set_pin(
            f"{pin}.pos-scale",
            sign * 4 * file.lathe.encoder_pulses_per_rev,
            "increments of object 6064 per revolution: 4 x encoder lines",
        )
        further = get_c_revolution_pins(file)
        file.connect_key_pins("hal.spindle.position", "spindle-turns", f"{pin}.pos-fb", *further, label=place)
    _connect_drive(file, "spindle")
    file.set_pin("spindle-per-s.gain", 1.0 / 60.0)
    file.connect_pins("spindle-rpm-fb", f"{pin}.velocity-fb", "spindle-per-s.in")
    file.connect_key_pins("hal.spindle.velocity", "spindle-rps", "spindle-per-s.out", label=place)
    speed, on = get_spindle_command_pins(file, f"{pin}.velocity-cmd", f"{pin}.enable")
    file.connect_key_pins("hal.spindle.speed", "spindle-rpm-cmd", speed, label=place, is_required=True)
    file.connect_key_pins("hal.spindle.on", "spindle-on", on, label=place, is_required=True)
    file.connect_key_pins("hal.spindle.fault", "spindle-fault", f"{pin}.drv-fault", label=place)


# --- The bus.


def build_bus_xml(lathe: LatheData) -> str:
    """Return the input file of lcec_conf.

    The drives are listed by their positions on the bus, followed by the terminals.
    """
    lines = [
        "<masters>",
        f'  <master idx="0" appTimePeriod="{lathe.servo_period_s * 1e9:.0f}" refClockSyncCycles="1">',
    ]
    slaves = [(lathe.board_table.axes[axis.name], axis.name.lower()) for axis in lathe.driven_axes]
    drives = [(board.channel, board.vendor, board.product, name) for board, name in slaves]
    spindle = lathe.board_table.spindle
    if _turned(lathe):
        drives.append((spindle.channel, spindle.vendor, spindle.product, "spindle"))
    for place, vendor, product, name in sorted(drives):
        lines += _slave_lines(place, vendor, product, name)
    coupler_position = 1 + max(place for place, *_ in drives)
    if _has_terminals(lathe):
        lines += [
            f'    <slave idx="{coupler_position}" type="EK1100" name="coupler"/>',
            f'    <slave idx="{coupler_position + 1}" type="EL1008" name="DI"/>',
            f'    <slave idx="{coupler_position + 2}" type="EL2008" name="DO"/>',
        ]
    return "\n".join((*lines, "  </master>", "</masters>", ""))


def _slave_lines(position: int, vendor: str, product: str, name: str) -> Iterator[str]:
    """Yield the XML lines of one drive; their halPin attributes name the pins used in the HAL file."""
    ids = f'vid="{int(vendor, 16):08X}" pid="{int(product, 16):08X}"'
    yield f'    <slave idx="{position}" type="generic" {ids} name="{name}" configPdos="true">'
    yield '      <dcConf assignActivate="300" sync0Cycle="*1" sync0Shift="0"/>'
    for number, direction, pdo, objects in ((2, "out", "1600", _OUTPUT_PDO), (3, "in", "1a00", _INPUT_PDO)):
        yield f'      <syncManager idx="{number}" dir="{direction}">'
        yield f'        <pdo idx="{pdo}">'
        for index, bits, pin, kind in objects:
            words = f'idx="{index}" subIdx="00" bitLen="{bits}" halPin="{pin}" halType="{kind}"'
            yield f"          <pdoEntry {words}/>"
        yield "        </pdo>"
        yield "      </syncManager>"
    yield "    </slave>"
