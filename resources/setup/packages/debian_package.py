"""Debian package with TurnDesk in ``/opt/turndesk``.

The package also contains a menu entry, a manual page, shell completions and systemd units.
"""

from __future__ import annotations

import gzip
import re
import shutil
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from app.cli.actions.desktop_entry import format_desktop_entry
from resources.setup.bundle import BundleError, run
from resources.setup.licences import PAGE_PATH, parse_page
from resources.setup.lock import PROJECT_FOLDER
from resources.setup.packages.environment_folder import DEBIAN_FOLDER
from resources.setup.packages.manual_page import format_manual_page
from resources.setup.packages.reproducible_archives import get_release_time, set_times

ARCHITECTURES = {"x86_64": "amd64", "aarch64": "arm64"}
COMPLETIONS = {
    "bash": "usr/share/bash-completion/completions/turndesk",
    "zsh": "usr/share/zsh/vendor-completions/_turndesk",
    "fish": "usr/share/fish/vendor_completions.d/turndesk.fish",
}
_SCRIPTS = ("postinst", "prerm", "postrm")
_CONFIGURATION = "etc/security/limits.d/turndesk.conf"


class SystemRelease(NamedTuple):
    """System release for which the package is built.

    ``python_version`` is the version of its Python, and ``glibc_minor_version`` is n of its glibc version
    2.n.
    """

    name: str
    python_version: str
    glibc_minor_version: int


TARGETS = {
    each.name: each
    for each in (
        SystemRelease("debian12", "3.11", 36),
        SystemRelease("ubuntu24.04", "3.12", 39),
        SystemRelease("debian13", "3.13", 41),
    )
}


def get_debian_version(version: str, target: SystemRelease) -> str:
    """Return the version of the Debian package, such as ``0.1.0~202612010830.1a2b3c4+debian12``.

    A version with a commit sorts before the release with the same number. Raises BundleError if the
    checkout has uncommitted changes.
    """
    number, _, commit = version.partition("-")
    if "changed" in commit:
        raise BundleError(f"{version}: the checkout has changes that are not committed")
    minute = time.strftime("%Y%m%d%H%M", time.gmtime(get_release_time()))
    between = f"~{minute}.{commit.rpartition('-')[2]}" if commit else ""
    return f"{number}{between}+{target.name}"


def write_debian_package(
    environment: Path, version: str, target: SystemRelease, machine: str, folder: Path
) -> Path:
    """Write the Debian package of an environment folder, which is moved into the package.

    Raises BundleError if a command fails.
    """
    stated = get_debian_version(version, target)
    root = folder / f"root-{target.name}"
    inside = root / "opt" / "turndesk" / version
    inside.parent.mkdir(parents=True)
    shutil.move(environment, inside)
    _shared_files(root, version)
    size = sum(path.lstat().st_size for path in root.rglob("*") if not path.is_dir()) // 1024 + 1
    words = {"VERSION": stated, "ARCHITECTURE": ARCHITECTURES[machine], "PYTHON": target.python_version}
    words |= {"GLIBC": str(34 if machine == "x86_64" else 39), "SIZE": str(size), "FOLDER": version}
    _control_files(root / "DEBIAN", words)
    set_times(root)
    package = folder / f"turndesk_{stated}_{ARCHITECTURES[machine]}.deb"
    run("dpkg-deb", "--root-owner-group", "-Zxz", "-z1", "--build", root, package)
    shutil.rmtree(root)
    return package


def _shared_files(root: Path, version: str) -> None:
    """Write all files of the package that are outside of ``/opt``."""
    command = _file(root / "usr/bin/turndesk")
    command.symlink_to(f"/opt/turndesk/{version}/bin/turndesk")
    _write(root, "usr/share/applications/turndesk.desktop", format_desktop_entry("/usr/bin/turndesk %f"))
    for name, place in (
        ("desktop/turndesk.svg", "usr/share/icons/hicolor/scalable/apps/turndesk.svg"),
        ("desktop/turndesk.xml", "usr/share/mime/packages/turndesk.xml"),
        ("setup/debian/turndesk-kiosk@.service", "usr/lib/systemd/system/turndesk-kiosk@.service"),
        ("setup/debian/kiosk-openbox.xml", "usr/share/turndesk/kiosk-openbox.xml"),
        ("setup/debian/kiosk", "usr/share/turndesk/kiosk"),
        ("setup/debian/limits.conf", _CONFIGURATION),
        ("setup/debian/lintian-overrides", "usr/share/lintian/overrides/turndesk"),
    ):
        shutil.copyfile(PROJECT_FOLDER / "resources" / name, _file(root / place))
    (root / "usr/share/turndesk/kiosk").chmod(0o755)
    for shell, place in COMPLETIONS.items():
        script = run(sys.executable, "-m", "app.cli.main", "setup", "completion", shell)
        _write(root, place, f"#compdef turndesk\n{script}" if shell == "zsh" else script)
    _write_packed(root, "usr/share/man/man1/turndesk.1.gz", format_manual_page())
    _write_packed(
        root,
        "usr/share/doc/turndesk/changelog.gz",
        (PROJECT_FOLDER / "CHANGELOG.md").read_text(encoding="utf-8"),
    )
    _write(root, "usr/share/doc/turndesk/copyright", _copyright())


def _control_files(folder: Path, words: Mapping[str, str]) -> None:
    folder.mkdir()
    for name in ("control", *_SCRIPTS):
        text = (DEBIAN_FOLDER / name).read_text(encoding="utf-8")
        path = folder / name
        path.write_text(re.sub("@([A-Z]+)@", lambda found: words[found[1]], text), encoding="utf-8")
        if name in _SCRIPTS:
            path.chmod(0o755)
    (folder / "conffiles").write_text(f"/{_CONFIGURATION}\n", encoding="utf-8")


def _copyright() -> str:
    """Return the licenses of TurnDesk and its packages in Debian's machine-readable format."""
    license_text = (PROJECT_FOLDER / "LICENSE").read_text(encoding="utf-8")
    mit = "\n".join(f" {line}" if line.strip() else " ." for line in license_text.splitlines())
    parts = [
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/",
        "Upstream-Name: TurnDesk\n",
        f"Files: *\nCopyright: TurnDesk contributors\nLicense: MIT\n{mit}\n",
        "Files: opt/turndesk/*/lib/*/site-packages/turndesk/resources/fonts/*",
        "Copyright: the B612 project\nLicense: OFL-1.1",
        " The text is in OFL.txt, in the folder of the fonts.\n",
        "Files: opt/turndesk/*/lib/*/site-packages/turndesk/resources/documents/assets/*",
        "Copyright: Martin Donath, the authors of Material for MkDocs, and Oliver Nightingale (lunr)",
        f"License: MIT\n{mit}\n",
    ]
    for row in parse_page(PAGE_PATH.read_text(encoding="utf-8").partition("## Only for")[0]):
        name = row.name.replace("-", "?")
        parts.append(
            f"Files: opt/turndesk/*/lib/*/site-packages/{name}*\n"
            f"Copyright: the authors of {row.name}, who are named in its license texts\n"
            f"License: {row.license_expression.strip().replace(' OR ', ' or ').replace(' AND ', ' and ')}\n"
            f" The texts are in the folder {row.name}-{row.version}.dist-info next to the package, and in\n"
            " /usr/share/common-licenses.\n"
        )
    return "\n".join(parts)


def _file(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def _write(root: Path, place: str, text: str) -> None:
    _file(root / place).write_text(text.rstrip("\n") + "\n", encoding="utf-8")


def _write_packed(root: Path, place: str, text: str) -> None:
    _file(root / place).write_bytes(gzip.compress(text.encode(), 9, mtime=0))
