"""Data files that are shipped with the product: machine files, sample programs, post-processors and fonts."""

from __future__ import annotations

from pathlib import Path

_HERE = Path(__file__).parent


def list_machine_names() -> frozenset[str]:
    """Return the names of the shipped machine files without their file extension."""
    return frozenset(each.stem for each in (_HERE / "machines").glob("*.toml"))


def get_posts_folder() -> Path:
    """Return the folder of the post-processors for CAM programs."""
    return _HERE / "posts"


def get_documents_folder() -> Path:
    """Return the folder of the documentation site, which a clone does not contain."""
    return _HERE / "documents"


def read_machine_file(name: str) -> str:
    """Return the text of a shipped machine file, such as ``gt75.toml``.

    Raises FileNotFoundError if the file does not exist.
    """
    return get_machine_path(name).read_text(encoding="utf-8")


def get_machine_path(name: str) -> Path:
    """Return the path of a shipped machine file."""
    return _HERE / "machines" / name


def get_hal_path(name: str) -> Path:
    """Return the path of a shipped HAL file, such as ``gt75-hal.hal``, which LinuxCNC reads."""
    return _HERE / "machines" / name
