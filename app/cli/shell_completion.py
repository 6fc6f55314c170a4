"""Completion by Tab for bash, zsh and fish, written from the commands and options that there are."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

_BASH = """_turndesk() {{
    local words="" at="${{COMP_WORDS[1]}}" sub="${{COMP_WORDS[2]}}" here="${{COMP_WORDS[COMP_CWORD]}}"
    if [ "$COMP_CWORD" -le 1 ]; then at=""; fi
    if [ "$COMP_CWORD" -le 2 ]; then sub=""; fi
    case "$at $sub" in
{cases}
    esac
    COMPREPLY=( $(compgen -W "$words" -- "$here") $(compgen -f -- "$here") )
}}
complete -o filenames -F _turndesk turndesk
"""


def _below(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for each in parser._actions:
        if isinstance(each, argparse._SubParsersAction):
            return dict(each.choices)
    return {}


def _words(parser: argparse.ArgumentParser) -> str:
    """What may stand next: commands or actions, choices, options."""
    found = list(_below(parser))
    for each in parser._actions:
        found += [option for option in each.option_strings if option.startswith("--")]
        if each.choices and not each.option_strings and not found:
            found += map(str, each.choices)
    return " ".join(dict.fromkeys(found))


def _levels(parser: argparse.ArgumentParser) -> Iterator[tuple[str, str, str]]:
    """Command, action, and the words that may follow them."""
    for name, command in _below(parser).items():
        for action, below in _below(command).items():
            yield name, action, _words(below)
        yield name, "", _words(command)
    yield "", "", _words(parser)


def script(shell: str, parser: argparse.ArgumentParser) -> str:
    """The script that a shell reads: ``source <(turndesk setup completion bash)``, or piped into fish."""
    if shell == "fish":
        return "".join(_fish(parser))
    cases = "\n".join(_case(*level) for level in _levels(parser))
    text = _BASH.format(cases=cases)
    return f"autoload -U +X bashcompinit && bashcompinit\n{text}" if shell == "zsh" else text


def _case(name: str, action: str, words: str) -> str:
    pattern = f'"{name} {action}"' if action else f'"{name} "*' if name else "*"
    return f'        {pattern}) words="{words}";;'


def _fish(parser: argparse.ArgumentParser) -> Iterator[str]:
    for name, action, words in _levels(parser):
        seen = f"__fish_seen_subcommand_from {name}" if name else "__fish_use_subcommand"
        if action:
            seen += f"; and __fish_seen_subcommand_from {action}"
        yield f"complete -c turndesk -n '{seen}' -a '{words}'\n"
