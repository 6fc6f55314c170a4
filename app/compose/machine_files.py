"""Machine files by their names, the shipped ones and others."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import resources
from core.machine.machine_model import Machine

SHIPPED = "gt75.toml"


@lru_cache(maxsize=8)  # by the text itself: a folder of proofs and its workers ask for the same one
def parse_machine(text: str, source: str) -> Machine:
    """The machine that the TOML ``text`` describes; ``source`` names it. Raises MachineFileError."""
    from app.compose.machine_drivers import read_machine_file

    return read_machine_file(text, source)


def load_machine(path: Path | None = None) -> Machine:
    """The machine that ``path`` describes; None: the shipped simulated lathe.

    Raises MachineFileError with everything that is wrong, also where the file cannot be read at all.
    """
    if path is None:
        return _shipped(SHIPPED)
    from core.machine.machine_file import text_of

    return parse_machine(text_of(path), str(path))


def named_machine(name: str | None) -> Machine:
    """The machine of a file, a shipped one by its name, or (None) the shipped lathe; as ``load_machine``."""
    if name and name in resources.machine_names() and not Path(name).exists():
        return shipped_machine(name)
    return load_machine(Path(name) if name else None)


def shipped_machine(name: str) -> Machine:
    """One of the machines that come with the product. Raises FileNotFoundError for another name."""
    return _shipped(f"{name}.toml")


def _shipped(name: str) -> Machine:
    return parse_machine(resources.machine_file(name), name)
