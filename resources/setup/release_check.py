"""Test the artifacts of a release in minimal systems: ``python -m resources.setup.release_check FOLDER``.

The check installs each artifact in a minimal root file system of each Debian release for which it is made.
There it makes the first part within five minutes of the start of the installation, runs the commands of a
user, and removes the artifact. It then installs the previous version, stores data with it, upgrades it, and
compares all data. A removed Debian package leaves only the data folder. ``lintian`` must not find an error
in a Debian package. Instead of FOLDER, single files can be named.

The check must be run as root. It needs ``debootstrap``, ``lintian``, 2 GB of free disk space and a network,
takes several minutes for each artifact, and is not part of the test command.
"""

from __future__ import annotations

import argparse
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from resources.setup.artifact_checks.artifacts import (
    DEBIAN_RELEASES,
    Artifact,
    ArtifactKind,
    Installation,
    find_artifacts,
    identify_artifact,
    make_installation,
)
from resources.setup.artifact_checks.earlier_artifact import find_previous_artifact, make_earlier_artifact
from resources.setup.artifact_checks.minimal_root import make_base_root, open_root_copy, run_in_root
from resources.setup.artifact_checks.store_data import StoredData, count_rows, list_losses, read_stored_data
from resources.setup.bundle import BundleError

_LINTIAN_FAILED = 1  # exit status of lintian after an error of its own
MAX_FIRST_PART_S = 300.0
"""Longest permitted time from the artifact to the first part, in seconds."""
_IGNORED = re.compile(
    r"^/(?:proc|sys|dev|run|tmp|artifacts|var/(?:cache|log|lib/(?:apt|dpkg|systemd)))(?:/|$)"
    r"|^/etc/(?:group|gshadow|passwd|shadow|subgid|subuid)-$"  # backups of groupadd and groupdel
    r"|^/root/\.(?:cache/(?:fontconfig|pip)|local/share/turndesk)(?:/|$)"  # of Qt, of pip, and the data
)
_DATA_FOLDER = "root/.local/share/turndesk"
_WITH_OFFSETS = "$samples/pin.nc --headless --offsets $samples/offsets.toml"
FIRST_PART = f"turndesk run {_WITH_OFFSETS} --realtime"
"""Command that makes and counts a part on the simulated lathe, at the speed of a lathe."""
TEST_COMMANDS: Sequence[tuple[str, str]] = (
    ("the version", "turndesk --version"),
    ("a proof", "turndesk prove $samples/pin.nc --offsets $samples/offsets.toml"),
    ("proofs of a folder, by several processes", "turndesk prove $samples --offsets $samples/offsets.toml"),
    (
        "a report as PDF",
        "turndesk prove $samples/pin.nc --offsets $samples/offsets.toml --report /artifacts/part.pdf",
    ),
    (
        "the documentation",
        "test -s \"$(turndesk where | sed -n 's/^documents *//p')/docs/guide/screen.html\"",
    ),
    ("the screen for 20 s", "QT_QPA_PLATFORM=offscreen timeout 20 turndesk --demo; test $? = 124"),
)
"""Shell commands that are tested after the installation, each with a description."""
DATA_COMMANDS: Sequence[str] = (
    FIRST_PART,
    "turndesk offsets set T1 x=1.25 z=-2.5",
    "turndesk offsets set T9 kind=drill diameter=.25",
    "turndesk offsets set T1D2 x=.001",
    f"mkdir -p /{_DATA_FOLDER}/programs && cp $samples/pin.nc /{_DATA_FOLDER}/programs",
    "turndesk jobs add pin.nc 12 --note 'order 7'",
)
"""Shell commands that store data of several kinds before an upgrade."""


class ArtifactFiles(NamedTuple):
    """Paths of the new and the earlier artifact inside the root file system."""

    new: str
    earlier: str


def run_program(root: Path, program: str, command: str) -> str:
    """Run a shell command that uses ``turndesk`` and the folder ``$samples``, and return its output.

    ``program`` is the path of the command ``turndesk`` in the root file system. Raises BundleError if the
    command fails.
    """
    lines = (
        f"PATH={Path(program).parent}:$PATH",
        'code=$(turndesk where --json | sed -n \'s/.*"code": "\\(.*\\)".*/\\1/p\')',
        'samples=$(dirname "$code")/../resources/programs',
        command,
    )
    return run_in_root(root, "\n".join(lines))


def list_files(root: Path) -> set[str]:
    """Return the files in the root file system that must be the same after a purge."""
    listed = run_in_root(root, "find / -xdev \\( -type f -o -type l \\) -print").splitlines()
    return {name for name in listed if not _IGNORED.match(name)}


def measure_seconds(action: Callable[[], object]) -> float:
    """Return the duration of an action in seconds, by the monotonic clock."""
    start = time.monotonic()
    action()
    return time.monotonic() - start


def check_first_part_time(seconds: float) -> str:
    """Return the text of the measured time. Raises BundleError if the time is too long."""
    if seconds > MAX_FIRST_PART_S:
        raise BundleError(f"first part after {seconds:.0f} s; {MAX_FIRST_PART_S:.0f} s are permitted")
    return f"first part {seconds:.0f} s after the start of the installation"


def check_removal(root: Path, before: set[str], kind: ArtifactKind) -> str:
    """Compare the files after a removal with those before the installation, and return the result.

    Raises BundleError if the removal left files outside the data folder, or removed files of others.
    """
    after = list_files(root)
    if kind is ArtifactKind.DEBIAN_PACKAGE:
        if gone := sorted(before - after):
            raise BundleError(f"purge removed files of others: {', '.join(gone[:10])}")
        if run_in_root(root, "getent group machine || echo none").strip() != "none":
            raise BundleError("purge left the group machine")
    left = sorted(name for name in after - before if is_of_turndesk(name, kind))
    if left:
        raise BundleError(f"the removal left: {', '.join(left[:10])}")
    if not (root / _DATA_FOLDER).is_dir():
        raise BundleError("the removal deleted the data folder")
    return "removed: only the data folder remains"


def is_of_turndesk(path: str, kind: ArtifactKind) -> bool:
    """Return whether a new file is a remainder of TurnDesk.

    The packages of the system are installed before a Debian package, but by the other artifacts. For those,
    only files with ``turndesk`` in their path count.
    """
    return kind is ArtifactKind.DEBIAN_PACKAGE or "turndesk" in path


def check_artifact(artifact: Artifact, root: Path, files: ArtifactFiles) -> Iterator[str]:
    """Yield one line for each successful step of the check of an artifact in a root file system.

    Raises BundleError at the first failure.
    """
    steps = make_installation(artifact)
    new, earlier = shlex.quote(files.new), shlex.quote(files.earlier)
    seconds = measure_seconds(lambda: run_in_root(root, steps.prepare))
    before = list_files(root)
    seconds += measure_seconds(lambda: run_in_root(root, steps.install.format(file=new)))
    yield f"installed in {seconds:.0f} s"
    seconds += measure_seconds(lambda: run_program(root, steps.program, FIRST_PART))
    yield check_first_part_time(seconds)
    for description, command in TEST_COMMANDS:
        run_program(root, steps.program, command)
        yield description
    if artifact.kind is ArtifactKind.DEBIAN_PACKAGE:
        run_in_root(root, "getent group machine")
        yield "the group for real-time priority"
    run_in_root(root, steps.remove)
    yield check_removal(root, before, artifact.kind)
    yield from _check_upgrade(root, steps, new, earlier)
    if artifact.kind is ArtifactKind.DEBIAN_PACKAGE and len([*(root / "opt/turndesk").iterdir()]) > 1:
        raise BundleError("the upgrade left files of the earlier version")
    run_in_root(root, steps.remove)
    yield check_removal(root, before, artifact.kind)


def _check_upgrade(root: Path, steps: Installation, new: str, earlier: str) -> Iterator[str]:
    """Store data with the earlier version, upgrade it, and compare the data.

    No network is available for the upgrade if the artifact contains all packages.
    """
    shutil.rmtree(root / _DATA_FOLDER)
    run_in_root(root, steps.install.format(file=earlier), has_network=steps.needs_network)
    version = run_program(root, steps.program, "turndesk --version").strip()
    for command in DATA_COMMANDS:
        run_program(root, steps.program, command)
    before = read_stored_data(root / _DATA_FOLDER)
    run_in_root(root, steps.upgrade.format(file=new), has_network=steps.needs_network)
    upgraded = run_program(root, steps.program, "turndesk --version").strip()
    if upgraded == version:
        raise BundleError(f"{version} is still installed after the upgrade")
    run_program(root, steps.program, "turndesk store upgrade && turndesk store verify")
    yield f"{version} upgraded to {upgraded}" + ("" if steps.needs_network else " without a network")
    yield check_losses(before, read_stored_data(root / _DATA_FOLDER))
    run_program(root, steps.program, f"turndesk run {_WITH_OFFSETS}")
    yield "a run with the upgraded version"


def check_losses(before: StoredData, after: StoredData) -> str:
    """Return the number of compared rows and files. Raises BundleError if the upgrade lost any data."""
    if losses := list_losses(before, after):
        raise BundleError(f"the upgrade lost or changed: {'; '.join(losses[:10])}")
    return f"the upgrade changed none of {count_rows(before)} stored rows and {len(before.files)} files"


def list_lintian_errors(package: Path) -> list[str]:
    """Return the errors that lintian reports, except those that a documented override explains.

    Raises BundleError if lintian itself failed.
    """
    done = subprocess.run(
        ["lintian", "--no-cfg", "--tag-display-limit=0", str(package)],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == _LINTIAN_FAILED:
        raise BundleError(f"lintian failed: {done.stderr.strip()}")
    return [line for line in done.stdout.splitlines() if line.startswith("E: ")]


def check_release(
    artifacts: Sequence[Artifact], releases: Sequence[str], previous: Path | None
) -> Iterator[str]:
    """Yield one line for each successful step of the check of all artifacts.

    ``previous`` is the folder of the previous release, or None if no release exists. The check of an
    artifact ends at its first failure. Raises BundleError at the end if an artifact failed.
    """
    failures: list[str] = []
    for artifact in artifacts:
        if not artifact.releases:
            yield f"{artifact.path.name}: not checked, because its system is not Debian"
    with tempfile.TemporaryDirectory(prefix="turndesk-") as work:
        for release in releases:
            chosen = [each for each in artifacts if release in each.releases]
            base = make_base_root(release, Path(work)) if chosen else Path(work)
            for artifact in chosen:
                name = f"{artifact.kind} on {release}"
                try:
                    with open_root_copy(base) as root:
                        files = _copy_artifacts(artifact, root, previous)
                        for line in check_artifact(artifact, root, files):
                            yield f"{name}: {line}"
                except BundleError as error:
                    failures.append(name)
                    yield f"{name} FAILED: {error}"
    if failures:
        raise BundleError(", ".join(failures))


def _copy_artifacts(artifact: Artifact, root: Path, previous: Path | None) -> ArtifactFiles:
    """Copy an artifact and its earlier version to the root file system, and return their paths in it."""
    new, earlier = root / "artifacts" / "new", root / "artifacts" / "earlier"
    new.mkdir(parents=True)
    earlier.mkdir()
    shutil.copy(artifact.path, new)
    if previous:
        shutil.copy(source := find_previous_artifact(artifact, previous), earlier)
        name = source.name
    else:
        name = make_earlier_artifact(artifact, earlier).name
    return ArtifactFiles(f"/artifacts/new/{artifact.path.name}", f"/artifacts/earlier/{name}")


def main(argv: Sequence[str]) -> int:
    """Check a release and return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m resources.setup.release_check", description=__doc__)
    parser.add_argument("paths", nargs="+", type=Path, metavar="FOLDER or FILE")
    parser.add_argument("--previous", type=Path, metavar="FOLDER", help="folder of the previous release")
    parser.add_argument(
        "--release", action="append", choices=DEBIAN_RELEASES, help="Debian release (default: all)"
    )
    parser.add_argument("--without-lintian", action="store_true")
    args = parser.parse_args(argv)
    errors: list[str] = []
    try:
        artifacts = _list_artifacts(args.paths)
        for line in check_release(artifacts, args.release or tuple(DEBIAN_RELEASES), args.previous):
            sys.stdout.write(f"{line}\n")
            sys.stdout.flush()
        for artifact in artifacts:
            if artifact.kind is ArtifactKind.DEBIAN_PACKAGE and not args.without_lintian:
                errors += list_lintian_errors(artifact.path)
    except (BundleError, OSError) as error:
        sys.stderr.write(f"The check failed: {error}\n")
        return 1
    sys.stderr.write("".join(f"{line}\n" for line in errors))
    return 1 if errors else 0


def _list_artifacts(paths: Sequence[Path]) -> list[Artifact]:
    """Return the artifacts in folders and files. Raises BundleError for a file that is not an artifact."""
    found: list[Artifact] = []
    for path in paths:
        if path.is_dir():
            found += find_artifacts(path.absolute())
        elif artifact := identify_artifact(path.absolute()):
            found.append(artifact)
        else:
            raise BundleError(f"{path} is not an artifact of a release")
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
