"""``turndesk machine hal``: the HAL file of LinuxCNC from the machine file, and what is wired where."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.program_options import out_file
from app.desk.command_errors import EXIT_OK, EXIT_USAGE, CommandError, cannot_write
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.compose.hal_file import WrittenHal


def add_hal_parser(actions: SubParsers) -> None:
    """``hal`` among the actions of ``machine``."""
    parser = actions.add_parser(
        "hal",
        help="write the HAL file for LinuxCNC and list the required wiring",
        description="Writes the HAL file for the board that [board] in the machine file names: "
        "simulation, parallel port, Mesa 7I76E or 7I97, EtherCAT. The comments at the top of "
        "the file list the wiring and the values to measure.",
    )
    parser.add_argument("file", metavar="FILE", help="machine file with the [hal] and [board] tables")
    parser.add_argument(
        "--out",
        type=out_file,
        metavar="FILE.hal",
        help="output file, which must not exist yet (default: stdout)",
    )
    parser.add_argument("--json", action="store_true", help="print only JSON on stdout")


def write_hal(args: argparse.Namespace) -> int:
    """Writes it: 0 done, 2 a machine file or an output that cannot be used. Raises CommandError."""
    from app.compose.hal_file import written_hal
    from app.compose.machine_setup import read_machine
    from core.table_schema import MachineFileError

    machine = read_machine(args.file)
    try:
        hal = written_hal(machine)
    except MachineFileError as error:
        sys.stderr.write("".join(f"turndesk: {error.source}: {finding}\n" for finding in error.errors))
        return EXIT_USAGE
    if args.out:
        _keep(Path(args.out), hal.text, hal.beside)
    if args.json:
        _report(machine.source, args.out, hal)
    elif args.out:
        sys.stdout.write("".join(f"{line}\n" for line in hal.table))
        sys.stdout.write("".join(f"measure: {note}\n" for note in hal.measure))
    else:
        sys.stdout.write(hal.text)
        sys.stderr.write(
            "".join(
                f"turndesk: {name} must be in the same folder; --out writes both\n" for name in hal.beside
            )
        )
    if args.out and Path(args.out).name != hal.name:
        sys.stderr.write(
            f"turndesk: {machine.source}: [hal] file is {hal.name}, so TurnDesk loads that file\n"
        )
    return EXIT_OK


def _report(source: str, out: str | None, hal: WrittenHal) -> None:
    report = {
        "file": source,
        "board": hal.board,
        "out": out,
        "hal": hal.text,
        "beside": hal.beside,
        "wires": [{**wire._asdict(), "names": list(wire.names)} for wire in hal.wires],
        "measure": hal.measure,
    }
    sys.stdout.write(json.dumps(report) + "\n")


def _keep(out: Path, text: str, beside: Mapping[str, str]) -> None:
    """New files only: all of them, or none."""
    files = {out: text, **{out.parent / name: more for name, more in beside.items()}}
    for path in files:
        if path.exists():
            raise CommandError(
                Message(
                    "{path} already exists and will not be overwritten; use a different name or folder",
                    path=path,
                ),
                "file-exists",
            )
    for path, content in files.items():
        try:
            with path.open("x", encoding="utf-8") as opened:
                opened.write(content)
        except OSError as error:
            raise cannot_write(path, error) from error
