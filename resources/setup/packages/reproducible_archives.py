"""Archives that are byte-for-byte identical for the same files.

The files are sorted, and have the same owner and timestamp.
"""

from __future__ import annotations

import gzip
import io
import os
import tarfile
from collections.abc import Callable
from pathlib import Path


def get_release_time() -> int:
    """Return the timestamp for all files of a release, in seconds since 1970 (``SOURCE_DATE_EPOCH``)."""
    return int(os.environ.get("SOURCE_DATE_EPOCH", "0"))


def normalize_member(member: tarfile.TarInfo) -> tarfile.TarInfo:
    """Set the owner and the time of an archive member, and return this member.

    The owner becomes root, and the time becomes the release time.
    """
    member.uid = member.gid = 0
    member.uname = member.gname = "root"
    member.mtime = get_release_time()
    return member


def write_tar_gz(folder: Path, target: Path, name: str) -> None:
    """Write the files of a folder to a compressed archive, inside a top-level folder ``name``."""
    with (
        target.open("wb") as file,
        gzip.GzipFile("", "wb", 6, file, mtime=get_release_time()) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.GNU_FORMAT) as archive,
    ):
        archive.add(folder, name, filter=normalize_member)


def repack_tar_gz(path: Path, convert: Callable[[str, bytes], bytes]) -> None:
    """Rewrite a compressed archive, so that its members are sorted and have one owner and one time.

    ``convert`` returns the new content of each file; its arguments are the path in the archive and the
    content.
    """
    made = io.BytesIO()
    with (
        tarfile.open(path) as old,
        gzip.GzipFile("", "wb", 9, made, mtime=get_release_time()) as packed,
        tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as new,
    ):
        for member in sorted(old.getmembers(), key=lambda each: each.name):
            file = old.extractfile(member) if member.isfile() else None
            content = convert(member.name, file.read()) if file else b""
            member.size = len(content)
            member.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
            member.pax_headers = {}
            new.addfile(normalize_member(member), io.BytesIO(content))
    path.write_bytes(made.getvalue())


def _is_command(path: Path) -> bool:
    """Return whether a file is a command: an executable outside the packages, or a program of Qt."""
    is_package = "site-packages" in path.parts
    return bool(path.stat().st_mode & 0o100) and (not is_package or path.parent.name == "libexec")


def set_times(folder: Path) -> None:
    """Set the time and the mode of everything in a folder.

    The time is the release time, and the modes do not depend on the umask. Only commands remain executable;
    the executable bit of libraries and modules is cleared.
    """
    for path in (folder, *folder.rglob("*")):
        if not path.is_symlink():
            path.chmod(0o755 if path.is_dir() or _is_command(path) else 0o644)
        os.utime(path, (get_release_time(), get_release_time()), follow_symlinks=False)
