"""Lock the Python packages by version and hash: ``python -m resources.setup.lock [--upgrade]``.

The script writes the files ``locked-*.txt`` from the requirements in ``pyproject.toml``. The setup passes
these files to ``pip install --require-hashes --no-deps``. They are valid for every supported Python version
on Linux, macOS and Windows. Versions change only with ``--upgrade``. The script requires ``uv`` (``pipx
install uv``) and a network.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

SETUP_FOLDER = Path(__file__).parent
PROJECT_FOLDER = SETUP_FOLDER.parents[1]
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
"""Python versions for which the packages are locked and tested."""
# The tests' first: what the others share with them has the same versions then.
EXTRAS_BY_SET: dict[str, tuple[str, ...]] = {
    "tests": ("dev",),
    "desk": ("canopen", "shop", "postgresql"),
    "scheduler": ("scheduler",),
}
"""Optional dependencies in each locked file, by file."""
INSTALLER_SET = "installer"
"""Name of the locked file for pip itself, which is bundled for installation without a network."""
_HEAD = """\
# Python packages at the versions that were tested together, with the SHA-256 of every file of them.
# Made from pyproject.toml by `python -m resources.setup.lock`; not to be changed by hand.
"""
_PIN = re.compile(
    r"^(?P<name>[a-z0-9-]+)==(?P<version>[^\s;]+)(?: ; (?P<marker>[^\\]+?))? \\\n", re.MULTILINE
)
_HASH = re.compile(r"--hash=sha256:([0-9a-f]{64})\b")


@dataclass(frozen=True)
class LockedPackage:
    """Locked package: its name in lower case, version, SHA-256 of its files, and environment marker."""

    name: str
    version: str
    hashes: tuple[str, ...]
    marker: str = ""


def get_locked_file(name: str) -> Path:
    """Return the path of the file with the locked packages of a set."""
    return SETUP_FOLDER / f"locked-{name}.txt"


def read_locked_packages(name: str) -> dict[str, LockedPackage]:
    """Return the locked packages of a set by name."""
    return {
        package.name: package
        for package in parse_locked_file(get_locked_file(name).read_text(encoding="utf-8"))
    }


def parse_locked_file(text: str) -> Iterator[LockedPackage]:
    """Yield the packages in the text of a locked file."""
    starts = list(_PIN.finditer(text))
    ends = [each.start() for each in starts[1:]] + [len(text)]
    for found, end in zip(starts, ends, strict=True):
        hashes = tuple(_HASH.findall(text, found.end(), end))
        yield LockedPackage(found["name"], found["version"], hashes, found["marker"] or "")


def read_project_file() -> dict[str, Any]:
    """Return the contents of pyproject.toml."""
    return tomllib.loads((PROJECT_FOLDER / "pyproject.toml").read_text(encoding="utf-8"))


def list_build_requirements() -> list[str]:
    """Return the requirements for building TurnDesk itself.

    These packages are also locked, so that the setup downloads only locked packages.
    """
    return [str(each) for each in read_project_file()["build-system"]["requires"]]


def main(argv: list[str]) -> int:
    """Write all locked files and return the exit status."""
    if (uv := shutil.which("uv")) is None:
        sys.stderr.write("uv is not installed; it resolves the packages: pipx install uv\n")
        return 2
    for name in (*EXTRAS_BY_SET, INSTALLER_SET):
        path = get_locked_file(name)
        extras = EXTRAS_BY_SET.get(name, ())
        command = [uv, "pip", "compile", "--quiet", "--universal", "--generate-hashes", "--no-header"]
        command += [
            "--no-annotate",
            "--no-emit-index-url",
            "--no-emit-find-links",
            "--python-version",
            PYTHONS[0],
        ]
        command += [*argv, *(f"--extra={each}" for each in extras), "--output-file", str(path)]
        if name != "tests":
            command += ["--constraints", str(get_locked_file("tests"))]
        done = subprocess.run(
            [*command, *(["pyproject.toml"] if name in EXTRAS_BY_SET else []), "-"],
            cwd=PROJECT_FOLDER,
            input="\n".join(list_build_requirements() if name in EXTRAS_BY_SET else ["pip"]),
            text=True,
            stdout=subprocess.DEVNULL,
            check=False,
        )
        if done.returncode:
            return done.returncode
        path.write_text(_HEAD + path.read_text(encoding="utf-8"), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
