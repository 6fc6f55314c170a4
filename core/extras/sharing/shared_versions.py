"""Shared program versions that are stored on this machine: its own versions and those of other machines."""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from typing import NamedTuple


class SharedVersion(NamedTuple):
    """One version of a shared program.

    The version contains its machine, the versions from which it was made, and the SHA-256 of its text.
    ``id`` is the SHA-256 of the record, so different versions never have the same id. ``saved`` is the
    clock time of the machine in UTC; it is displayed but never compared.
    """

    id: str
    program: str
    text: str
    size: int
    follows: tuple[str, ...]
    desk: str
    saved: str
    why: str

    @property
    def program_key(self) -> str:
        """Return the key of the program. Names that differ only in case have the same key."""
        return make_program_key(self.program)


_COLUMNS = ", ".join(SharedVersion._fields)


def make_program_key(name: str) -> str:
    """Return the key of a program name, which ignores case."""
    return name.casefold()


@dataclass(frozen=True, slots=True)
class ProgramVersions:
    """All known versions of one program.

    ``local_version_id`` is the id of the version on this machine, or empty.
    """

    versions: Mapping[str, SharedVersion] = field(default_factory=dict)
    local_version_id: str = ""

    @property
    def newest_versions(self) -> tuple[SharedVersion, ...]:
        """Return the versions that have no successor.

        There is normally one such version. There are several if two machines have changed the same version.
        """
        followed = {each for version in self.versions.values() for each in version.follows}
        return tuple(version for name, version in sorted(self.versions.items()) if name not in followed)

    @property
    def newest_remote_versions(self) -> tuple[SharedVersion, ...]:
        """Return the newest versions that this machine does not have."""
        return tuple(version for version in self.newest_versions if version.id != self.local_version_id)

    @property
    def sharing_state(self) -> str:
        """Return how the program on this machine relates to other machines.

        The value is ``same`` if this machine has the newest version, ``newer`` if another machine has a
        newer version, ``both`` if both have changed the program, or ``new`` if this machine does not have
        the program.
        """
        if not self.newest_remote_versions:
            return "same"
        if not self.local_version_id:
            return "new"
        return "newer" if all(map(self.is_newer, self.newest_remote_versions)) else "both"

    def is_derived_from(self, version: str, older: str) -> bool:
        """Return whether ``version`` equals ``older`` or was made from it, directly or indirectly."""
        waiting, seen = [version], set[str]()
        while waiting:
            at = waiting.pop()
            if at == older:
                return True
            if at in self.versions and at not in seen:
                seen.add(at)
                waiting += self.versions[at].follows
        return False

    def is_newer(self, version: SharedVersion) -> bool:
        """Return whether a version was made from the local version, or True if no local version exists.

        If the result is False, either both machines have changed the program, or two different programs
        have the same name.
        """
        return not self.local_version_id or self.is_derived_from(version.id, self.local_version_id)

    def find_newer_by_text(self, text: str) -> SharedVersion | None:
        """Return a version that has this text and is newer than the local version, or None.

        ``text`` is the SHA-256 of the text. A version without a successor is preferred.
        """
        found = [each for each in self.versions.values() if each.text == text and self.is_newer(each)]
        newest = {each.id for each in self.newest_versions}
        return max(found, key=lambda each: (each.id in newest, each.id), default=None)


# --- Tables ---------------------------------------------------------------------------------------------


def read_shared_programs(
    connection: sqlite3.Connection, more_versions: Iterable[SharedVersion] = ()
) -> dict[str, ProgramVersions]:
    """Return the versions of every shared program by program key.

    The versions in ``more_versions`` are treated as known.
    """
    here = dict(connection.execute("SELECT program, version FROM shared_here").fetchall())
    found: dict[str, dict[str, SharedVersion]] = {}
    for version in (*read_all_versions(connection), *more_versions):
        found.setdefault(version.program_key, {})[version.id] = version
    return {key: ProgramVersions(versions, here.get(key, "")) for key, versions in found.items()}


def read_all_versions(connection: sqlite3.Connection) -> tuple[SharedVersion, ...]:
    """Return the versions of all programs in the order in which they became known."""
    rows = connection.execute(f"SELECT {_COLUMNS} FROM shared_versions ORDER BY rowid")
    return tuple(_version(row) for row in rows)


def read_unpublished_versions(connection: sqlite3.Connection) -> tuple[SharedVersion, ...]:
    """Return the versions with a locally stored text that the shared location does not have yet."""
    rows = connection.execute(
        f"SELECT {_COLUMNS} FROM shared_versions WHERE published = 0 AND EXISTS"
        " (SELECT 1 FROM program_versions WHERE sha256 = shared_versions.text) ORDER BY rowid"
    )
    return tuple(_version(row) for row in rows)


def read_version_text(connection: sqlite3.Connection, digest: str) -> bytes | None:
    """Return the stored text with this SHA-256, or None if it is missing or damaged."""
    for (text,) in connection.execute("SELECT text FROM program_versions WHERE sha256 = ?", (digest,)):
        if sha256(text).hexdigest() == digest:
            return bytes(text)
    return None


def add_versions(connection: sqlite3.Connection, versions: Iterable[SharedVersion]) -> None:
    """Store versions as known versions. Versions that are already known remain unchanged."""
    connection.executemany(
        f"INSERT INTO shared_versions ({_COLUMNS}) VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING",
        [(*each[:4], " ".join(each.follows), *each[5:]) for each in versions],
    )


def mark_versions_published(connection: sqlite3.Connection, versions: Iterable[SharedVersion]) -> None:
    """Mark versions as stored in the shared location."""
    connection.executemany(
        "UPDATE shared_versions SET published = 1 WHERE id = ?", [(each.id,) for each in versions]
    )


def delete_unpublished_version(connection: sqlite3.Connection, version: SharedVersion) -> None:
    """Delete a version that has not been published."""
    connection.execute("DELETE FROM shared_versions WHERE id = ? AND published = 0", (version.id,))


def set_published_versions(connection: sqlite3.Connection, version_ids: Collection[str]) -> None:
    """Mark exactly these versions as published, and all others as unpublished.

    Versions that are missing in the shared location are then published again.
    """
    rows = connection.execute("SELECT id, published FROM shared_versions").fetchall()
    changed = [
        (int(name in version_ids), name) for name, before in rows if (name in version_ids) != bool(before)
    ]
    connection.executemany("UPDATE shared_versions SET published = ? WHERE id = ?", changed)


def set_local_version(connection: sqlite3.Connection, key: str, version: str) -> None:
    """Record which version of a program is in the folder of this machine.

    An empty id means that no version is in the folder.
    """
    if not version:
        connection.execute("DELETE FROM shared_here WHERE program = ?", (key,))
        return
    connection.execute(
        "INSERT INTO shared_here VALUES (?1, ?2) ON CONFLICT (program) DO UPDATE SET version = ?2",
        (key, version),
    )


def _version(row: tuple[str, str, str, int, str, str, str, str]) -> SharedVersion:
    return SharedVersion(*row[:4], tuple(row[4].split()), *row[5:])
