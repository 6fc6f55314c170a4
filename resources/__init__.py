"""What the product ships besides code: machine files, sample programs, fonts."""

from __future__ import annotations

from pathlib import Path

_HERE = Path(__file__).parent


def machine_names() -> frozenset[str]:
    """The names of the shipped machine files, without their ending."""
    return frozenset(each.stem for each in (_HERE / "machines").glob("*.toml"))


def machine_file(name: str) -> str:
    """The text of a shipped machine file, such as ``gt75.toml``. Raises FileNotFoundError."""
    return machine_path(name).read_text(encoding="utf-8")


def machine_path(name: str) -> Path:
    """Where a shipped machine file is."""
    return _HERE / "machines" / name


def hal_file(name: str) -> Path:
    """Where a shipped HAL file is, such as ``gt75-hal.hal``: LinuxCNC reads it itself."""
    return _HERE / "machines" / name
