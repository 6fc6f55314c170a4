"""Versions of programs that desks share, as this desk keeps them: its own, and those of others."""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from typing import NamedTuple


class SharedVersion(NamedTuple):
    """One version of a program: whose it is, what it was made from, and the SHA-256 of its text.

    ``id`` is SHA-256 of its record, so that two desks never give the same one to different versions.
    ``saved`` is what the clock of that desk said (UTC): shown, and never compared.
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
    def key(self) -> str:
        """Of its program: names that differ by case only are one program."""
        return key_of(self.program)


_COLUMNS = ", ".join(SharedVersion._fields)


def key_of(name: str) -> str:
    """The program that a name means, whatever the case of its letters."""
    return name.casefold()


@dataclass(frozen=True, slots=True)
class Family:
    """All that is known of one program's versions. ``here`` is the id of the one that this machine has."""

    versions: Mapping[str, SharedVersion] = field(default_factory=dict)
    here: str = ""

    @property
    def newest(self) -> tuple[SharedVersion, ...]:
        """Those that no other follows: one, unless two desks have changed the same version."""
        followed = {each for version in self.versions.values() for each in version.follows}
        return tuple(version for name, version in sorted(self.versions.items()) if name not in followed)

    @property
    def elsewhere(self) -> tuple[SharedVersion, ...]:
        """The newest ones that this machine does not have."""
        return tuple(version for version in self.newest if version.id != self.here)

    @property
    def state(self) -> str:
        """``same``: here is the newest; ``newer`` elsewhere; ``both`` changed; ``new``: not here yet."""
        if not self.elsewhere:
            return "same"
        if not self.here:
            return "new"
        return "newer" if all(map(self.newer, self.elsewhere)) else "both"

    def made_from(self, version: str, older: str) -> bool:
        """Whether ``version`` is ``older`` or was made from it, over however many desks."""
        waiting, seen = [version], set[str]()
        while waiting:
            at = waiting.pop()
            if at == older:
                return True
            if at in self.versions and at not in seen:
                seen.add(at)
                waiting += self.versions[at].follows
        return False

    def newer(self, version: SharedVersion) -> bool:
        """Whether it was made from what this machine has; else both were changed, or are of one name only."""
        return not self.here or self.made_from(version.id, self.here)

    def of_text(self, text: str) -> SharedVersion | None:
        """A version with this text (SHA-256) that comes after what this machine has; the newest, if any."""
        found = [each for each in self.versions.values() if each.text == text and self.newer(each)]
        newest = {each.id for each in self.newest}
        return max(found, key=lambda each: (each.id in newest, each.id), default=None)


# --- the tables -----------------------------------------------------------------------------------------


def families(connection: sqlite3.Connection, more: Iterable[SharedVersion] = ()) -> dict[str, Family]:
    """Every shared program by its key; with ``more`` versions as if they were known already."""
    here = dict(connection.execute("SELECT program, version FROM shared_here").fetchall())
    found: dict[str, dict[str, SharedVersion]] = {}
    for version in (*all_versions(connection), *more):
        found.setdefault(version.key, {})[version.id] = version
    return {key: Family(versions, here.get(key, "")) for key, versions in found.items()}


def all_versions(connection: sqlite3.Connection) -> tuple[SharedVersion, ...]:
    """Those of all programs, in the order in which they became known."""
    rows = connection.execute(f"SELECT {_COLUMNS} FROM shared_versions ORDER BY rowid")
    return tuple(_version(row) for row in rows)


def unpublished(connection: sqlite3.Connection) -> tuple[SharedVersion, ...]:
    """Versions that the shared place does not have and whose text is kept here."""
    rows = connection.execute(
        f"SELECT {_COLUMNS} FROM shared_versions WHERE published = 0 AND EXISTS"
        " (SELECT 1 FROM program_versions WHERE sha256 = shared_versions.text) ORDER BY rowid"
    )
    return tuple(_version(row) for row in rows)


def text_of(connection: sqlite3.Connection, digest: str) -> bytes | None:
    """A text of this SHA-256 that is kept here; None: there is none, or it is not as it was saved."""
    for (text,) in connection.execute("SELECT text FROM program_versions WHERE sha256 = ?", (digest,)):
        if sha256(text).hexdigest() == digest:
            return bytes(text)
    return None


def add(connection: sqlite3.Connection, versions: Iterable[SharedVersion]) -> None:
    """Versions become known; what is known already stays as it is."""
    connection.executemany(
        f"INSERT INTO shared_versions ({_COLUMNS}) VALUES (?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING",
        [(*each[:4], " ".join(each.follows), *each[5:]) for each in versions],
    )


def published(connection: sqlite3.Connection, versions: Iterable[SharedVersion]) -> None:
    """The shared place has taken these."""
    connection.executemany(
        "UPDATE shared_versions SET published = 1 WHERE id = ?", [(each.id,) for each in versions]
    )


def withdraw(connection: sqlite3.Connection, version: SharedVersion) -> None:
    """A version that came to nothing before anybody else knew of it."""
    connection.execute("DELETE FROM shared_versions WHERE id = ? AND published = 0", (version.id,))


def set_there(connection: sqlite3.Connection, there: Collection[str]) -> None:
    """These and no others are in the shared place: what has gone from it is published again."""
    rows = connection.execute("SELECT id, published FROM shared_versions").fetchall()
    changed = [(int(name in there), name) for name, before in rows if (name in there) != bool(before)]
    connection.executemany("UPDATE shared_versions SET published = ? WHERE id = ?", changed)


def set_here(connection: sqlite3.Connection, key: str, version: str) -> None:
    """This machine has this version of the program in its folder; empty: none any more."""
    if not version:
        connection.execute("DELETE FROM shared_here WHERE program = ?", (key,))
        return
    connection.execute(
        "INSERT INTO shared_here VALUES (?1, ?2) ON CONFLICT (program) DO UPDATE SET version = ?2",
        (key, version),
    )


def _version(row: tuple[str, str, str, int, str, str, str, str]) -> SharedVersion:
    return SharedVersion(*row[:4], tuple(row[4].split()), *row[5:])
