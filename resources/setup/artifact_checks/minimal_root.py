"""Minimal root file systems of Debian releases, in which the artifacts are installed.

``debootstrap`` makes each of them from the package sources of this computer.
"""

from __future__ import annotations

import os
import platform
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from resources.setup.bundle import run

_MOUNTS = ("proc", "sys", "dev")
_CERTIFICATE_VARIABLES = ("PIP_CERT", "SSL_CERT_FILE", "REQUESTS_CA_BUNDLE", "CURL_CA_BUNDLE")
_NETWORK_FILES = ("/etc/pip.conf", "/etc/resolv.conf")
_CERTIFICATES = Path("/etc/ssl/certificates-of-host.crt")
"""Copy of this computer's certificates, which the package ``ca-certificates`` does not overwrite."""
_NETWORK_VARIABLES = (
    "PIP_DEFAULT_TIMEOUT",
    "PIP_INDEX_URL",
    "UV_DEFAULT_INDEX",
    "http_proxy",
    "https_proxy",
    "no_proxy",
)
_ENVIRONMENT = (
    "HOME=/root",
    "LC_ALL=C.UTF-8",
    "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
)


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


def copy_index_settings(root: Path) -> None:
    """Copy the settings and certificates with which this computer reaches the Python package index."""
    named = [Path(os.environ[name]) for name in _CERTIFICATE_VARIABLES if os.environ.get(name)]
    copies = [(Path(name), Path(name)) for name in _NETWORK_FILES]
    copies += [(path, _CERTIFICATES) for path in named if path.is_file()][:1]
    for path, place in copies:
        target = root / place.relative_to("/")
        with suppress(FileNotFoundError):
            content = path.read_bytes()
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)


def make_base_root(release: str, folder: Path) -> Path:
    """Make the minimal root file system of a Debian release in a folder, and return its path.

    It uses the package sources of this computer for that release.
    """
    base = folder / f"base-{release}"
    run("debootstrap", "--variant=minbase", release, base)
    copy_package_sources(Path("/etc/apt"), base / "etc" / "apt", release)
    copy_index_settings(base)
    return base


@contextmanager
def open_root_copy(base: Path) -> Iterator[Path]:
    """Yield a copy of a root file system with its mounts, and delete the copy afterwards."""
    root = base.with_name(f"{base.name}-in-use")
    run("cp", "--archive", "--reflink=auto", base, root)
    mounted = []
    try:
        for name in _MOUNTS:
            run("mount", "--bind", f"/{name}", root / name)
            mounted.append(name)
        yield root
    finally:
        for name in reversed(mounted):
            run("umount", "--lazy", root / name)
        run("rm", "--recursive", "--force", "--one-file-system", root)


def run_in_root(root: Path, command: str, *, has_network: bool = True) -> str:
    """Run a shell command in the root file system, and return its output.

    The command sees only the environment variables that lead to the network, and no network at all if
    ``has_network`` is false. Raises BundleError if the command fails.
    """
    passed = [f"{name}={os.environ[name]}" for name in _NETWORK_VARIABLES if os.environ.get(name)]
    if (root / _CERTIFICATES.relative_to("/")).is_file():
        passed += [f"{name}={_CERTIFICATES}" for name in _CERTIFICATE_VARIABLES]
    without_network = () if has_network else ("unshare", "--net")
    words = ("env", "--ignore-environment", *_ENVIRONMENT, *passed, "chroot", root, "sh", "-c", command)
    return run(*without_network, *words)
