"""Everything that comes from outside: programs, machine files, bytes, frames, lines, stores, drawings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from core.ports import DriverError
from drivers.grblhal.grblhal_report import parse_identity, parse_report
from drivers.inverter.modbus_rtu import find_response
from drivers.serial_line import LineSettings
from drivers.transfer.program_framing import ProgramParser, ReceptionPhase, TransferSettings, encode_program
from tests.extras.modules import of_extras
from tests.fuzz.fuzz_files import FILES
from tests.fuzz.fuzz_target import Target
from tests.fuzz.fuzz_wires import CAN, GRBLHAL

# --- serial bytes -----------------------------------------------------------------------------------------


def _transfer(data: bytes) -> Iterator[str]:
    """The first byte says how the line is set; the others come in, in pieces."""
    how, rest = (data[0], data[1:]) if data else (0, b"")
    line = LineSettings("fuzz", 9600, 7 if how & 1 else 8, "E" if how & 1 else "N", 1, "none")
    settings = TransferSettings(line, delimiter="" if how & 2 else "%", has_dc_codes=bool(how & 4))
    incoming, size = ProgramParser(settings), 1 + (how >> 4)
    for at in range(0, len(rest), size):
        incoming.add_characters(rest[at : at + size])
    incoming.handle_silence()
    assert incoming.phase is ReceptionPhase.COMPLETE
    whole = incoming.build_program()
    encode_program(whole.program_bytes, settings)
    yield whole.program_name or "no name"
    find_response(rest, 1, 3)


def _lines(data: bytes) -> Iterable[str]:
    """What a controller may say at start: its identity, its reports."""
    lines = data.decode("ascii", "replace").split("\n")
    for line in lines:
        parse_report(line)
    parse_identity(lines)
    return ()


TARGETS: tuple[Target, ...] = (
    *FILES,
    Target(
        "serial transfer",
        lambda: (
            b"\x00%\r\nG90X1\r\nM30\r\n%\r\n",
            b"\x01\xa5\r\n",
            b"\x02G90\nM30\n\x04",
            b"\x14%PART\n(X)\n%\n",
        ),
        _transfer,
        (DriverError,),
    ),
    Target(
        "controller's lines",
        lambda: (
            b"[VER:1.1f.20240101:]\n[OPT:VNMSL,35,1024,3,0]\n[AXS:3:XYZ]\n[NEWOPT:LATHE,ENUMS]\n[AUX IO:4,4]",
            b"<Idle|MPos:0.000,0.000,0.000|Bf:35,1024|FS:0,0,0|WCO:0,0,0|Ov:100,100,100|H:1,7|Pn:XZ|In:-1|D:1>",
        ),
        _lines,
        (DriverError,),
    ),
    *(target for each in of_extras("fuzz_targets") for target in each.TARGETS),
    GRBLHAL,
    CAN,
)
