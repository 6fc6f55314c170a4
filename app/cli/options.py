"""The options that every command about a program shares, and what they make of it."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.errors import CommandError

if TYPE_CHECKING:
    from core.interpreter.setup import Setup
    from core.language.source import Source
    from core.machine.model import Machine

DIALECTS = ("omniturn", "klartext", "sinumerik")
_BY_ENDING = {".h": "klartext", ".mpf": "sinumerik", ".spf": "sinumerik"}


def add_program_options(parser: argparse.ArgumentParser) -> None:
    """Machine, dialect, offsets, inputs and switches, as interfaces.md names them."""
    parser.add_argument("--machine", metavar="FILE", help="machine file (default: the shipped simulated lathe)")
    parser.add_argument("--dialect", choices=DIALECTS, help="default: by file ending, else omniturn")
    parser.add_argument("--offsets", metavar="FILE", help="offsets file, instead of the store's offsets")
    parser.add_argument("--inputs", metavar="FILE", help="input states for M91 to M97")
    parser.add_argument("--optional-stop", action="store_true", help="M01 stops")
    parser.add_argument("--block-delete", action="store_true", help="lines that begin with / are skipped")
    parser.add_argument("--strict", action="store_true", help="what the control only tolerates is an error")
    parser.add_argument("--json", action="store_true", help="machine-readable output alone on stdout")


@dataclass(frozen=True, slots=True)
class Circumstances:
    """Machine and setup of one command call, and which tool offsets somebody has entered."""

    machine: Machine
    setup: Setup
    tools_set: frozenset[int]


def dialect_of(path: Path, args: argparse.Namespace) -> str:
    """The dialect that was asked for, or that the file's ending tells.

    Raises CommandError for a dialect that cannot be run yet.
    """
    dialect: str = args.dialect or _BY_ENDING.get(path.suffix.lower(), "omniturn")
    if dialect != "omniturn":
        raise CommandError(f"{path}: {dialect} programs cannot be read yet; only omniturn programs can")
    return dialect


def circumstances(args: argparse.Namespace) -> Circumstances:
    """Read machine, offsets and inputs that the options name; raises CommandError with one sentence."""
    from app.compose import read_machine, setup_for

    machine = read_machine(args.machine)
    tools, secondary = _offsets(args)
    setup = setup_for(
        machine,
        tools=tools,
        secondary=secondary,
        inputs=_inputs(args),
        block_delete=args.block_delete,
        strict=args.strict,
    )
    return Circumstances(machine, setup, frozenset(tools))
