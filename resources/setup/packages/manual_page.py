"""Manual page ``turndesk(1)``, which is generated from the command-line parser."""

from __future__ import annotations

import argparse
import re
import time
from collections.abc import Iterator

from app import VERSION
from app.cli.main import build_parser
from resources.setup.packages.reproducible_archives import get_release_time


def format_manual_page() -> str:
    """Return the manual page in the format of ``man``."""
    parser = build_parser()
    day = time.strftime("%Y-%m-%d", time.gmtime(get_release_time()))
    return "\n".join(
        [
            f'.TH TURNDESK 1 "{day}" "turndesk {VERSION}" "User Commands"',
            ".SH NAME",
            r"turndesk \- operator screen and motion control for OmniTurn-style CNC lathes",
            ".SH SYNOPSIS",
            r".B turndesk",
            r"[\fIOPTION\fR]... [\fICOMMAND\fR [\fIARGUMENT\fR]...]",
            ".SH DESCRIPTION",
            escape_text(parser.description or ""),
            r"TurnDesk has not yet driven a real machine.",
            ".SH OPTIONS",
            *_options(parser),
            ".SH COMMANDS",
            *_commands(parser, "turndesk"),
            ".SH EXIT STATUS",
            "0 if successful, 1 if the program has errors, 2 for a usage error.",
            ".SH ENVIRONMENT",
            ".TP",
            r"\fBTURNDESK_HOME\fR",
            "folder of the store, logs and settings",
            ".SH FILES",
            ".TP",
            r"\fI~/.local/share/turndesk\fR",
            "the data folder, if TURNDESK_HOME is not set; it remains when TurnDesk is removed",
            "",
        ]
    )


def _commands(parser: argparse.ArgumentParser, name: str) -> Iterator[str]:
    """Yield the commands of a parser, including subcommands."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            helps = {each.dest: each.help or "" for each in action._choices_actions}
            for word, below in action.choices.items():
                yield f".SS {escape_text(f'{name} {word}')}"
                yield escape_text(helps.get(word, ""))
                yield from _options(below)
                yield from _commands(below, f"{name} {word}")


def _options(parser: argparse.ArgumentParser) -> Iterator[str]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction) or action.help == argparse.SUPPRESS:
            continue
        value = "" if action.nargs == 0 else _value_of(action)
        names = ", ".join(rf"\fB{escape_text(each)}\fR" for each in action.option_strings)
        yield ".TP"
        yield f"{names} {value}".strip()
        yield escape_text((action.help or "").replace("%(default)s", str(action.default)).replace("%%", "%"))


def _value_of(action: argparse.Action) -> str:
    name = action.metavar if isinstance(action.metavar, str) else action.dest.upper()
    if action.choices and not isinstance(action.metavar, str):
        name = "|".join(map(str, action.choices))
    return rf"\fI{escape_text(name)}\fR"


def escape_text(text: str) -> str:
    """Return the text with all commands and special characters of ``man`` escaped."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    return re.sub(r"^(?=[.'])", r"\\&", text)
