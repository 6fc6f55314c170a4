"""What the product ships besides code: machine files, sample programs, fonts, the page for the office."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path


def machine_names() -> frozenset[str]:
    """The names of the shipped machine files, without their ending."""
    folder = files(__name__).joinpath("machines")
    return frozenset(
        each.name.removesuffix(".toml") for each in folder.iterdir() if each.name.endswith(".toml")
    )


def machine_file(name: str) -> str:
    """The text of a shipped machine file, such as ``gt75.toml``. Raises FileNotFoundError."""
    return files(__name__).joinpath("machines", name).read_text(encoding="utf-8")


def hal_file(name: str) -> Path:
    """Where a shipped HAL file is, such as ``gt75-hal.hal``: LinuxCNC reads it itself."""
    return Path(__file__).parent / "machines" / name


def status_page_file(name: str) -> bytes:
    """A file of the page for the office, such as ``page.html``. Raises FileNotFoundError."""
    return files(__name__).joinpath("status_page", name).read_bytes()
