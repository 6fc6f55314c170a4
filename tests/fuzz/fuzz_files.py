"""Every kind of file that comes from outside, as targets: what reads it, good samples, and its own damage."""

from __future__ import annotations

import io
import json
import random
import struct
import zipfile
from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator
from contextlib import redirect_stdout
from hashlib import sha256
from pathlib import Path

import canopen
import numpy as np

import resources
from app.cli import scope_command
from app.cli.program_options import read_inputs_file
from app.compose.machine.machine_files import load_shipped_machine, parse_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.machine.setup_archive import ARCHIVE_FORMAT, MANIFEST
from app.compose.machine.setup_file import check_setup
from app.desk.command_errors import CommandError
from app.offsets.offsets_file import read_offset_rows, read_tool_shapes
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import Dialect, SourceError, decode_source
from core.machine.machine_file import read_machine_text
from core.part.stock_spec import StockError, parse_stock_profile
from core.ports import DriverError
from core.proving.prove_program import prove
from core.records.record_file import save_record
from core.records.record_ring import RingLayout, ScopeRing
from core.records.ring_file import RingFile
from core.table_schema import MachineFileError
from drivers.canopen.canopen_objects import build_drive_dictionary, load_object_dictionary
from drivers.canopen.drive_profiles import PROFILES
from tests.extras.modules import of_extras
from tests.fuzz.damage import EDITS, in_archive
from tests.fuzz.fuzz_stores import STORE, good_store
from tests.fuzz.fuzz_target import Target, scratch
from tests.interpreter.mutation import mutated
from tests.records.test_record_file import record

# --- programs ---------------------------------------------------------------------------------------------

_TOOLS = {n: ToolOffset() for n in range(1, 9)}
_SECONDARY = {1: SecondaryOffset(-0.381, -0.381, 0.381), 3: SecondaryOffset(nose_radius=0.2)}
_PROGRAMS = {
    Dialect.OMNITURN: ("gt75", "fuzz.nc"),
    Dialect.KLARTEXT: ("ac-table-mill", "fuzz.h"),
    Dialect.SINUMERIK: ("sinumerik-modulo", "fuzz.mpf"),
}


def _language(dialect: Dialect) -> Target:
    machine_name, name = _PROGRAMS[dialect]

    def run(data: bytes) -> Iterator[str]:
        machine = load_shipped_machine(machine_name)
        setup = create_power_up_setup(machine, tool_offsets=_TOOLS, secondary_offsets=_SECONDARY)
        report = prove(decode_source(name, data), setup, machine)
        for each in report.diagnostics:
            yield each.format_one_line(name)

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
    parse_machine(read_machine_text(_file("fuzz.toml", data)), "fuzz.toml")
    return ()


def _machine_files() -> Iterator[bytes]:
    for name in resources.list_machine_names():
        yield resources.read_machine_file(f"{name}.toml").encode()


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


# --- what a person writes as TOML, and the points of a blank -----------------------------------------------

_OFFSETS = b"""[tool.1]
x = 1.25
z = -.5
master = true
nose_radius = .0315
tip = 3
kind = "turning"
hand = "right"
insert = "CNMG432"
[tool.2]
x = 1
z = 0
[tool.2.d2]
x = 1
z = 1
[secondary.3]
x = -0.01
[zero.54]
z = 12.5
"""
_INPUTS = b'[inputs]\n10 = true\n"TB2-5" = false\n7 = true\n'
_PROFILE = b"z, r, bore\n# a casting\n-40, 12.5, 3\n-10.5, 12.5, 3\n0, 8, 3\n"


def _toml(read: Callable[[Path], object]) -> Callable[[bytes], Iterable[str]]:
    def run(data: bytes) -> Iterable[str]:
        read(_file("fuzz.toml", data))
        return ()

    return run


def _file(name: str, data: bytes) -> Path:
    path = scratch() / name
    path.write_bytes(data)
    return path


def _profile_stock(data: bytes) -> Iterable[str]:
    parse_stock_profile("fuzz", data.decode("utf-8", "replace"), 1.0, 0.0)
    return ()


# --- records of the scope ---------------------------------------------------------------------------------


def _record_of(name: str) -> Callable[[bytes], Iterable[str]]:
    def run(data: bytes) -> Iterable[str]:
        """Opened, listed and exported by the command."""
        path = _file(name, data)
        for csv, as_json in ((None, False), ("-", False), (str(path.with_suffix(".csv")), True)):
            with redirect_stdout(io.StringIO()) as out:
                scope_command.run(Namespace(file=str(path), csv=csv, json=as_json))
            if as_json:
                json.loads(out.getvalue(), parse_constant=_no_json)
        return ()

    return run


def _no_json(word: str) -> object:
    raise AssertionError(f"{word} is no JSON")


def _records() -> Iterator[bytes]:
    path = scratch() / "good.scope"
    save_record(record(), path)
    yield path.read_bytes()


def _rings() -> Iterator[bytes]:
    path = scratch() / "good.ring"
    recorded = RingLayout(
        {"X": False, "C": True}, ("estop",), ("coolant",), 100.0, 1e6, "LATHE", duration_s=0.5
    )
    ring = ScopeRing.from_layout(recorded)
    file = RingFile(path, ring)
    rows = np.linspace(0.0, 0.2, 20)[:, None] * np.ones(recorded.sample_width)
    file.write_rows(ring.samples, ring.samples.append_rows(rows))
    ticks = np.linspace(0.0, 0.2, 10)[:, None] * np.ones(recorded.tick_width)
    file.write_rows(ring.ticks, ring.ticks.append_rows(ticks))
    file.close()
    yield path.read_bytes()


_RING = struct.Struct("<14sHII")


def _in_head(data: bytes, chance: random.Random) -> bytes:
    """The description of a ring is damaged, and its length is right."""
    if len(data) < _RING.size:
        return data
    magic, version, length, head = _RING.unpack_from(data)
    text = chance.choice(EDITS)(data[_RING.size : _RING.size + length], chance)
    if chance.randrange(4) == 0:
        length, head = chance.choice((0, 2**32 - 1, length)), chance.choice((0, 2**32 - 1, head))
    else:
        length = len(text)
    start = _RING.pack(magic, version, length, head) + text
    return start + bytes(max(0, min(head, 1 << 16) - len(start))) + data[head:]


# --- a setup, and the dictionary of a drive ---------------------------------------------------------------


def _setup(data: bytes) -> Iterable[str]:
    check_setup(_file("fuzz.setup", data))
    return ()


def _setups() -> Iterator[bytes]:
    path = scratch() / "good.setup"
    members = {"store.db": good_store(), "programs/part.nc": b"G90\nM30\n", "machine/mine.toml": _OWN_MACHINE}
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in {**members, MANIFEST: _manifest(members)}.items():
            archive.writestr(name, content)
    yield path.read_bytes()


_OWN_MACHINE = resources.read_machine_file("gt75.toml").encode()


def _manifest(members: dict[str, bytes]) -> bytes:
    hashes = {name: sha256(content).hexdigest() for name, content in members.items()}
    return json.dumps({"format": ARCHIVE_FORMAT, "made": "2026-01-01T00:00:00", "sha256": hashes}).encode()


def _sealed(data: bytes, chance: random.Random) -> bytes:
    """A member is damaged, and the manifest has its new hash, mostly."""
    data = in_archive(data, chance)
    if chance.randrange(4) == 0:
        return data
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist() if name != MANIFEST}
    except Exception:  # noqa: BLE001 - it was damaged before
        return data
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, content in {**members, MANIFEST: _manifest(members)}.items():
            archive.writestr(name, content)
    return out.getvalue()


def _dictionary(data: bytes) -> Iterable[str]:
    load_object_dictionary("X", str(_file("fuzz.eds", data)), canopen.ObjectDictionary)
    return ()


def _dictionaries() -> Iterator[bytes]:
    path = scratch() / "good.eds"
    canopen.export_od(build_drive_dictionary(PROFILES["epos2"]), str(path), "eds")
    yield path.read_bytes()[:6000]


FILES: tuple[Target, ...] = (
    *(_language(each) for each in Dialect),
    Target("machine file", _machine_files, _machine, (MachineFileError,), _other_value),
    Target("offsets file", lambda: (_OFFSETS,), _toml(read_offset_rows), (CommandError,), _other_value),
    Target("tools file", lambda: (_OFFSETS,), _toml(read_tool_shapes), (CommandError,), _other_value),
    Target("inputs file", lambda: (_INPUTS,), _toml(read_inputs_file), (CommandError,), _other_value),
    Target("profile of a blank", lambda: (_PROFILE,), _profile_stock, (StockError,)),
    Target("record", _records, _record_of("fuzz.scope"), (CommandError,), in_archive),
    Target("ring", _rings, _record_of("fuzz.ring"), (CommandError,), _in_head),
    Target("setup archive", _setups, _setup, (CommandError,), _sealed),
    Target("EDS file", _dictionaries, _dictionary, (DriverError,)),
    STORE,
    *(target for each in of_extras("fuzz_files") for target in each.TARGETS),
)
