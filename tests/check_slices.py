"""Checks before a release that each optional feature can be left out: ``python -m tests.check_slices``.

For each feature, or for those that are named, the checker copies the files of the repository, deletes the
three folders of the feature and of the features that need it, and runs lint, types, import contracts and the
quick tests in the copy. It takes some minutes for each feature and is not part of the test command.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from app.compose.optional_features import FEATURE_NAMES, extras

HOUSE = Path(__file__).parents[1]
PLACES = ("app/extras", "core/extras", "tests/extras")
QUICK = (
    *("tests/language", "tests/interpreter", "tests/proving", "tests/machine", "tests/cli", "tests/desk"),
    *("tests/test_extras.py", "tests/test_contracts.py", "tests/screen/test_pages.py"),
    *("tests/screen/test_start.py", "tests/screen/test_escape.py", "tests/screen/test_accessible.py"),
)
CHECKS: Mapping[str, Sequence[str]] = {
    "lint": ("-m", "ruff", "check", "--quiet", "."),
    "types": ("-m", "mypy"),
    "contracts": ("-c", "from importlinter.cli import lint_imports_command as check; check()"),
    "tests": ("-m", "pytest", "-q", "--forked-workers", "2", "-m", "not long", *QUICK),
}


def dependents(name: str) -> set[str]:
    """Return the feature and the features that need it, directly or not."""
    found, before = {name}, set[str]()
    while found != before:
        before = set(found)
        found |= {each for each, extra in extras().items() if found & set(extra.required_features)}
    return found


def copy_without(names: set[str], target: Path) -> None:
    """Copy the files of the repository to ``target`` without these features."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=HOUSE, check=True, capture_output=True, text=True).stdout
    for line in listed.splitlines():
        if (HOUSE / line).is_file():
            (target / line).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(HOUSE / line, target / line)
    for name in names:
        for place in PLACES:
            shutil.rmtree(target / place / name, ignore_errors=True)


def failed_checks(folder: Path) -> Iterator[str]:
    """Run all checks in a copy; yield the name and the last lines of each one that fails."""
    shared = HOUSE.parent / "shared"
    if shared.is_dir():
        (folder.parent / "shared").symlink_to(shared)
    environment = {**os.environ, "PYTHONPATH": str(folder), "QT_QPA_PLATFORM": "offscreen"}
    for name, words in CHECKS.items():
        done = subprocess.run(
            [sys.executable, *words], cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        if done.returncode:
            yield f"{name}:\n" + "\n".join((done.stdout + done.stderr).splitlines()[-40:])


def main(argv: Sequence[str]) -> int:
    """Check the features that are named, or all of them; return 1 if a check fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="features (default: all)")
    names = parser.parse_args(argv).names or FEATURE_NAMES
    status = 0
    for name in names:
        if name not in FEATURE_NAMES:
            parser.error(f"{name} is not an optional feature; choose from {', '.join(FEATURE_NAMES)}")
        gone = dependents(name)
        with TemporaryDirectory(prefix="slice-") as folder:
            copy = Path(folder) / "main"
            copy_without(gone, copy)
            failures = list(failed_checks(copy))
        status |= bool(failures)
        sys.stdout.write(f"without {', '.join(sorted(gone))}: {'FAILED' if failures else 'ok'}\n")
        sys.stdout.write("".join(f"{each}\n" for each in failures))
        sys.stdout.flush()
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
