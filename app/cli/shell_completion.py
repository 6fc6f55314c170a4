"""Completion by Tab for bash, zsh and fish, written from the commands and options that there are."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import NamedTuple

from core.message import Message

# Names of files may hold blanks, so a line is a word. zsh reads this too.
_BASH = """_turndesk() {{
    local IFS=$'\\n' at="" sub="" words="" files=yes i=1 word
    local here="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}"
    while [ "$i" -lt "$COMP_CWORD" ]; do
        word="${{COMP_WORDS[i]}}"
        case "$at$word" in
            {screen}) i=$((i + 1));;
            *--*) ;;
            *) if [ -z "$at" ]; then at="$word "; elif [ -z "$sub" ]; then sub="$word"; fi;;
        esac
        i=$((i + 1))
    done
    case "$at$sub" in
{cases}
    esac
    [ -z "$files" ] || files=$(compgen -f -- "$here")
    COMPREPLY=( $(compgen -W "$words" -- "$here") $files )
}}
complete -o filenames -F _turndesk turndesk
"""


class _Level(NamedTuple):
    """A command, or an action of it, and what may follow."""

    command: str
    action: str
    parser: argparse.ArgumentParser

    @property
    def pattern(self) -> str:
        """Of ``$at$sub`` in the shell: the command's with every word behind it, unless that is an action."""
        if self.action:
            return f'"{self.command} {self.action}"'
        return f'"{self.command} "*' if self.command else "*"

    @property
    def options(self) -> list[argparse.Action]:
        """Those with a long name."""
        return [each for each in self.parser._actions if _long(each)]

    @property
    def words(self) -> list[str]:
        """What may stand where no option wants a value: commands or actions, choices, options."""
        first = [*_below(self.parser)]
        for each in self.parser._actions:
            if each.choices and not each.option_strings and not first:
                first = [str(choice) for choice in each.choices]
        return [*first, *(f"--{_long(each)}" for each in self.options)]


def _long(action: argparse.Action) -> str:
    return next((each[2:] for each in action.option_strings if each.startswith("--")), "")


def _below(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for each in parser._actions:
        if isinstance(each, argparse._SubParsersAction):
            return dict(each.choices)
    return {}


def _levels(parser: argparse.ArgumentParser) -> Iterator[_Level]:
    """The more particular first."""
    for name, command in _below(parser).items():
        for action, below in _below(command).items():
            yield _Level(name, action, below)
        yield _Level(name, "", command)
    yield _Level("", "", parser)


def script(shell: str, parser: argparse.ArgumentParser) -> str:
    """The script that a shell reads: ``source <(turndesk setup completion bash)``, or piped into fish."""
    if shell == "fish":
        return "".join(line for level in _levels(parser) for line in _fish(level))
    cases = "\n".join(_case(level) for level in _levels(parser))
    screen = "|".join(f"--{_long(each)}" for each in _Level("", "", parser).options if each.nargs != 0)
    text = _BASH.format(cases=cases, screen=screen)
    return f"autoload -U +X bashcompinit && bashcompinit\n{text}" if shell == "zsh" else text


def _case(level: _Level) -> str:
    """The words that follow; behind an option with a value its choices, or files alone."""
    inside = []
    for each in level.options:
        if each.nargs != 0:
            words, files = (_lines(map(str, each.choices)), " files=") if each.choices else ("''", "")
            inside.append(f"                --{_long(each)}) words={words}{files};;")
    inside.append(f"                *) words={_lines(level.words)};;")
    return (
        f'        {level.pattern})\n            case "$before" in\n'
        + "\n".join(inside)
        + "\n            esac;;"
    )


def _lines(words: Iterator[str] | list[str]) -> str:
    """For the shell: words, a line each."""
    return "$'" + "\\n".join(words) + "'"


def _fish(level: _Level) -> Iterator[str]:
    """Where it stands, then its commands, actions or choices, and each option with what it takes."""
    seen = f"__fish_seen_subcommand_from {level.command}" if level.command else "__fish_use_subcommand"
    if level.action:
        seen += Message("; and __fish_seen_subcommand_from {action}", action=level.action)
    elif level.command and (below := _below(level.parser)):
        seen += Message("; and not __fish_seen_subcommand_from {below}", below=" ".join(below))
    start = Message("complete -c turndesk -n '{seen}'", seen=seen)
    named = [word for word in level.words if not word.startswith("--")]
    if named:
        yield f"{start} -a '{' '.join(named)}'\n"
    for each in level.options:
        takes = f" -x -a '{' '.join(map(str, each.choices))}'" if each.choices else " -r" * (each.nargs != 0)
        yield f"{start} -l {_long(each)}{takes}\n"
