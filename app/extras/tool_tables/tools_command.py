"""Command ``turndesk tools``, which imports tool tables from other programs and exports tools."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from app.cli.change_author import add_author_option, add_confirmation_options
from core.extras.tool_tables.table_file import FORMATS
from core.store.store_rows import OFFSET_NUMBERS

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command and its actions."""
    parser = subparsers.add_parser("tools")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    _add_import(actions)
    _add_export(actions)


def _add_import(actions: SubParsers) -> None:
    """Add the action that imports a tool table."""
    action = actions.add_parser(
        "import", help="show what a tool table of another program would change, and import it"
    )
    action.add_argument("file", metavar="FILE", help="tool table to read")
    action.add_argument(
        "--from",
        dest="format",
        choices=list(FORMATS),
        help="format of the file (default: recognized from the suffix of its name)",
    )
    action.add_argument(
        "--map",
        dest="columns",
        metavar="FIELD=COLUMN",
        action="append",
        default=[],
        help="column of a CSV file for a field, such as x=Dia; several separated by commas, or as several "
        "options",
    )
    action.add_argument(
        "--unit", choices=["in", "mm"], default="", help="unit of a file that does not specify its unit"
    )
    action.add_argument(
        "--x",
        choices=["radius", "diameter"],
        default="",
        help="meaning of X in a CSV file whose headings do not specify it",
    )
    action.add_argument("--only", metavar="TOOLS", default="", help="tools to import, such as 1,3-6")
    action.add_argument(
        "--number",
        type=int,
        metavar="T",
        default=0,
        choices=OFFSET_NUMBERS,
        help="tool number for a file that contains one tool without a number, such as a .fctb file",
    )
    action.add_argument(
        "--no-positions",
        action="store_true",
        help="do not import X and Z, which are only valid if the file comes from this machine",
    )
    action.add_argument(
        "--replace", action="store_true", help="also change tools that already have an offset or a shape"
    )
    action.add_argument(
        "--json", action="store_true", help="print only JSON on stdout; without --yes, nothing is imported"
    )
    add_confirmation_options(action)
    add_author_option(action)
    action.add_argument(
        "--why",
        metavar="TEXT",
        default="",
        help="reason for the change, saved in the history (default: import FILE)",
    )


def _add_export(actions: SubParsers) -> None:
    """Add the action that exports the tools."""
    action = actions.add_parser("export", help="write the tools to a new tool table for another program")
    action.add_argument(
        "file", metavar="FILE", help="tool table to write; an existing file is not overwritten"
    )
    action.add_argument(
        "--to",
        dest="format",
        choices=[word for word, each in FORMATS.items() if each.exported_fields],
        help="format of the file (default: recognized from the suffix of its name)",
    )
    action.add_argument(
        "--map",
        dest="columns",
        metavar="FIELD=COLUMN",
        action="append",
        default=[],
        help="column of a CSV file for a field, such as x=Dia; the file then has only these columns",
    )
    action.add_argument(
        "--unit", choices=["in", "mm"], default="in", help="unit of the lengths in the file (default: in)"
    )
    action.add_argument("--only", metavar="TOOLS", default="", help="tools to export, such as 1,3-6")


def run(args: argparse.Namespace) -> int:
    """Run the action that the user specified.

    Raises CommandError if the action fails.
    """
    if args.action == "export":
        from app.extras.tool_tables.export_command import export_table

        return export_table(args)
    from app.extras.tool_tables.import_command import import_tool_table

    return import_tool_table(args)
