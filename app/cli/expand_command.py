"""``turndesk expand FILE``: the elementary blocks that the control would execute."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.command_errors import EXIT_ERRORS, EXIT_OK
from app.cli.program_options import add_ideal_option, add_program_options, circumstances, read_source
from app.cli.progress_bar import Progress
from core.language.source import Dialect

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.interpreter.elementary_blocks import Block
    from core.proving.program_timeline import Timeline

_HEAD = "    n  line  kind        X radius          Z         feed      rpm       t  block\n"


def add_parser(subparsers: SubParsers) -> None:
    """Declare the command."""
    parser = subparsers.add_parser("expand", help="show the elementary blocks that would be executed")
    parser.add_argument("file", metavar="FILE")
    add_program_options(parser)
    add_ideal_option(parser)


def run(args: argparse.Namespace) -> int:
    """Write the blocks in the order of execution; diagnostics go to stderr, 1 when there are errors."""
    from core.proving.program_timeline import Timeline, timed_blocks

    path = Path(args.file)
    around = circumstances(args)
    source = read_source(path, args)
    timeline = Timeline.of(source, around.setup, around.machine, ideal=args.ideal)
    block_json = _json_of(source.dialect)
    head, row = _table_of(source.dialect)
    if not args.json:
        sys.stdout.write(head)
    with Progress(f"expanding {path.name}") as progress:
        for block, t0, t1 in timed_blocks(timeline):
            if args.json:
                text = json.dumps(block_json(block, source.lines[block.line - 1], t0, t1)) + "\n"
            else:
                text = row(block, t0)
            sys.stdout.write(text)
            progress.reach(block.n)
    return report_diagnostics(path, timeline)


def _json_of(dialect: Dialect) -> Callable[[Block, str, float, float], dict[str, object]]:
    """What makes a block's object: OmniTurn counts in inches, the others in mm."""
    if dialect is Dialect.SINUMERIK:
        from app.cli import sinumerik_figures

        return sinumerik_figures.block_json
    if dialect is Dialect.KLARTEXT:
        from app.cli import klartext_figures

        return klartext_figures.block_json
    from app.cli import omniturn_figures

    return omniturn_figures.block_json


def _table_of(dialect: Dialect) -> tuple[str, Callable[[Block, float], str]]:
    """Head and rows of the table for a person: a mill has more axes."""
    if dialect is Dialect.KLARTEXT:
        from app.cli import klartext_figures

        return klartext_figures.HEAD, klartext_figures.row
    if dialect is Dialect.SINUMERIK:
        from app.cli import sinumerik_figures

        return sinumerik_figures.HEAD, sinumerik_figures.row
    return _HEAD, _row


def report_diagnostics(path: Path, timeline: Timeline) -> int:
    """Write the findings to stderr, a line each; the exit status they make."""
    findings = timeline.diagnostics
    sys.stderr.write("".join(f"{d.shown(str(path))}\n" for d in findings))
    return EXIT_ERRORS if any(d.severity == "error" for d in findings) else EXIT_OK


def _row(block: Block, t0: float) -> str:
    from app.cli.figures import inches, per_minute

    feed = f"{inches(block.feed):.5f}/r" if block.per_rev else f"{per_minute(block.feed):.2f}/m"
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:10s}{inches(block.x):11.5f}{inches(block.z):11.5f}"
        f"{feed:>13s}{block.rpm:9.0f}{t0:8.2f}  {block.text}\n"
    )
