"""The command ``turndesk expand FILE``, which prints the elementary blocks that the control would execute."""

from __future__ import annotations

import argparse
import importlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from app.cli.program_options import (
    add_ideal_times_option,
    add_program_options,
    read_command_context,
    read_source,
)
from app.cli.proofs.progress_bar import ProgressBar
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.language.source import ProgramSource
    from core.proving.program_timeline import Timeline


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``expand``."""
    parser = subparsers.add_parser("expand")
    parser.add_argument("file", metavar="FILE")
    add_program_options(parser)
    add_ideal_times_option(parser)


def run(args: argparse.Namespace) -> int:
    """Print the blocks in the order of execution, and return 1 if the program has errors.

    Diagnostics are printed on stderr.
    """
    from core.proving.program_timeline import Timeline

    path = Path(args.file)
    around = read_command_context(args)
    source = read_source(path, args)
    timeline = Timeline.from_program(source, around.setup, around.machine, is_ideal=args.ideal)
    output_module = importlib.import_module(f"app.cli.outputs.{source.dialect}_output")
    if not args.json:
        sys.stdout.write(output_module.TABLE_HEAD)
    with ProgressBar(f"expanding {path.name}", len(source.lines)) as progress:
        for last, text in _block_texts(timeline, source, output_module, json_output=args.json):
            sys.stdout.write(text)
            progress.report_progress(last)
    return print_diagnostics(path, timeline)


def _block_texts(
    timeline: Timeline, source: ProgramSource, output_module: ModuleType, *, json_output: bool
) -> Iterator[tuple[int, str]]:
    """For each single block or series of moves, yield the number of its last block and its text."""
    from core.interpreter.shared.elementary_blocks import TimedSeries
    from core.proving.program_timeline import iter_timed_series

    for each in iter_timed_series(timeline):
        if isinstance(each, TimedSeries):
            text = output_module.make_series_json(each) if json_output else output_module.format_series(each)
            yield int(each.series.n[-1]), text
            continue
        block, t0, t1 = each
        result = (
            output_module.make_block_json(block, source.lines[block.line - 1], t0, t1)
            if json_output
            else None
        )
        yield block.n, output_module.format_row(block, t0) if result is None else json.dumps(result) + "\n"


def print_diagnostics(path: Path, timeline: Timeline) -> int:
    """Print the findings on stderr, one per line, and return the exit status."""
    findings = timeline.diagnostics
    sys.stderr.write("".join(f"{d.format_one_line(str(path))}\n" for d in findings))
    return EXIT_ERRORS if any(d.severity == "error" for d in findings) else EXIT_OK
