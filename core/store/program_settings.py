"""The settings that go with a program, by its name."""

from __future__ import annotations


def stock_key(program: str) -> str:
    """The setting that holds the stock of a program."""
    return f"stock:{program}"


def notes_key(program: str) -> str:
    """The setting that holds what the setup person has noted about a program."""
    return f"notes:{program}"


def text_key(program: str) -> str:
    """Return the setting that states which text was last loaded under this name."""
    return f"text:{program}"


def part_key(program: str) -> str:
    """The setting that holds what else is kept of a program's part: stick-out and silenced checks."""
    return f"part:{program}"
