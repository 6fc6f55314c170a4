"""What is wrong with a machine file: all of it at once, each with path, value and what was expected."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Finding(NamedTuple):
    """One thing that is wrong: the key's path, the value as the file has it, what would be right."""

    path: str
    value: str
    expected: str

    def __str__(self) -> str:
        where = f"{self.path} = {self.value}" if self.value else self.path
        return f"{where}: {self.expected}"


class MachineFileError(Exception):
    """A machine file cannot be used. ``errors`` holds every finding, ``source`` the file's name."""

    def __init__(self, errors: Sequence[Finding], source: str) -> None:
        self.errors = tuple(errors)
        self.source = source
        super().__init__(f"{source}: " + "; ".join(str(finding) for finding in self.errors))
