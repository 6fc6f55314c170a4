"""Artifacts of a release, and the commands that install, start and remove each of them.

The commands are those of ``docs/integrator/install.md``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import NamedTuple

from resources.setup.bundle import BundleError, run
from resources.setup.lock import SETUP_FOLDER
from resources.setup.packages.debian_package import TARGETS, SystemRelease

DEBIAN_RELEASES: Mapping[str, SystemRelease] = {
    "bookworm": TARGETS["debian12"],
    "trixie": TARGETS["debian13"],
}
"""Debian releases of the minimal systems, by their code names."""
_APT = "DEBIAN_FRONTEND=noninteractive apt-get -qq -y"
_FOLDER = "/srv/turndesk"  # to which the relocatable folder is moved


class ArtifactKind(StrEnum):
    """Kinds of artifacts that contain TurnDesk."""

    DEBIAN_PACKAGE = "Debian package"
    BUNDLE = "bundle"
    FOLDER = "folder"
    WHEEL = "wheel"
    SOURCE_DISTRIBUTION = "source distribution"


_FILE_NAMES: Mapping[ArtifactKind, re.Pattern[str]] = {
    ArtifactKind.DEBIAN_PACKAGE: re.compile(r"turndesk_.+\+(?P<target>[a-z]+[0-9.]+)_(?:amd64|arm64)\.deb"),
    ArtifactKind.BUNDLE: re.compile(r"turndesk-.+-linux-(?P<machine>\w+)\.run"),
    ArtifactKind.FOLDER: re.compile(r"turndesk-.+-linux-(?P<machine>\w+)-python(?P<python>[0-9.]+)\.tar\.gz"),
    ArtifactKind.WHEEL: re.compile(r"turndesk-[^-]+-py3-none-any\.whl"),
    ArtifactKind.SOURCE_DISTRIBUTION: re.compile(r"turndesk-[0-9][^-]*\.tar\.gz"),
}


class Artifact(NamedTuple):
    """Artifact with its kind, and the Debian releases on which it can be installed."""

    path: Path
    kind: ArtifactKind
    releases: tuple[str, ...]


class Installation(NamedTuple):
    """Shell commands for an artifact: ``{file}`` stands for its path.

    ``prepare`` installs the packages of the system, ``install`` the artifact, and ``upgrade`` the artifact
    over an earlier one. ``program`` is the path of the command ``turndesk``. ``needs_network`` is whether
    ``upgrade`` needs a network.
    """

    prepare: str
    install: str
    upgrade: str
    program: str
    remove: str
    needs_network: bool


def identify_artifact(path: Path) -> Artifact | None:
    """Return the artifact in a file, or None if the file does not contain TurnDesk, such as the SBOM."""
    for kind, pattern in _FILE_NAMES.items():
        if found := pattern.fullmatch(path.name):
            named = found.groupdict()
            target, python = named.get("target"), named.get("python")
            releases = tuple(
                name
                for name, each in DEBIAN_RELEASES.items()
                if target in {None, each.name} and python in {None, each.python_version}
            )
            return Artifact(path, kind, releases)
    return None


def find_artifacts(folder: Path) -> list[Artifact]:
    """Return the artifacts in the folder of a release, sorted by file name.

    Raises BundleError if the folder lacks a kind of artifact, or a file differs from its checksum.
    """
    run("sha256sum", "--check", "--quiet", "SHA256SUMS", cwd=folder)
    found = [each for path in sorted(folder.iterdir()) if (each := identify_artifact(path))]
    missing = sorted(set(ArtifactKind) - {each.kind for each in found})
    if missing:
        raise BundleError(f"{folder} contains no {', '.join(missing)}")
    return found


def list_qt_libraries() -> list[str]:
    """Return the Debian packages that Qt needs without a window."""
    text = (SETUP_FOLDER / "environment.sh").read_text(encoding="utf-8")
    return " ".join(re.findall(r'^QT_LIBRARIES="(.*)"$', text, re.MULTILINE)).split()


def list_dependencies(package: Path) -> list[str]:
    """Return the packages on which a Debian package depends, the first of each choice."""
    depends = run("dpkg-deb", "--field", package, "Depends")
    return [re.split(r"[ (|:]", each.strip())[0] for each in depends.split(",")]


def make_installation(artifact: Artifact) -> Installation:
    """Return the commands that install an artifact."""
    if artifact.kind is ArtifactKind.DEBIAN_PACKAGE:
        return Installation(
            _apt_command(list_dependencies(artifact.path)),
            "dpkg -i {file}",
            "dpkg -i {file}",
            "/usr/bin/turndesk",
            f"{_APT} remove --purge turndesk",
            needs_network=False,
        )
    if artifact.kind is ArtifactKind.BUNDLE:
        return Installation(
            ":",  # the bundle installs the packages of the system
            "sh {file}",
            "sh {file}",
            "/opt/turndesk/turndesk",
            "rm -r /opt/turndesk",
            needs_network=False,
        )
    if artifact.kind is ArtifactKind.FOLDER:
        unpack = f"mkdir /srv/unpacked && tar xf {{file}} -C /srv/unpacked && mv /srv/unpacked/* {_FOLDER}"
        return Installation(
            _apt_command(["python3", *list_qt_libraries()]),
            f"{unpack} && rmdir /srv/unpacked",
            f"rm -r {_FOLDER} && {unpack} && rmdir /srv/unpacked",
            f"{_FOLDER}/bin/turndesk",
            f"rm -r {_FOLDER}",
            needs_network=False,
        )
    return Installation(
        _apt_command(["pipx", *list_qt_libraries()]),
        "pipx install {file}",
        "pipx install --force {file}",
        "/root/.local/bin/turndesk",
        "pipx uninstall turndesk",
        needs_network=True,
    )


def _apt_command(packages: list[str]) -> str:
    return f"{_APT} update && {_APT} install --no-install-recommends {' '.join(packages)}"
