"""Relocatable folder with TurnDesk and all its Python packages for one Python version.

The folder has the structure of a virtual environment; ``bin/python`` is a link to the system's Python.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from resources.setup.bundle import list_platform_options, run
from resources.setup.licences import PAGE_PATH
from resources.setup.lock import PROJECT_FOLDER, SETUP_FOLDER, get_locked_file

DEBIAN_FOLDER = SETUP_FOLDER / "debian"
_NEEDLESS = ("bin", "share/man", "share/doc")
"""Folders of the packages that TurnDesk does not use: commands, manual pages and documents."""


def make_environment_folder(
    folder: Path, wheel: Path, python_version: str, machine: str, wheel_folder: Path
) -> None:
    """Fill a folder with the environment for a Python version, such as ``3.11``.

    ``wheel_folder`` is the folder with all wheels that TurnDesk needs. Raises BundleError if a package
    cannot be installed.
    """
    packages = folder / "lib" / f"python{python_version}" / "site-packages"
    packages.mkdir(parents=True)
    words = [
        "--quiet",
        "--disable-pip-version-check",
        "--no-index",
        f"--find-links={wheel_folder}",
        "--no-compile",
    ]
    words += [
        "--no-deps",
        "--only-binary=:all:",
        f"--python-version={python_version}",
        *list_platform_options(machine),
    ]
    words += ["--implementation=cp", f"--target={packages}", "--no-warn-conflicts"]
    run(sys.executable, "-m", "pip", "install", *words, "--require-hashes", "-r", get_locked_file("desk"))
    run(sys.executable, "-m", "pip", "install", *words, wheel)
    for name in _NEEDLESS:
        shutil.rmtree(packages / name, ignore_errors=True)
    _without_traces(packages)
    commands = folder / "bin"
    commands.mkdir()
    (commands / "python").symlink_to(f"/usr/bin/python{python_version}")
    (commands / "turndesk").write_bytes((DEBIAN_FOLDER / "turndesk").read_bytes())
    (commands / "turndesk").chmod(0o755)
    (folder / "pyvenv.cfg").write_text(f"home = /usr/bin\nversion = {python_version}\n", encoding="utf-8")
    (folder / "documents").symlink_to(
        f"lib/python{python_version}/site-packages/turndesk/resources/documents"
    )
    (folder / "licences").mkdir()
    shutil.copy(PROJECT_FOLDER / "LICENSE", folder / "licences" / "TurnDesk")
    shutil.copy(PAGE_PATH, folder / "licences.md")


def _without_traces(packages: Path) -> None:
    """Delete compiled files, and files in which pip records data about this computer and build."""
    for compiled in [*packages.rglob("__pycache__")]:
        shutil.rmtree(compiled)
    for info in packages.glob("*.dist-info"):
        for name in ("direct_url.json", "INSTALLER", "REQUESTED", "RECORD"):
            (info / name).unlink(missing_ok=True)
