"""Build the bundle for a computer without a network: ``python -m resources.setup.bundle [FOLDER]``.

The bundle is one file with the locked wheels for all supported Python versions, TurnDesk, licenses, the
SBOM and ``install.sh``. It unpacks itself: ``sh turndesk-….run`` sets up TurnDesk. ``--system-packages``
adds the Qt libraries for the system release on which the bundle is built; ``--machine aarch64`` builds the
bundle for 64-bit ARM. Building the bundle requires a network.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

from app import VERSION
from resources.documentation.build_site import SiteError, build_site_for_packages, has_site_tools
from resources.setup.licences import PAGE_PATH, LicenseError
from resources.setup.lock import PROJECT_FOLDER, PYTHONS, SETUP_FOLDER, get_locked_file
from resources.setup.packages.reproducible_archives import normalize_member
from resources.setup.sbom import Component, build_sbom, build_system_component

GLIBC_MINOR_VERSIONS = {"x86_64": 34, "aarch64": 39}
"""Newest minor version n of glibc 2.n for which packages are selected, by processor.

Qt needs the newest glibc.
"""
_ERROR_LINE_COUNT = 16  # pip ends its output with up to 10 lines of notes after the error of a build
_OLD_NAMES = ("manylinux1", "manylinux2010", "manylinux2014")
_TEXTS = Path("/usr/share/common-licenses")  # where Debian and Ubuntu have the licences that packages share
_LICENCES = ("GPL-3", "LGPL-3")


class BundleError(Exception):
    """Error that prevents the bundle from being built; the text states the reason."""


def run(*words: object, cwd: Path = PROJECT_FOLDER) -> str:
    """Run a command in ``cwd`` and return its output.

    Raises BundleError with the last lines of the output if the command fails.
    """
    done = subprocess.run([str(each) for each in words], cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode:
        last = "\n".join((done.stderr or done.stdout).strip().splitlines()[-_ERROR_LINE_COUNT:])
        raise BundleError(f"{' '.join(map(str, words[:4]))} …:\n{last}")
    return done.stdout


def get_bundle_version() -> str:
    """Return the version of the bundle, including its commit and date if they are known."""
    try:
        day = run("git", "show", "--no-patch", "--format=%cd", "--date=format:%Y%m%d", "HEAD").strip()
        return (
            f"{VERSION}-{day}-"
            + run("git", "describe", "--always", "--dirty=-changed", "--exclude=*").strip()
        )
    except (BundleError, OSError):
        return VERSION


def list_platform_options(machine: str) -> Iterator[str]:
    """Yield the pip options for all platforms whose wheels run on this machine."""
    yield from (f"--platform=manylinux_2_{n}_{machine}" for n in range(GLIBC_MINOR_VERSIONS[machine], 4, -1))
    yield from (f"--platform={each}_{machine}" for each in reversed(_OLD_NAMES))


def fetch_wheels(folder: Path, machine: str) -> None:
    """Download all wheels that TurnDesk needs for every supported Python version.

    Pip checks each wheel against its locked hash.
    """
    for python in PYTHONS:
        for locked in ("desk", "installer"):
            words = ["--quiet", "--disable-pip-version-check", "--only-binary=:all:"]
            words += ["--require-hashes", "--no-deps", f"--dest={folder}"]
            words += [f"--python-version={python}", *list_platform_options(machine)]
            run(sys.executable, "-m", "pip", "download", *words, "-r", get_locked_file(locked))


def build_product_wheel(folder: Path) -> None:
    """Build the wheel of TurnDesk from a copy of the source.

    The copy ensures that the wheel contains no files from an earlier build.
    """
    with tempfile.TemporaryDirectory() as work:
        copy = Path(work) / "turndesk"
        copy_wheel_sources(copy)
        words = ("--quiet", "--no-deps", "--no-build-isolation", f"--wheel-dir={folder}", copy)
        run(sys.executable, "-m", "pip", "wheel", *words)


def copy_wheel_sources(folder: Path) -> None:
    """Copy the files from which the wheel is built to a new folder, including the guide."""
    folder.mkdir()
    for name in ("app", "core", "drivers", "resources", "docs"):
        shutil.copytree(PROJECT_FOLDER / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "setup.cfg", "README.md", "LICENSE"):
        shutil.copy(PROJECT_FOLDER / name, folder)


def fetch_system_packages(folder: Path) -> list[Component]:
    """Download the Debian or Ubuntu packages that the setup installs, with their dependencies.

    The folder becomes a package repository. Return the components for the SBOM.
    """
    folder.mkdir()
    wanted = re.findall(
        r'^(?:QT|WINDOW|WAYLAND)_LIBRARIES="(.*)"$',
        (SETUP_FOLDER / "environment.sh").read_text(encoding="utf-8"),
        re.MULTILINE,
    )
    with tempfile.TemporaryDirectory() as work:
        (Path(work) / "partial").mkdir()
        nothing = Path(work) / "status"
        nothing.touch()
        options = [f"Dir::State::status={nothing}", f"Dir::Cache::archives={work}", "Debug::NoLocking=1"]
        words = [word for option in options for word in ("-o", option)]
        words += ["--yes", "--no-install-recommends", "--download-only", "-qq", "install", "python3"]
        run("apt-get", *words, *" ".join(wanted).split())
        for path in sorted(Path(work).glob("*.deb")):
            shutil.copy(path, folder)
    distribution = re.findall(r"^ID=(.*)$", Path("/etc/os-release").read_text(encoding="utf-8"), re.MULTILINE)
    index, components = [], []
    for path in sorted(folder.glob("*.deb")):
        control = run("dpkg-deb", "--field", path).strip()
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        index.append(f"{control}\nFilename: ./{path.name}\nSize: {path.stat().st_size}\nSHA256: {digest}\n")
        fields = dict(re.findall(r"^(Package|Version): (.*)$", control, re.MULTILINE))
        components.append(build_system_component(fields["Package"], fields["Version"], path, distribution[0]))
    (folder / "Packages").write_text("\n".join(index), encoding="utf-8")
    return components


def get_system_release() -> str:
    """Return the name of this computer's system release, such as ``debian12``."""
    text = Path("/etc/os-release").read_text(encoding="utf-8")
    found: dict[str, str] = dict(
        re.findall(r'^(ID|VERSION_ID|VERSION_CODENAME)="?([^"\n]*)"?$', text, re.MULTILINE)
    )
    return found["ID"] + found.get("VERSION_ID", found.get("VERSION_CODENAME", ""))


def collect_bundle_files(
    folder: Path, machine: str, *, system_packages: bool, wheels: Path | None = None
) -> None:
    """Put the contents of the bundle into a folder.

    ``wheels`` is a folder of wheels that are already downloaded. If it is None, the wheels are downloaded.
    """
    fetched, wheels = wheels, folder / "wheels"
    if fetched:
        shutil.copytree(fetched, wheels)
    else:
        wheels.mkdir()
        fetch_wheels(wheels, machine)
    build_product_wheel(folder)
    system = fetch_system_packages(folder / "debs") if system_packages else []
    shutil.copytree(
        SETUP_FOLDER,
        folder,
        dirs_exist_ok=True,
        ignore=lambda _, names: [n for n in names if not _goes_along(n)],
    )
    (folder / "VERSION").write_text(get_bundle_version(), encoding="utf-8")
    document = build_sbom(get_bundle_version(), [*wheels.glob("*.whl")], system)
    (folder / "sbom.cdx.json").write_text(json.dumps(document, indent=1), encoding="utf-8")
    shutil.copy(PAGE_PATH, folder)
    (folder / "licences").mkdir()
    shutil.copy(PROJECT_FOLDER / "LICENSE", folder / "licences" / "TurnDesk")
    for name in _LICENCES:
        if not (text := _TEXTS / name).exists():
            raise BundleError(f"{text} is missing: the bundle has to hold the licences of what it passes on")
        shutil.copy(text, folder / "licences")


def _documentation() -> AbstractContextManager[object]:
    """Return a context in which the documentation site is a part of the sources, if it can be built."""
    if has_site_tools():
        return build_site_for_packages()
    sys.stderr.write("The bundle will not contain the documentation, because MkDocs is not installed.\n")
    return nullcontext()


def _goes_along(name: str) -> bool:
    return name in {"environment.sh", "install.sh", "locked-desk.txt", "locked-installer.txt"}


def write_bundle_file(folder: Path, target: Path, machine: str) -> None:
    """Write the bundle as one file that unpacks itself.

    The file starts with a script, followed by the packed contents. The script contains their SHA-256 hash.
    """
    with tempfile.TemporaryFile() as packed:
        with tarfile.open(fileobj=packed, mode="w") as archive:
            archive.add(folder, arcname=".", filter=normalize_member)
        packed.seek(0)
        digest = hashlib.file_digest(packed, "sha256").hexdigest()
        megabytes = packed.seek(0, 2) // 1_000_000 + 1
        words = {"VERSION": (folder / "VERSION").read_text(encoding="utf-8"), "MACHINE": machine}
        words |= {"NAME": target.name, "SHA256": digest, "MEGABYTES": str(megabytes)}
        start = len(_script(words | {"START": "0000"})) + 1
        packed.seek(0)
        with target.open("wb") as file:
            file.write(_script(words | {"START": f"{start:04d}"}))
            shutil.copyfileobj(packed, file)


def _script(words: dict[str, str]) -> bytes:
    """Return the script at the start of the bundle, with its placeholders replaced by ``words``."""
    text = (SETUP_FOLDER / "unpack.sh").read_text(encoding="utf-8")
    return re.sub("@([A-Z0-9]+)@", lambda found: words[found[1]], text).encode()


def main(argv: list[str]) -> int:
    """Build the bundle and return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m resources.setup.bundle", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(), help="where it is put")
    parser.add_argument("--machine", choices=GLIBC_MINOR_VERSIONS, default=platform.machine())
    parser.add_argument("--system-packages", action="store_true", help="with the libraries of this release")
    args = parser.parse_args(argv)
    if args.system_packages and args.machine != platform.machine():
        parser.error(f"--system-packages for {args.machine} can be had on such a computer only")
    release = f"-{get_system_release()}" if args.system_packages else ""
    target = args.folder / f"turndesk-{get_bundle_version()}-linux-{args.machine}{release}.run"
    try:
        with tempfile.TemporaryDirectory() as work, _documentation():
            collect_bundle_files(Path(work), args.machine, system_packages=args.system_packages)
            write_bundle_file(Path(work), target, args.machine)
    except (BundleError, LicenseError, SiteError, OSError) as error:
        sys.stderr.write(f"No bundle: {error}\n")
        return 1
    sys.stdout.write(f"{target}: {target.stat().st_size // 1_000_000} MB\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
