"""Everything that comes from outside: programs, machine files, bytes, frames, lines, stores, drawings."""

from __future__ import annotations

import random
import socket
import tempfile
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import import_module
from itertools import islice
from pathlib import Path

import resources
from app.compose.machine_drivers import read_machine_file
from app.compose.machine_files import shipped_machine
from app.compose.machine_setup import setup_for
from core.drawings.drawing import DrawingError
from core.drawings.drawing_file import read_drawing
from core.drawings.drawing_view import Side, View, axis_named, contours, profile
from core.drawings.turning_contour import Reach, turning_contour
from core.interpreter.job_setup import SecondaryOffset, ToolOffset
from core.language.source import Dialect, SourceError, source_of
from core.ports import DriverError
from core.proving.prove_program import prove
from core.table_schema import MachineFileError
from drivers.grblhal.grblhal_report import read_identity, read_report
from drivers.inverter.modbus_rtu import answer_in
from drivers.mtconnect.agent_links import AgentLink, LostError
from drivers.mtconnect.mtconnect_items import Category, DataItem
from drivers.mtconnect.shdr_lines import Active, clean, text_of, values_line
from drivers.serial_line import LineSettings
from drivers.transfer.program_framing import Incoming, Phase, outgoing
from drivers.transfer.transfer_settings import TransferSettings
from tests.fuzz.fuzz_stores import STORE
from tests.fuzz.fuzz_target import Target
from tests.fuzz.fuzz_wires import CAN, GRBLHAL
from tests.interpreter.mutation import mutated

# --- programs ---------------------------------------------------------------------------------------------

_TOOLS = {n: ToolOffset() for n in range(1, 9)}
_SECONDARY = {1: SecondaryOffset(-0.381, -0.381, 0.381), 3: SecondaryOffset(r=0.2)}
_PROGRAMS = {
    Dialect.OMNITURN: ("gt75", "fuzz.nc"),
    Dialect.KLARTEXT: ("ac-table-mill", "fuzz.h"),
    Dialect.SINUMERIK: ("sinumerik-modulo", "fuzz.mpf"),
}


def _language(dialect: Dialect) -> Target:
    machine_name, name = _PROGRAMS[dialect]

    def run(data: bytes) -> Iterator[str]:
        machine = shipped_machine(machine_name)
        setup = setup_for(machine, tools=_TOOLS, secondary=_SECONDARY)
        report = prove(source_of(name, data), setup, machine)
        for each in report.diagnostics:
            yield each.in_one_line(name)

    def change(data: bytes, chance: random.Random) -> bytes:
        """Lines of another program of the book between those of this one."""
        lines, more = data.split(b"\n"), mutated(chance, dialect).encode("utf-8", "replace").split(b"\n")
        at, begin = chance.randrange(len(lines) + 1), chance.randrange(len(more))
        return b"\n".join([*lines[:at], *more[begin : begin + chance.randrange(1, 6)], *lines[at:]])

    def seeds() -> Iterator[bytes]:
        for number in range(200):
            yield mutated(random.Random(number), dialect).encode("utf-8", "replace")

    return Target(str(dialect), seeds, run, (SourceError,), change)


# --- the machine file -------------------------------------------------------------------------------------

_VALUES = ("0", "-1", "1e308", "nan", "inf", "true", '""', '"x"', "[]", "[1, 2]", "{}", "1e-300", "9" * 40)


def _machine(data: bytes) -> Iterable[str]:
    read_machine_file(data.decode("utf-8", "replace"), "fuzz.toml")
    return ()


def _machine_files() -> Iterator[bytes]:
    for name in resources.machine_names():
        yield resources.machine_file(f"{name}.toml").encode()


def _other_value(data: bytes, chance: random.Random) -> bytes:
    """A value of a line for another, a line twice, gone, or in another place."""
    lines = data.split(b"\n")
    at = chance.randrange(len(lines))
    key, equal, _value = lines[at].partition(b"=")
    what = chance.randrange(4)
    if what == 0 and equal:
        lines[at] = key + b"= " + chance.choice(_VALUES).encode()
    elif what == 1:
        lines.insert(chance.randrange(len(lines)), lines[at])
    elif what == 2:
        del lines[at]
    else:
        lines[at], lines[-at - 1] = lines[-at - 1], lines[at]
    return b"\n".join(lines)


# --- serial bytes -----------------------------------------------------------------------------------------


def _transfer(data: bytes) -> Iterator[str]:
    """The first byte says how the line is set; the others come in, in pieces."""
    how, rest = (data[0], data[1:]) if data else (0, b"")
    line = LineSettings("fuzz", 9600, 7 if how & 1 else 8, "E" if how & 1 else "N", 1, "none")
    settings = TransferSettings(line, wrap="" if how & 2 else "%", dc_codes=bool(how & 4))
    incoming, size = Incoming(settings), 1 + (how >> 4)
    for at in range(0, len(rest), size):
        incoming.feed(rest[at : at + size])
    incoming.silence()
    assert incoming.phase is Phase.WHOLE
    whole = incoming.program()
    outgoing(whole.text, settings)
    yield whole.name or "no name"
    answer_in(rest, 1, 3)


def _lines(data: bytes) -> Iterable[str]:
    """What a controller may say at start: its identity, its reports."""
    lines = data.decode("ascii", "replace").split("\n")
    for line in lines:
        read_report(line)
    read_identity(lines)
    return ()


# --- lines of SHDR ----------------------------------------------------------------------------------------

_ITEM = DataItem("block", Category.EVENT, "BLOCK")


def _shdr(data: bytes) -> Iterable[str]:
    """Texts of programs and alarms go out as values; bytes of an agent come in."""
    texts = data.decode("utf-8", "surrogateescape").split("\0")
    for text in texts:
        line = values_line("t", {"block": text_of(_ITEM, text), "program": clean(text)})
        if line.count("\n") != 1 or line.count("|") != 4 or "--multiline--" in line:
            raise AssertionError(f"two values have not stayed two: {line!r}")
        line.encode("utf-8")
        clean(Active("FAULT", text, text).text)
    ours, theirs = socket.socketpair()
    with ours, theirs:
        ours.setblocking(False)
        link = AgentLink(ours, 10.0)
        for at in range(0, len(data), 1000):
            theirs.sendall(data[at : at + 1000])
            link.read(float(at))
            link.mind(float(at))
    return ()


# --- drawings ---------------------------------------------------------------------------------------------


@cache
def _scratch() -> Path:
    fast = Path("/dev/shm")
    return Path(tempfile.mkdtemp(prefix="fuzz-", dir=fast if fast.is_dir() else None))


def _drawing(ending: str) -> Target:
    import_module(
        f"core.drawings.{ending[1:]}_reader"
    )  # now, while what is loaded is made to tell its branches

    def run(data: bytes) -> Iterable[str]:
        path = _scratch() / f"fuzz{ending}"
        path.write_bytes(data)
        drawing = read_drawing(path)
        view = View(axis_named(drawing, ""), drawing.unit or 1.0)
        for net in islice(contours(drawing, view), 4):
            turning_contour(profile(drawing, view, net, Side.OUTSIDE), Reach())
        return ()

    def pairs(data: bytes, chance: random.Random) -> bytes:
        """A pair of lines, a code and its value, twice, gone or with another value."""
        lines = data.split(b"\n")
        at = chance.randrange(max(1, len(lines) // 2)) * 2
        what = chance.randrange(3)
        if what == 0:
            del lines[at : at + 2]
        elif what == 1:
            lines[at:at] = lines[at : at + 2 * chance.randrange(1, 8)]
        elif at + 1 < len(lines):
            lines[at + 1] = chance.choice((b"0", b"-1", b"1e308", b"nan", b"x", b"", b"9" * 30))
        return b"\n".join(lines)

    return Target(f"drawing{ending}", lambda: _drawings(ending), run, (DrawingError,), pairs)


_PLAIN_DXF = b"""0
SECTION
2
ENTITIES
0
LINE
8
PART
10
0
20
0
11
0
21
5
0
ARC
8
PART
10
-5
20
5
40
5
50
0
51
90
0
LINE
8
PART
10
-5
20
10
11
-20
21
10
0
ENDSEC
0
EOF
"""


def _drawings(ending: str) -> Iterator[bytes]:
    if ending == ".svg":
        yield (
            b'<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm" viewBox="0 0 40 20">'
            b'<path d="M0 0 L0 5 A5 5 0 0 0 5 10 h10 l5 4 v6 H40 V0"/>'
            b'<rect x="1" y="1" width="4" height="2"/>'
            b'<g transform="rotate(90) scale(2)"><circle cx="4" cy="4" r="2"/></g></svg>'
        )
        return
    yield _PLAIN_DXF
    from tests.drawings.hand import chain, dxf  # noqa: PLC0415  it needs the library of drawings

    for points in (
        ((0, 0), (0, 5), (-10, 5, 0.4), (-10, 8), (-30, 8), (-30, 0)),
        ((0, 0, 0), (0, 5, 0), (-10, 5, 0), (-12, 4, -0.2), (-20, 9, 0)),
    ):
        yield dxf(_scratch() / "seed.dxf", chain(*points)).read_bytes()


TARGETS = (
    *(_language(each) for each in Dialect),
    Target("machine file", _machine_files, _machine, (MachineFileError,), _other_value),
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
    Target(
        "SHDR lines", lambda: (b"* PING\n", b'G90 X1|2\0"x"\0--multiline--\0\xff\xfe'), _shdr, (LostError,)
    ),
    GRBLHAL,
    CAN,
    STORE,
    _drawing(".dxf"),
    _drawing(".svg"),
)
