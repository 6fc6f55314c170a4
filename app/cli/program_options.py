"""Options shared by all commands that use a program, and functions that evaluate them."""

from __future__ import annotations

import argparse
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError
from app.desk.standard_input import STDIN_ARGUMENT, read_standard_input
from core.language.source import Dialect, guess_dialect
from core.message import CodedError, Message, get_error_code

if TYPE_CHECKING:
    from core.interpreter.shared.job_setup import InterpreterSetup
    from core.language.source import ProgramSource
    from core.machine.machine_model import Machine

    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]


STDIN_NAME = "stdin"  # name of a program that is read from stdin


def add_program_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for the machine, program language, offsets, inputs and switches."""
    parser.add_argument(
        "--machine", metavar="FILE", help="machine file (default: the shipped simulated lathe)"
    )
    parser.add_argument(
        "--dialect",
        choices=[str(each) for each in Dialect],
        help="program language (default: from the file extension, otherwise omniturn)",
    )
    parser.add_argument("--offsets", metavar="FILE", help="offsets file to use instead of the stored offsets")
    parser.add_argument("--inputs", metavar="FILE", help="file with input states for M91 to M97")
    parser.add_argument("--optional-stop", action="store_true", help="M01 stops")
    parser.add_argument("--block-delete", action="store_true", help="skip lines that begin with /")
    parser.add_argument(
        "--strict", action="store_true", help="report an error for irregular code that the control accepts"
    )
    parser.add_argument("--json", action="store_true", help="print only JSON on stdout")


def add_ideal_times_option(parser: argparse.ArgumentParser) -> None:
    """Add the option --ideal, which calculates times only from feeds and speed limits."""
    parser.add_argument(
        "--ideal", action="store_true", help="calculate times without allowing for acceleration or waiting"
    )


@dataclass(frozen=True, slots=True)
class CommandContext:
    """Machine and setup that one command uses to evaluate programs."""

    machine: Machine
    setup: InterpreterSetup


def read_command_context(args: argparse.Namespace) -> CommandContext:
    """Return the machine and setup that the options specify.

    Raises CommandError if an option is invalid, or if the stored offsets cannot be read.
    """
    from app.compose.machine.machine_setup import read_machine
    from app.compose.stored_offsets import create_setup_with_offsets, make_offsets_reader

    machine = read_machine(args.machine)
    inputs = read_input_states(args.inputs, machine.inputs)
    setup = create_setup_with_offsets(
        machine,
        make_offsets_reader(args.offsets)(),
        input_states=inputs,
        block_delete=args.block_delete,
        is_strict=args.strict,
    )
    return CommandContext(machine, setup)


def read_input_states(path: str | None, known_names: Collection[str] = ()) -> dict[str, bool]:
    """Return the input states from the file ``path``, or {} if ``path`` is None.

    If ``known_names`` is not empty, only these input names are valid. Raises CommandError if the file is
    invalid.
    """
    if path is None:
        return {}
    return read_inputs_file(Path(path), known_names)


def read_source(path: Path, args: argparse.Namespace) -> ProgramSource:
    """Return the program text from ``path``, or from stdin for ``-``, with the programs that it calls.

    Raises CommandError if the text cannot be read, or if --strict or --inputs is used for a program that is
    not in the OmniTurn language.
    """
    from core.language.source import SourceError, decode_source, load_source

    dialect = Dialect(args.dialect) if args.dialect else guess_dialect(path.name)
    for option, template in (
        (
            "strict",
            "{path}: --strict is only for OmniTurn programs; {dialect} programs do not contain irregular "
            "lines that the control accepts",
        ),
        (
            "inputs",
            "{path}: --inputs is only for OmniTurn programs; {dialect} programs do not read input states",
        ),
    ):
        if getattr(args, option) and dialect is not Dialect.OMNITURN:
            raise CommandError(
                Message(template, path=path, dialect=dialect),
                "omniturn-only",
            )
    try:
        source = (
            decode_source(STDIN_NAME, read_standard_input("program"), dialect)
            if path == Path(STDIN_ARGUMENT)
            else load_source(path, dialect)
        )
    except SourceError as error:
        # The screen shows only the name of a program. A script that proves many programs also needs the
        # folder.
        raise CommandError(str(error).replace(path.name, str(path), 1), get_error_code(error)) from error
    from core.language.called_files import load_called_files

    return load_called_files(source, [path.parent])


def parse_output_path(text: str) -> str | None:
    """Return the path of the output file, or None for ``-``, which means stdout."""
    return None if text == STDIN_ARGUMENT else text


def read_inputs_file(path: Path, known_names: Collection[str] = ()) -> dict[str, bool]:
    """Return input states by name. If ``known_names`` is not empty, other names are errors.

    The file has a table [inputs] with ``10 = true`` for PLC input 10 and ``"TB2-5" = false`` for a
    terminal. M95 reads terminal TB2-9, which the control calls input 7. The state of ``7`` is therefore
    also used for TB2-9 if the file does not contain TB2-9. Raises CommandError, which lists every error, if
    the file is invalid.
    """
    from app.desk.toml_file import make_unknown_key_error, raise_mistakes, read_toml

    data = read_toml(path)
    mistakes = [make_unknown_key_error(key, ("inputs",)) for key in data if key != "inputs"]
    table = data.get("inputs")
    if not isinstance(table, dict):
        raise_mistakes(path, [*mistakes, CodedError("the table [inputs] is missing", "no-table")])
        return {}
    mistakes += [
        CodedError(Message("inputs.{name} must be true (closed) or false (open)", name=name), "wrong-type")
        for name, state in table.items()
        if not isinstance(state, bool)
    ]
    mistakes += [
        make_unknown_key_error(name, known_names, "inputs")
        for name in table
        if known_names and name not in known_names
    ]
    raise_mistakes(path, mistakes)
    also = "7" in table and (not known_names or "TB2-9" in known_names)
    return {"TB2-9": table["7"], **table} if also else dict(table)
