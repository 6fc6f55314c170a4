"""HAL file and bus description of a lathe with EtherCAT drives: lcec, cia402, cyclic synchronous position."""

from __future__ import annotations

import re
from collections.abc import Iterator

from drivers.hal.boards.board_parts import c_speed_pins, c_turn_pins, load_c
from drivers.hal.boards.hal_lines import HalFile, Lathe, LatheAxis, Terminal

XML = "ethercat-conf.xml"
_IO = re.compile(r"lcec\.0\.(DI\.din-([0-7])(?:-not)?|DO\.dout-([0-7]))")
_OUT = (("6040", 16, "cia-controlword", "u32"), ("6060", 8, "opmode", "s32"),
        ("607A", 32, "target-position", "s32"), ("60FF", 32, "target-velocity", "s32"))  # fmt: skip
_IN = (("6041", 16, "cia-statusword", "u32"), ("6061", 8, "opmode-display", "s32"),
       ("6064", 32, "actual-position", "s32"), ("606C", 32, "actual-velocity", "s32"))  # fmt: skip


def ethercat_lathe(lathe: Lathe) -> HalFile:
    """Build the HAL file for drives in CSP, a spindle in CSV, one EL1008 and one EL2008."""
    hint = "a bus terminal: lcec.0.DI.din-0 … din-7 (EL1008), lcec.0.DO.dout-0 … dout-7 (EL2008)"
    file = HalFile(lathe, "EtherCAT drives in cyclic synchronous position mode", _terminal, hint)
    file.notes += [
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
    drives = [axis.name.lower() for axis in lathe.driven]
    if _turned(lathe):
        drives.append("spindle")
    _load(file, drives)
    file.link("nand", *_healthy(lathe, drives))
    for axis in lathe.driven:
        _axis(file, axis)
    file.section("Drive power")
    file.enable(*(f"cia402.{axis.name.lower()}.enable" for axis in lathe.driven))
    if _turned(lathe):
        _spindle(file)
    file.rest()
    file.beside[XML] = bus_xml(lathe)
    return file


def _turned(lathe: Lathe) -> bool:
    return lathe.board.spindle.channel >= 0


def _healthy(lathe: Lathe, drives: list[str]) -> tuple[str, ...]:
    """Return the pins that are on while the bus and each of its slaves exchange data.

    ``all-op`` counts only slaves that respond, so ``slave-oper`` of each slave is also monitored.
    """
    slaves = [*drives, *(("DI", "DO") if _has_terminals(lathe) else ())]
    return "lcec.0.link-up", "lcec.0.all-op", *(f"lcec.0.{name}.slave-oper" for name in slaves)


def _has_terminals(lathe: Lathe) -> bool:
    return any(_IO.fullmatch(name) for name in lathe.names.values())


def _load(file: HalFile, drives: list[str]) -> None:
    lathe = file.lathe
    file.load(f"loadrt threads name1={lathe.thread} period1={lathe.period * 1e9:.0f}")
    file.load(f"loadusr -W lcec_conf {XML}", "bus configuration file, in the same folder as this file")
    file.load("loadrt lcec")
    file.load(f"loadrt cia402 names={','.join(f'cia402.{name}' for name in drives)}")
    if "spindle" in drives:
        file.load("loadrt scale names=spindle-per-s")
    file.first += ["lcec.read-all", *(f"cia402.{name}.read-all" for name in drives)]
    file.first += ["spindle-per-s"] * ("spindle" in drives)
    if lathe.c is not None:
        load_c(file, chosen=True)
    file.last += [*(f"cia402.{name}.write-all" for name in drives), "lcec.write-all"]


def _terminal(name: str) -> Terminal | None:
    found = _IO.fullmatch(name)
    if found is None:
        return None
    drives = found[3] is not None
    number = int(found[3] if drives else found[2])
    return Terminal(drives, f"{'EL2008' if drives else 'EL1008'} channel {number + 1}")


def _drive(file: HalFile, name: str) -> None:
    """Connect the objects of one drive to its component."""
    file.net(f"{name}-statusword", f"lcec.0.{name}.cia-statusword", f"cia402.{name}.statusword")
    file.net(f"{name}-opmode-display", f"lcec.0.{name}.opmode-display", f"cia402.{name}.opmode-display")
    file.net(f"{name}-drv-pos", f"lcec.0.{name}.actual-position", f"cia402.{name}.drv-actual-position")
    file.net(f"{name}-drv-vel", f"lcec.0.{name}.actual-velocity", f"cia402.{name}.drv-actual-velocity")
    file.net(f"{name}-controlword", f"cia402.{name}.controlword", f"lcec.0.{name}.cia-controlword")
    file.net(f"{name}-opmode", f"cia402.{name}.opmode", f"lcec.0.{name}.opmode")
    file.net(f"{name}-target-pos", f"cia402.{name}.drv-target-position", f"lcec.0.{name}.target-position")
    file.net(f"{name}-target-vel", f"cia402.{name}.drv-target-velocity", f"lcec.0.{name}.target-velocity")


def _axis(file: HalFile, axis: LatheAxis) -> None:
    board, name = file.lathe.board.axes[axis.name], axis.name.lower()
    place, pin = f"slave {board.channel}", f"cia402.{axis.name.lower()}"
    file.section(f"Axis {axis.name}: slave {board.channel}, cyclic synchronous position")
    file.setp(f"{pin}.csp-mode", 1)
    sign = -1.0 if board.reversed else 1.0
    file.setp(f"{pin}.pos-scale", sign / axis.count, f"increments per {axis.unit}: 1 / count")
    file.setp(
        f"{pin}.auto-fault-reset",
        1,
        "a drive fault is reset when power is requested again with Reset and DRIVES ON",
    )
    _drive(file, name)
    file.positions(axis.name, [f"{pin}.pos-cmd"], [f"{pin}.pos-fb"], place)
    file.role(f"hal.axes.{axis.name}.fault", f"{name}-fault", f"{pin}.drv-fault", place=place)


def _spindle(file: HalFile) -> None:
    board, pin = file.lathe.board.spindle, "cia402.spindle"
    place, sign = f"slave {board.channel}", -1.0 if board.reversed else 1.0
    file.section(f"Spindle: slave {board.channel}, cyclic synchronous velocity")
    file.setp(f"{pin}.csp-mode", 0)
    file.setp(f"{pin}.velo-scale", sign * board.velocity_per_rpm, "value of objects 60FF and 606C at 1 rpm")
    if file.lathe.encoder_lines:
        file.setp(
            f"{pin}.pos-scale",
            sign * 4 * file.lathe.encoder_lines,
            "increments of object 6064 per revolution: 4 x encoder lines",
        )
        further = c_turn_pins(file)
        file.role("hal.spindle.position", "spindle-turns", f"{pin}.pos-fb", *further, place=place)
    _drive(file, "spindle")
    file.setp("spindle-per-s.gain", 1.0 / 60.0)
    file.net("spindle-rpm-fb", f"{pin}.velocity-fb", "spindle-per-s.in")
    file.role("hal.spindle.velocity", "spindle-rps", "spindle-per-s.out", place=place)
    speed, on = c_speed_pins(file, f"{pin}.velocity-cmd", f"{pin}.enable")
    file.role("hal.spindle.speed", "spindle-rpm-cmd", speed, place=place, needed=True)
    file.role("hal.spindle.on", "spindle-on", on, place=place, needed=True)
    file.role("hal.spindle.fault", "spindle-fault", f"{pin}.drv-fault", place=place)


# --- The bus.


def bus_xml(lathe: Lathe) -> str:
    """Return the input of lcec_conf: the drives by their positions on the bus, then the terminals."""
    lines = [
        "<masters>",
        f'  <master idx="0" appTimePeriod="{lathe.period * 1e9:.0f}" refClockSyncCycles="1">',
    ]
    slaves = [(lathe.board.axes[axis.name], axis.name.lower()) for axis in lathe.driven]
    drives = [(board.channel, board.vendor, board.product, name) for board, name in slaves]
    spindle = lathe.board.spindle
    if _turned(lathe):
        drives.append((spindle.channel, spindle.vendor, spindle.product, "spindle"))
    for place, vendor, product, name in sorted(drives):
        lines += _slave(place, vendor, product, name)
    behind = 1 + max(place for place, *_ in drives)
    if _has_terminals(lathe):
        lines += [
            f'    <slave idx="{behind}" type="EK1100" name="coupler"/>',
            f'    <slave idx="{behind + 1}" type="EL1008" name="DI"/>',
            f'    <slave idx="{behind + 2}" type="EL2008" name="DO"/>',
        ]
    return "\n".join((*lines, "  </master>", "</masters>", ""))


def _slave(place: int, vendor: str, product: str, name: str) -> Iterator[str]:
    """Yield the lines of one drive; halPin names the pins that the HAL file connects."""
    ids = f'vid="{int(vendor, 16):08X}" pid="{int(product, 16):08X}"'
    yield f'    <slave idx="{place}" type="generic" {ids} name="{name}" configPdos="true">'
    yield '      <dcConf assignActivate="300" sync0Cycle="*1" sync0Shift="0"/>'
    for number, way, pdo, objects in ((2, "out", "1600", _OUT), (3, "in", "1a00", _IN)):
        yield f'      <syncManager idx="{number}" dir="{way}">'
        yield f'        <pdo idx="{pdo}">'
        for index, bits, pin, kind in objects:
            words = f'idx="{index}" subIdx="00" bitLen="{bits}" halPin="{pin}" halType="{kind}"'
            yield f"          <pdoEntry {words}/>"
        yield "        </pdo>"
        yield "      </syncManager>"
    yield "    </slave>"
