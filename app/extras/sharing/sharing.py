"""Sharing of programs with other machines: publishing local versions, reading and using others.

The store of this machine is authoritative: every version is stored before it is published, and versions wait
in the store while the location is not available. Versions of other machines are never copied to the program
folder without a request.
"""

from __future__ import annotations

import sqlite3
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from hashlib import sha256
from pathlib import Path

from app.desk.programs.program_folder import ENDINGS
from app.programs.whole_file import FileError, write_new, write_whole
from core.extras.sharing import shared_versions
from core.extras.sharing.shared_place import Cause, Found, Published, SharedPlace, SharingError
from core.extras.sharing.shared_versions import Family, SharedVersion, key_of
from core.extras.sharing.version_record import MOST_BYTES, DeskState, new_version
from core.input_file import input_bytes
from core.message import CodedError, Message, error_code
from core.store import program_records
from core.store.program_records import check_name
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_rows import utc_now

_PATIENCE = 2.0  # seconds that closing waits; a thread that hangs in a dead network drive is abandoned


class SharingThread:
    """Thread that synchronizes every ``every`` seconds.

    It calls ``heard`` with each result.
    """

    def __init__(
        self,
        sharing: Sharing,
        every: float,
        heard: Callable[[Shared], None],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._sharing, self._every, self._heard = sharing, every, heard
        self._wake, self._closing = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._repeat, name="sharing", daemon=True)
        self._now, self._since = now, -1.0  # start time of the present synchronization, or negative

    def start(self) -> None:
        """Start the thread; to be called once."""
        self._thread.start()

    def look_now(self) -> None:
        """Start a synchronization now; callable from any thread, without waiting."""
        self._wake.set()

    def silent_for(self) -> float:
        """Return how long the present synchronization has waited for the location, in seconds."""
        since = self._since
        return self._now() - since if since >= 0.0 else 0.0

    def close(self) -> None:
        """Stop the thread. Unfinished work is repeated after the next start of TurnDesk."""
        self._closing.set()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join(_PATIENCE)

    def _repeat(self) -> None:
        while not self._closing.is_set():
            self._since = self._now()
            shared = self._sharing.look(settled=True)
            self._since = -1.0
            if not self._closing.is_set():
                self._heard(shared)
            self._wake.wait(self._every)
            self._wake.clear()


_AT_ONCE, _BYTES_AT_ONCE = 200, 8 * 2**20  # versions that are published together


class TakeError(CodedError):
    """Error for a version that was not copied.

    The program is unchanged, and the message states the reason.
    """


@dataclass(frozen=True, slots=True)
class Shared:
    """Immutable result of a synchronization.

    ``trouble`` is the reason why the location was not usable.
    """

    families: Mapping[str, Family] = field(default_factory=dict)
    states: Mapping[str, str] = field(default_factory=dict)  # state of each family, see ``Family.state``
    # machines that have a version, by id
    holders: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    desks: tuple[DeskState, ...] = ()
    strays: tuple[str, ...] = ()
    refused: Mapping[str, str] = field(default_factory=dict)  # files of this machine that are not shared
    waiting: int = 0  # versions that are not published yet
    trouble: str = ""

    def who_has(self, version: str) -> tuple[str, ...]:
        """Return the names of the machines that have this version in their program folder."""
        return self.holders.get(version, ())


class Sharing:
    """Sharing of programs.

    Methods can wait for disk and network, and are called on workers only.
    """

    def __init__(
        self, place: SharedPlace, desk: str, home: str, folder: Path, store: Callable[[], Store]
    ) -> None:
        self.place, self.desk, self.home = place, desk, home
        self.now = Shared()
        self._files, self._store = FilesOfMachine(folder), store
        self._lock = threading.Lock()  # for one synchronization or change at a time

    # --- synchronization -------------------------------------------------------------------------------

    def look(self, *, settled: bool = False) -> Shared:
        """Read other versions, store local changes and publish them.

        An error is set in ``trouble``.
        """
        with self._lock:
            found, trouble = None, ""
            try:
                store = self._store()
                try:
                    found = self._learn(store)
                except SharingError as error:
                    trouble = str(error)
                self._note(store, settled=settled)
                if found is not None:
                    trouble = self._publish(store, found)
                self._tell(store, found, trouble)
            except StoreError as error:  # a restore can close the store at any time
                self.now = replace(self.now, trouble=str(error))
            return self.now

    def peek(self) -> Shared:
        """Return what a synchronization would find, without storing anything. Raises StoreError."""
        with self._lock:
            store, found, trouble = self._store(), None, ""
            fresh: Sequence[SharedVersion] = ()
            try:
                with store.read() as connection:
                    known = {each.id: each for each in shared_versions.all_versions(connection)}
                found = self.place.look(known)
                fresh = found.fresh
            except SharingError as error:
                trouble = str(error)
            self._tell(store, found, trouble, fresh)
            return self.now

    def _learn(self, store: Store) -> Found:
        with store.read() as connection:
            known = {each.id: each for each in shared_versions.all_versions(connection)}
        found = self.place.look(known)

        def learn(connection: sqlite3.Connection) -> None:
            shared_versions.add(connection, found.fresh)
            shared_versions.set_there(connection, found.there)

        store.write(learn).result()
        return found

    def _note(self, store: Store, *, settled: bool) -> None:
        """Store the present files as versions, and mark programs whose file is gone."""
        files = self._files.look(settled=settled)
        store.write(partial(self._noted, files)).result()

    def _noted(self, files: Mapping[str, SharedFile], connection: sqlite3.Connection) -> None:
        families = shared_versions.families(connection)
        for key, file in files.items():
            self._note_file(connection, file, families.get(key, Family()))
        for key, family in families.items():
            if family.here and key not in self._files.present:
                shared_versions.set_here(connection, key, "")

    def _note_file(self, connection: sqlite3.Connection, file: SharedFile, family: Family) -> None:
        here = family.versions.get(family.here)
        if here is not None and here.text == file.digest:
            return
        version = family.of_text(file.digest)
        if version is None:
            try:
                text = input_bytes(file.path, MOST_BYTES)
            except OSError:
                return  # the file was deleted in the meantime
            follows = (family.here,) if here is not None else ()
            version = new_version(file.name, text, follows, self.desk, utc_now(), "saved")
            program_records.save(connection, file.name, text, "shared")
            shared_versions.add(connection, [version])
        shared_versions.set_here(connection, key_of(file.name), version.id)

    def _publish(self, store: Store, found: Found) -> str:
        """Publish local versions, and return an error or an empty string."""
        others = [each for each in found.desks if each.home != self.home]
        if any(key_of(each.desk) == key_of(self.desk) for each in others):
            return str(Cause.NAME_TAKEN.error(self.place.name, self.desk))
        state = self._state(store)
        mine = next((each for each in found.desks if each.home == self.home), None)
        told = mine is not None and (mine.desk, dict(mine.has)) == (state.desk, dict(state.has))
        try:
            for batch in self._batches(store):
                self.place.put(batch, state)
                versions = [each.version for each in batch]
                store.write(partial(_published, versions)).result()
                told = True
            if not told:
                self.place.put([], state)
        except SharingError as error:
            return str(error)
        return ""

    @staticmethod
    def _batches(store: Store) -> Iterator[Sequence[Published]]:
        with store.read() as connection:
            waiting = shared_versions.unpublished(connection)
        batch, size = list[Published](), 0
        for version in waiting:
            with store.read() as connection:
                text = shared_versions.text_of(connection, version.text)
            if text is None:
                continue
            batch.append(Published(version, text))
            size += len(text)
            if len(batch) >= _AT_ONCE or size >= _BYTES_AT_ONCE:
                yield batch
                batch, size = [], 0
        if batch:
            yield batch

    def _state(self, store: Store) -> DeskState:
        with store.read() as connection:
            families = shared_versions.families(connection)
        has = {
            each.versions[each.here].program: each.here
            for each in families.values()
            if each.here in each.versions
        }
        return DeskState(self.home, self.desk, utc_now(), has)

    def _tell(
        self, store: Store, found: Found | None, trouble: str, fresh: Sequence[SharedVersion] = ()
    ) -> None:
        with store.read() as connection:
            families = shared_versions.families(connection, fresh)
            waiting = len(shared_versions.unpublished(connection))
        desks = self.now.desks
        if found is not None:
            desks = (*(each for each in found.desks if each.home != self.home), self._state(store))
        strays = found.strays if found is not None else self.now.strays
        states = {key: family.state for key, family in families.items()}
        refused = dict(self._files.refused)
        self.now = Shared(families, states, _holders(desks), desks, strays, refused, waiting, trouble)

    # --- requests of the operator ----------------------------------------------------------------------

    def text(self, version: SharedVersion) -> bytes:
        """Return the text of a version from the store, or else from the location.

        Raises SharingError and StoreError.
        """
        with self._store().read() as connection:
            text = shared_versions.text_of(connection, version.text)
        return self.place.text(version) if text is None else text

    def text_here(self, key: str) -> bytes:
        """Return the local text of a program, or empty bytes. Raises StoreError."""
        family = self.now.families.get(key, Family())
        here = family.versions.get(family.here)
        if here is None:
            return b""
        with self._store().read() as connection:
            return shared_versions.text_of(connection, here.text) or b""

    def take(self, version: SharedVersion) -> str:
        """Copy a version into the program folder and return the file name.

        The previous text remains a version. If both sides have changed the program, the new version follows
        both, so that other machines see the conflict as resolved. Raises TakeError, SharingError and
        StoreError. The program is then unchanged.
        """
        text = self.text(version)
        with self._lock:
            store = self._store()
            self._note(store, settled=False)
            family = _family(store, version.key)
            if version.id == family.here:
                raise TakeError(
                    Message("{program} is already the selected version", program=version.program),
                    "already-current",
                )
            name = self._free_name(version)
            taken = version
            if not family.newer(version):
                follows = (family.here, version.id)
                why = Message("copied from {machine}", machine=version.desk)
                taken = new_version(name, text, follows, self.desk, utc_now(), why)
            store.write(partial(_keep, name, taken, text)).result()
            try:
                target = self._files.folder / name
                (write_whole if family.here else write_new)(target, text)
            except FileError as error:
                store.write(lambda c: shared_versions.withdraw(c, taken)).result()
                raise TakeError(str(error), error_code(error)) from error
            # After the file, because the next synchronization recognizes its text after a power failure.
            store.write(lambda c: shared_versions.set_here(c, version.key, taken.id)).result()
            self._tell(store, None, self.now.trouble)
            return name

    def keep(self, key: str) -> None:
        """Resolve a conflict in favor of the local version. Raises TakeError and StoreError."""
        with self._lock:
            store = self._store()
            self._note(store, settled=False)
            family = _family(store, key)
            here, others = family.versions.get(family.here), [each.id for each in family.elsewhere]
            if here is None or not others:
                raise TakeError(
                    "no decision is necessary, because no other control has changed this program",
                    "nothing-to-settle",
                )
            follows = (here.id, *others)
            with store.read() as connection:
                text = shared_versions.text_of(connection, here.text)
            if text is None:
                raise TakeError(
                    Message(
                        "the text of {program} differs from the saved version; save the program again",
                        program=here.program,
                    ),
                    "damaged-text",
                )
            kept = new_version(here.program, text, follows, self.desk, utc_now(), "kept")
            store.write(partial(_kept, kept)).result()
            self._tell(store, None, self.now.trouble)

    def _free_name(self, version: SharedVersion) -> str:
        """Return the name of the local file that differs only in case, or else the version's name.

        Raises TakeError.
        """
        names = [each for each in self._files.refused if key_of(each) == version.key]
        if names:
            raise TakeError(
                Message("{names}: {refused}", names=names[0], refused=self._files.refused[names[0]]),
                "refused-name",
            )
        file = self._files.look(settled=False).get(version.key)
        return file.name if file is not None else version.program


def _holders(desks: Sequence[DeskState]) -> dict[str, tuple[str, ...]]:
    found: dict[str, set[str]] = {}
    for desk in desks:
        for version in desk.has.values():
            found.setdefault(version, set()).add(desk.desk)
    return {version: tuple(sorted(names)) for version, names in found.items()}


def _family(store: Store, key: str) -> Family:
    with store.read() as connection:
        return shared_versions.families(connection).get(key, Family())


def _keep(name: str, version: SharedVersion, text: bytes, connection: sqlite3.Connection) -> None:
    program_records.save(connection, name, text, Message("shared by {machine}", machine=version.desk))
    shared_versions.add(connection, [version])


def _published(versions: Sequence[SharedVersion], connection: sqlite3.Connection) -> None:
    shared_versions.published(connection, versions)


def _kept(version: SharedVersion, connection: sqlite3.Connection) -> None:
    shared_versions.add(connection, [version])
    shared_versions.set_here(connection, version.key, version.id)


_Stamp = tuple[int, int]  # time of the last change in nanoseconds, size in bytes
_GRAIN = 2_000_000_000  # ns: a file that was just written can change again without a new time


@dataclass(frozen=True, slots=True)
class SharedFile:
    """Program file with the SHA-256 of its content."""

    name: str
    path: Path
    digest: str


@dataclass(slots=True)
class FilesOfMachine:
    """Files of the operator's folder.

    A file is read again only after a change of time or size.
    """

    folder: Path
    refused: Mapping[str, str] = field(default_factory=dict)  # reason why a file is not shared, by file name
    present: frozenset[str] = frozenset()  # keys of all files of the last scan, shared or not
    _read: dict[str, tuple[_Stamp, str]] = field(default_factory=dict)
    _seen: dict[str, _Stamp] = field(default_factory=dict)

    def look(self, *, settled: bool) -> dict[str, SharedFile]:
        """Return the files by the key of their program.

        With ``settled``, a file that is still being written is left for the next scan.
        """
        found, refused, stamps = dict[str, SharedFile](), dict[str, str](), dict[str, _Stamp]()
        names = [path.name for path in _program_files(self.folder)]
        keys = [key_of(name) for name in names]
        for name, key in zip(names, keys, strict=True):
            path = self.folder / name
            try:
                status = path.stat()
                stamps[name] = stamp = status.st_mtime_ns, status.st_size
                why = _why_not(name, status.st_size, twice=keys.count(key) > 1)
                if not why and (not settled or stamp == self._seen.get(name, stamp)):
                    found[key] = SharedFile(name, path, self._digest(path, stamp))
            except OSError as error:
                why = error.strerror or str(error)
            if why:
                refused[name] = why
        self.refused, self._seen, self.present = refused, stamps, frozenset(keys)
        return found

    def _digest(self, path: Path, stamp: _Stamp) -> str:
        before = self._read.get(path.name)
        if before is not None and before[0] == stamp:
            return before[1]
        digest = sha256(input_bytes(path, MOST_BYTES)).hexdigest()
        if time.time_ns() - stamp[0] > _GRAIN:
            self._read[path.name] = stamp, digest
        return digest


def _program_files(folder: Path) -> list[Path]:
    try:
        paths = sorted(folder.iterdir())
    except OSError:
        return []
    return [
        path
        for path in paths
        if path.suffix.lower() in ENDINGS and not path.name.startswith(".") and path.is_file()
    ]


def _why_not(name: str, size: int, *, twice: bool) -> str:
    if twice:
        return (
            "the name of another program on this control differs from the name of this "
            "program only in upper and lower case: rename one of the programs"
        )
    if size > MOST_BYTES:
        return Message("the file is larger than {most_bytes} MB", most_bytes=MOST_BYTES // 2**20)
    try:
        check_name(name)
    except StoreError as error:
        return str(error)
    return ""
