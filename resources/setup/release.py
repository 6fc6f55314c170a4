"""Build a release from a clean checkout of the last commit: ``python -m resources.setup.release FOLDER``.

The release consists of the wheel, the source distribution, the bundle for a computer without a network, a
folder that can be moved, Debian packages and the documentation, with ``SHA256SUMS`` and the SBOM.
Everything is built twice and compared byte for byte. A network is required once, for the locked packages.
``dpkg-deb``, which is part of every Debian and Ubuntu, writes the Debian packages.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from resources.documentation.build_site import SiteError, build_site_for_packages
from resources.setup.bundle import (
    GLIBC_MINOR_VERSIONS,
    BundleError,
    build_product_wheel,
    collect_bundle_files,
    fetch_wheels,
    get_bundle_version,
    run,
    write_bundle_file,
)
from resources.setup.licences import LicenseError
from resources.setup.lock import PROJECT_FOLDER
from resources.setup.packages.debian_package import TARGETS, write_debian_package
from resources.setup.packages.environment_folder import make_environment_folder
from resources.setup.packages.reproducible_archives import set_times, write_tar_gz
from resources.setup.sbom import build_sbom

CHECKSUM_FILE_NAME = "SHA256SUMS"


def build_artifacts(folder: Path, wheels: Path, machine: str, targets: Sequence[str]) -> None:
    """Build all artifacts from the checkout that contains this module.

    Raises BundleError if a step fails, LicenseError if a license does not permit distribution, or SiteError
    if the documentation has an error.
    """
    with build_site_for_packages() as site:
        _build_artifacts_with_site(folder, wheels, machine, targets, site)


def _build_artifacts_with_site(
    folder: Path, wheels: Path, machine: str, targets: Sequence[str], site: Path
) -> None:
    set_times(site)
    stem = f"turndesk-{get_bundle_version()}-documents"
    write_tar_gz(site, folder / f"{stem}.tar.gz", stem)
    build_product_wheel(folder)
    wheel = next(folder.glob("turndesk-*.whl"))
    _write_source_distribution(folder)
    with tempfile.TemporaryDirectory() as work:
        gathered = Path(work) / "gathered"
        gathered.mkdir()
        collect_bundle_files(gathered, machine, system_packages=False, wheels=wheels)
        write_bundle_file(gathered, folder / f"turndesk-{get_bundle_version()}-linux-{machine}.run", machine)
    for name in targets:
        target = TARGETS[name]
        with tempfile.TemporaryDirectory() as work:
            environment = Path(work) / "environment"
            make_environment_folder(environment, wheel, target.python_version, machine, wheels)
            set_times(environment)
            stem = f"turndesk-{get_bundle_version()}-linux-{machine}-python{target.python_version}"
            write_tar_gz(environment, folder / f"{stem}.tar.gz", stem)
            shutil.move(
                write_debian_package(environment, get_bundle_version(), target, machine, Path(work)), folder
            )
    document = build_sbom(get_bundle_version(), [*wheels.glob("*.whl")])
    (folder / "sbom.cdx.json").write_text(json.dumps(document, indent=1), encoding="utf-8")


def _write_source_distribution(folder: Path) -> None:
    code = "import sys; from resources.setup.build_backend import build_sdist; build_sdist(sys.argv[1])"
    run(sys.executable, "-c", code, folder)
    shutil.rmtree(PROJECT_FOLDER / "turndesk.egg-info", ignore_errors=True)


def write_checksums(folder: Path) -> None:
    """Write the SHA-256 of every file in the format that ``sha256sum --check`` reads."""
    lines = []
    for path in sorted(folder.iterdir()):
        if path.name != CHECKSUM_FILE_NAME:
            with path.open("rb") as file:
                lines.append(f"{hashlib.file_digest(file, 'sha256').hexdigest()}  {path.name}\n")
    (folder / CHECKSUM_FILE_NAME).write_text("".join(lines), encoding="utf-8")


def list_differences(first: Path, second: Path) -> list[str]:
    """Return the names of files that differ between two folders, or that exist in only one of them."""
    names = {path.name for folder in (first, second) for path in folder.iterdir()}
    return sorted(name for name in names if _bytes(first / name) != _bytes(second / name))


def _bytes(path: Path) -> bytes | None:
    return path.read_bytes() if path.exists() else None


def build_release(folder: Path, machine: str, targets: Sequence[str]) -> None:
    """Build the release and write it to a new folder.

    Everything is built twice from two clean checkouts and compared. Raises BundleError if the two builds
    differ.
    """
    if folder.exists():
        raise BundleError(f"{folder} exists already; name a new folder")
    commit_time = run("git", "show", "--no-patch", "--format=%ct", "HEAD").strip()
    with tempfile.TemporaryDirectory() as work:
        wheels = Path(work) / "wheels"
        wheels.mkdir()
        fetch_wheels(wheels, machine)
        made = []
        for number in ("first", "second"):
            checkout, out = Path(work) / number / "turndesk", Path(work) / f"{number}-release"
            run("git", "clone", "--quiet", "--no-hardlinks", PROJECT_FOLDER, checkout)
            run("git", "checkout", "--quiet", run("git", "rev-parse", "HEAD").strip(), cwd=checkout)
            out.mkdir()
            environment = {**os.environ, "SOURCE_DATE_EPOCH": commit_time, "PYTHONPATH": str(checkout)}
            words = ["--build", out, "--wheels", wheels, "--machine", machine]
            words += [word for name in targets for word in ("--for", name)]
            command = [sys.executable, "-m", "resources.setup.release", *map(str, words)]
            if subprocess.run(command, cwd=checkout, env=environment, check=False).returncode:
                raise BundleError(f"the {number} build failed")
            write_checksums(out)
            made.append(out)
        if differ := list_differences(*made):
            raise BundleError(f"two builds of the same commit differ: {', '.join(differ)}")
        shutil.move(made[0], folder)


def main(argv: Sequence[str]) -> int:
    """Build the release and return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m resources.setup.release", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, help="new folder for the release")
    parser.add_argument("--machine", choices=GLIBC_MINOR_VERSIONS, default=platform.machine())
    parser.add_argument(
        "--for",
        dest="targets",
        action="append",
        choices=TARGETS,
        help="release for a Debian package (default: all)",
    )
    parser.add_argument("--build", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--wheels", type=Path, help=argparse.SUPPRESS)
    args = parser.parse_args(argv)
    targets = args.targets or [
        name
        for name, each in TARGETS.items()
        if each.glibc_minor_version >= GLIBC_MINOR_VERSIONS[args.machine]
    ]
    try:
        if args.build:
            build_artifacts(args.build, args.wheels, args.machine, targets)
        elif args.folder:
            build_release(args.folder, args.machine, targets)
            sys.stdout.write((args.folder / CHECKSUM_FILE_NAME).read_text(encoding="utf-8"))
        else:
            parser.error("name the folder for the release")
    except (BundleError, LicenseError, SiteError, OSError) as error:
        sys.stderr.write(f"No release: {error}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
