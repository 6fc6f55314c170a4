"""Test a Debian package in a minimal system: ``python -m resources.setup.release_check PACKAGE``, as root.

The check creates a minimal root file system with ``debootstrap``, with the package sources of this
computer. It installs an earlier version, upgrades the package, proves and runs a program, removes and
purges the package, and compares the files before and after. ``lintian`` must not find an error. The check
requires ``debootstrap``, ``lintian`` and a network for Debian's packages, takes several minutes, and is not
part of the test command.
"""

from __future__ import annotations

import argparse
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from resources.setup.bundle import BundleError, run

_EARLIER = "0.0.0"
_MOUNTS = ("proc", "sys", "dev")
_IGNORED = re.compile(
    r"^/(?:proc|sys|dev|run|tmp|root|var/(?:cache|log|lib/(?:apt|dpkg|systemd)))(?:/|$)"
    r"|^/etc/(?:group|gshadow|passwd|shadow|subgid|subuid)-$"  # backups of groupadd and groupdel
)
_PROGRAMS = "lib/python3*/site-packages/turndesk/resources/programs"
_SAMPLES = f'samples=$(dirname "$(readlink -f /usr/bin/turndesk)")/../{_PROGRAMS}'
_APT = "DEBIAN_FRONTEND=noninteractive apt-get -qq -y"
TEST_COMMANDS: Sequence[tuple[str, str]] = (
    ("the version", "turndesk --version"),
    ("a proof", "turndesk prove $samples/pin.nc --offsets $samples/offsets.toml"),
    ("proofs of a folder, by several processes", "turndesk prove $samples --offsets $samples/offsets.toml"),
    ("a run without a screen", "turndesk run $samples/pin.nc --headless --offsets $samples/offsets.toml"),
    (
        "a report as PDF",
        "turndesk prove $samples/pin.nc --offsets $samples/offsets.toml --report /root/part.pdf",
    ),
    ("the screen for 20 s", "QT_QPA_PLATFORM=offscreen timeout 20 turndesk --demo; test $? = 124"),
    ("the group for real-time priority", "getent group machine"),
)
"""Shell commands that are tested after installation and after an upgrade, each with a description."""


def build_earlier_package(package: Path, folder: Path) -> Path:
    """Return the path of the same package as version 0.0.0, with its files in a different folder."""
    root = folder / "earlier"
    run("dpkg-deb", "--raw-extract", package, root)
    version = next((root / "opt" / "turndesk").iterdir())
    version.rename(version.with_name(_EARLIER))
    command = root / "usr" / "bin" / "turndesk"
    command.unlink()
    command.symlink_to(f"/opt/turndesk/{_EARLIER}/bin/turndesk")
    for path in (root / "DEBIAN").iterdir():
        text = path.read_text(encoding="utf-8").replace(version.name, _EARLIER)
        path.write_text(
            re.sub(r"^Version: .*$", f"Version: {_EARLIER}", text, flags=re.MULTILINE), encoding="utf-8"
        )
    made = folder / f"turndesk_{_EARLIER}.deb"
    run("dpkg-deb", "--root-owner-group", "-Znone", "--build", root, made)
    shutil.rmtree(root)
    return made


def copy_package_sources(source_folder: Path, target_folder: Path, release: str) -> None:
    """Copy the package sources of this computer, with ``release`` in place of this computer's release."""
    (target_folder / "sources.list").unlink(missing_ok=True)
    own_release = platform.freedesktop_os_release().get("VERSION_CODENAME", release)
    for part in ("sources.list", "sources.list.d/debian.sources"):
        if (source_folder / part).is_file():
            text = (source_folder / part).read_text(encoding="utf-8")
            (target_folder / part).parent.mkdir(parents=True, exist_ok=True)
            (target_folder / part).write_text(text.replace(own_release, release), encoding="utf-8")
    for part in ("apt.conf.d", "trusted.gpg.d"):
        if (source_folder / part).is_dir():
            shutil.copytree(source_folder / part, target_folder / part, dirs_exist_ok=True)


@contextmanager
def create_minimal_root(release: str, folder: Path) -> Iterator[Path]:
    """Yield a minimal root file system of a Debian release.

    The root file system has its mounts. It uses the package sources of this computer for that release.
    """
    root = folder / "root"
    run("debootstrap", "--variant=minbase", release, root)
    copy_package_sources(Path("/etc/apt"), root / "etc" / "apt", release)
    with suppress(OSError):
        shutil.copy("/etc/resolv.conf", root / "etc" / "resolv.conf")
    mounted = []
    try:
        for name in _MOUNTS:
            run("mount", "--bind", f"/{name}", root / name)
            mounted.append(name)
        yield root
    finally:
        for name in reversed(mounted):
            run("umount", "--lazy", root / name)


def run_in_root(root: Path, command: str) -> str:
    """Run a shell command in the root file system, and return its output.

    Raises BundleError if the command fails.
    """
    lines = f"export HOME=/root LC_ALL=C.UTF-8 TURNDESK_HOME=/root/data; {_SAMPLES}; {command}"
    return run("chroot", root, "sh", "-c", lines)


def list_files(root: Path) -> set[str]:
    """Return the files in the root file system that must be the same after a purge."""
    listed = run_in_root(root, "find / -xdev \\( -type f -o -type l \\) -print").splitlines()
    return {name for name in listed if not _IGNORED.match(name)}


def check(package: Path, release: str) -> Iterator[str]:
    """Yield one line for each successful step of the check.

    Raises BundleError at the first failure.
    """
    with (
        tempfile.TemporaryDirectory(prefix="turndesk-") as work,
        create_minimal_root(release, Path(work)) as root,
    ):
        earlier = build_earlier_package(package, Path(work))
        shutil.copy(earlier, root / "root" / "earlier.deb")
        shutil.copy(package, root / "root" / "new.deb")
        run_in_root(root, f"{_APT} update")
        depends = run("dpkg-deb", "--field", package, "Depends")
        names = [re.split(r"[ (|:]", each.strip())[0] for each in depends.split(",")]
        run_in_root(root, f"{_APT} install --no-install-recommends {' '.join(names)}")
        before = list_files(root)
        for name in ("earlier", "new"):
            run_in_root(root, f"dpkg -i /root/{name}.deb")
            for what, command in TEST_COMMANDS:
                run_in_root(root, command)
                yield f"{name}: {what}"
        if "/opt/turndesk/0.0.0" in "\n".join(list_files(root)):
            raise BundleError("the upgrade left files of the earlier version")
        run_in_root(root, "dpkg --remove turndesk && dpkg --purge turndesk")
        if left := sorted(list_files(root) - before):
            raise BundleError(f"purge left: {', '.join(left[:10])}")
        if gone := sorted(before - list_files(root)):
            raise BundleError(f"purge removed files of others: {', '.join(gone[:10])}")
        if run_in_root(root, "getent group machine || echo none").strip() != "none":
            raise BundleError("purge left the group machine")
        run_in_root(root, "test -s /root/data/turndesk.db || test -d /root/data/logs")
        yield "removed and purged: only the data folder remains"


def list_lintian_errors(package: Path) -> list[str]:
    """Return the errors that lintian reports, except those that a documented override explains."""
    done = subprocess.run(
        ["lintian", "--no-cfg", "--tag-display-limit=0", str(package)],
        capture_output=True,
        text=True,
        check=False,
    )
    return [line for line in done.stdout.splitlines() if line.startswith("E: ")]


def main(argv: Sequence[str]) -> int:
    """Check one package and return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m resources.setup.release_check", description=__doc__)
    parser.add_argument("package", type=Path)
    parser.add_argument("--release", default="bookworm", help="Debian release (default: bookworm)")
    parser.add_argument("--without-lintian", action="store_true")
    args = parser.parse_args(argv)
    try:
        for line in check(args.package, args.release):
            sys.stdout.write(f"{line}\n")
            sys.stdout.flush()
        errors = [] if args.without_lintian else list_lintian_errors(args.package)
    except (BundleError, OSError) as error:
        sys.stderr.write(f"The package failed: {error}\n")
        return 1
    sys.stderr.write("".join(f"{line}\n" for line in errors))
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
