"""Argument parser of ``turndesk``. It rejects repeated and abbreviated options.

The parser accepts an option only if the command uses it. Screen options may be written ahead of a command,
as in ``turndesk --machine FILE prove …``. They then have the same effect as after the command, or are
rejected if the command does not have the option.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from typing import Any, NoReturn

from app.desk.command_errors import EXIT_USAGE, CommandError
from core.message import Message, find_similar_word

# The texts are English. For each of them, argparse would search the system for catalogs of translations.
# argparse also passes None for a missing text, which must remain None.
argparse._ = lambda text: text  # type: ignore[attr-defined]

_DEFAULT_WIDTH = 80  # characters
PRE_COMMAND_OPTIONS = ("machine", "program", "offsets")
"""Names of the options for the operator screen."""
OPTIONS_WITH_VALUE = frozenset(f"--{name}" for name in PRE_COMMAND_OPTIONS)
FLAG_OPTIONS = frozenset({"--version", "--demo", "--kiosk", "--help", "-h"})

_REPLACEMENTS: Mapping[str, str] = {
    "program": "write the program name after the command, without --program",
    "machine": "in turndesk machine commands, write the file name without --machine",
}


class _StoreOnce(argparse.Action):
    """Argparse action that stores the value of an option and rejects a second use of the option."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        if option_string is not None:
            given: frozenset[str] = getattr(namespace, "given", frozenset())
            if self.dest in given:
                parser.error(
                    Message("{option_string} is specified twice; remove one", option_string=option_string)
                )
            namespace.given = given | {self.dest}
        setattr(namespace, self.dest, values)


class SubcommandsAction(argparse._SubParsersAction):  # type: ignore[type-arg]
    """Argparse action for subcommands that takes missing help texts by name from ``help_texts``."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.help_texts: dict[str, str] = {}

    def add_parser(self, name: str, **kwargs: Any) -> Any:
        """Return a new subparser for the command ``name``."""
        if name in self.help_texts:
            kwargs.setdefault("help", self.help_texts[name])
        return super().add_parser(name, **kwargs)


class HelpFormatter(argparse.HelpFormatter):
    """Help formatter that uses the terminal width and avoids importing Python's archive modules."""

    def __init__(self, prog: str, *args: Any, **kwargs: Any) -> None:
        super().__init__(prog, *args, **{"width": _terminal_width() - 2, **kwargs})


def _terminal_width() -> int:
    """Return the width of the terminal in columns, as ``shutil.get_terminal_size`` would."""
    words = os.environ.get("COLUMNS", "")
    columns = int(words) if words.isdecimal() else 0
    if columns <= 0 and sys.__stdout__ is not None:
        with suppress(ValueError, OSError):
            columns = os.get_terminal_size(sys.__stdout__.fileno()).columns
    return columns or _DEFAULT_WIDTH


class CommandParser(argparse.ArgumentParser):
    """Argument parser that reports errors in one line and rejects repeated and abbreviated options."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **{"allow_abbrev": False, "formatter_class": HelpFormatter, **kwargs})
        self.register("action", None, _StoreOnce)
        self.register("action", "store", _StoreOnce)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Report an invalid command, action or choice, and name the most similar valid one."""
        if action.choices is not None and value not in action.choices:
            if isinstance(action, argparse._SubParsersAction) and os.path.isfile(str(value)):
                self.error(
                    Message(
                        "{value}: the screen opens one program; to prove several, use: turndesk prove FILE…",
                        value=value,
                    )
                )
            if isinstance(action, argparse._SubParsersAction) and os.path.splitext(str(value))[1]:
                self.error(Message("{value}: neither a file nor a command has this name", value=value))
            near = find_similar_word(str(value), map(str, action.choices))
            if near:
                raise argparse.ArgumentError(
                    action,
                    Message(
                        "invalid choice: {value}; did you mean {nearest}?", value=f"{value!r}", nearest=near
                    ),
                )
        super()._check_value(action, value)

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the arguments as argparse does, but name the most similar option if an option is unknown."""
        self._check_first_options(sys.argv[1:] if args is None else args)
        found, rest = self.parse_known_args(args, namespace)
        if rest:
            name = rest[0].partition("=")[0]
            self._raise_unknown(" ".join(rest), name, Message("this command has no option {name}", name=name))
        return found

    def _check_first_options(self, args: Sequence[str]) -> None:
        """Check the options before the command.

        Without this check, argparse would report the word after an unknown option as an invalid command.
        """
        known, words = self._option_string_actions, iter(args)
        for word in words:
            name, _, value = word.partition("=")
            if not word.startswith("--"):
                return
            if name not in known:
                self._raise_unknown(
                    word,
                    name,
                    Message("{name} is a command option; write it after the command", name=name),
                )
            if not value and known[name].nargs != 0:
                next(words, "")

    def _raise_unknown(self, words: str, name: str, elsewhere_message: str) -> NoReturn:
        """Report unknown arguments and exit.

        ``elsewhere_message`` is printed instead if the option belongs to a different parser.
        """
        options = self._all_options()
        if name in options:
            self.error(elsewhere_message)
        near = find_similar_word(name, options)
        self.error(
            Message(
                "unrecognized arguments: {words}{nearest}",
                words=words,
                nearest=f"; did you mean {near}?" if near else "",
            )
        )

    def print_help(self, file: Any = None) -> None:
        """Print the help.

        Raises OSError if printing fails. The method of argparse would ignore this error.
        """
        out = file or sys.stdout
        out.write(self.format_help())
        out.flush()

    def _all_options(self) -> list[str]:
        """Return the options of this parser and of all its commands and actions."""
        found = [option for each in self._actions for option in each.option_strings]
        for each in self._actions:
            if isinstance(each, argparse._SubParsersAction):
                for below in each.choices.values():
                    found += below._all_options() if isinstance(below, CommandParser) else []
        return found

    def error(self, message: str) -> NoReturn:
        """Print the error and exit with status 2."""
        self.exit(EXIT_USAGE, f"turndesk: {message}; see '{self.prog} --help'\n")


def add_screen_options(parser: argparse.ArgumentParser) -> None:
    """Add the screen options, which may also be written before a command."""
    parser.add_argument("--version", action="store_true", help="print the version")
    parser.add_argument(
        "--demo",
        action="store_true",
        help="use a separate data store that contains sample offsets, for the screen or for a command",
    )
    parser.add_argument(
        "--kiosk", action="store_true", help="run in full screen; the window cannot be closed"
    )
    texts = {
        "machine": "machine file (default: the shipped simulated lathe)",
        "program": "program to load at start-up",
        "offsets": "offsets file to use instead of the stored offsets",
    }
    for name in PRE_COMMAND_OPTIONS:
        # A command has its own option of the same name, which would otherwise overwrite this value.
        parser.add_argument(f"--{name}", metavar="FILE", dest=f"before_{name}", help=texts[name])


def has_only_screen_options(argv: Sequence[str]) -> bool:
    """Return whether the arguments consist only of valid screen options, without a command."""
    words = iter(argv)
    for word in words:
        name, _, value = word.partition("=")
        if name in OPTIONS_WITH_VALUE:
            if not value and next(words, "-").startswith("-"):
                return False
        elif word not in FLAG_OPTIONS:
            return False
    return True


def insert_program_option(argv: Sequence[str], commands: Collection[str]) -> Sequence[str]:
    """Return the arguments with ``--program`` inserted before the name of a program file.

    The option is inserted if the first word is a file and not a command. ``commands`` are the names of all
    commands. A command takes precedence over a file of the same name.
    """
    value_of = ""
    for index, word in enumerate(argv):
        if value_of or word.startswith("-"):
            value_of = word if word in OPTIONS_WITH_VALUE and not value_of else ""
        elif word in commands or not os.path.isfile(word):
            break
        else:
            return [*argv[:index], "--program", *argv[index:]]
    return argv


def move_demo_option_first(argv: Sequence[str]) -> Sequence[str]:
    """Return the arguments with ``--demo`` moved ahead of the command.

    The screen's parser reads the option at this position.
    """
    return ["--demo", *(word for word in argv if word != "--demo")] if "--demo" in argv else argv


def copy_screen_options(args: argparse.Namespace) -> argparse.Namespace:
    """Copy the options written before a command to the command's arguments, and return the arguments.

    Raises CommandError if the command does not have such an option, or if the option is specified both
    before and after the command. CommandError is also raised if --version is combined with other options or
    a command, or --kiosk with a command.
    """
    command = args.command
    if args.version and (
        command
        or args.demo
        or args.kiosk
        or any(getattr(args, f"before_{name}") for name in PRE_COMMAND_OPTIONS)
    ):
        raise CommandError("--version cannot be combined with other options or commands", "version-alone")
    if command and args.kiosk:
        raise CommandError(
            Message("--kiosk opens the screen; remove this option to run {command}", command=command),
            "screen-option",
        )
    for name in PRE_COMMAND_OPTIONS:
        before = getattr(args, f"before_{name}")
        if not command:
            setattr(args, name, before)
        elif before is not None:
            if not hasattr(args, name):
                raise CommandError(
                    _not_there(command, getattr(args, "action", ""), name), "option-before-command"
                )
            if getattr(args, name) is not None:
                raise CommandError(
                    Message(
                        "--{name} is specified twice, before and after {command}; remove one",
                        name=name,
                        command=command,
                    ),
                    "option-twice",
                )
            setattr(args, name, before)
    return args


def _not_there(command: str, action: str, name: str) -> str:
    words = f"{command} {action}".strip()
    instead = _REPLACEMENTS.get(name) if name == "program" or command == "machine" else None
    hint = f"; {instead}" if instead else ""
    return Message(
        "--{name} cannot be used before {words}, which does not have this option{hint}",
        name=name,
        words=words,
        hint=hint,
    )
