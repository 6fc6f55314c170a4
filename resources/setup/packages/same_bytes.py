"""Archives with the same bytes for the same files: sorted, of one owner and of one time."""

from __future__ import annotations

import gzip
import io
import os
import tarfile
from pathlib import Path


def epoch() -> int:
    """Return the time that all files of a release have, in seconds since 1970 (``SOURCE_DATE_EPOCH``)."""
    return int(os.environ.get("SOURCE_DATE_EPOCH", "0"))


def owned_by_root(member: tarfile.TarInfo) -> tarfile.TarInfo:
    """Return a member of an archive without its owner and its time."""
    member.uid = member.gid = 0
    member.uname = member.gname = "root"
    member.mtime = epoch()
    return member


def write_tar_gz(folder: Path, target: Path, name: str) -> None:
    """Write the files of a folder to a compressed archive, below the folder ``name``."""
    with (
        target.open("wb") as file,
        gzip.GzipFile("", "wb", 6, file, mtime=epoch()) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.GNU_FORMAT) as archive,
    ):
        archive.add(folder, name, filter=owned_by_root)


def repack_tar_gz(path: Path) -> None:
    """Write a compressed archive again, with its members sorted, of one owner and of one time."""
    made = io.BytesIO()
    with (
        tarfile.open(path) as old,
        gzip.GzipFile("", "wb", 9, made, mtime=epoch()) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as new,
    ):
        for member in sorted(old.getmembers(), key=lambda each: each.name):
            content = old.extractfile(member) if member.isfile() else None
            member.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
            member.pax_headers = {}
            new.addfile(owned_by_root(member), content)
    path.write_bytes(made.getvalue())


def _is_command(path: Path) -> bool:
    """Return whether a file is a command: a script outside of the packages, or a program of Qt."""
    is_package = "site-packages" in path.parts
    return bool(path.stat().st_mode & 0o100) and (not is_package or path.parent.name == "libexec")


def set_times(folder: Path) -> None:
    """Give everything in a folder the time of the release, and rights that do not depend on the umask.

    Of the files that can be executed, only commands remain so: libraries and modules are only read.
    """
    for path in (folder, *folder.rglob("*")):
        if not path.is_symlink():
            path.chmod(0o755 if path.is_dir() or _is_command(path) else 0o644)
        os.utime(path, (epoch(), epoch()), follow_symlinks=False)
