"""Program sharing, which publishes local versions and reads the versions of other machines.

Every local version is stored in the store of this machine before it is published. While the shared location
is not available, local versions wait in the store. Versions of other machines are copied to the program
folder only on request.
"""

from __future__ import annotations

import sqlite3
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from app.extras.sharing.local_program_files import LocalProgramFiles, ProgramFile
from app.programs.atomic_files import FileOperationError, write_new_file, write_program_file
from core.extras.sharing import shared_versions
from core.extras.sharing.shared_location import (
    Found,
    PublishedVersion,
    SharedLocation,
    SharingError,
    SharingErrorCause,
)
from core.extras.sharing.shared_versions import ProgramVersions, SharedVersion, make_program_key
from core.extras.sharing.version_record import MAX_PROGRAM_BYTES, PublishedMachineState, make_version
from core.input_file import read_input_bytes
from core.message import CodedError, Message, get_error_code
from core.store import program_records
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_rows import get_utc_now_text

_PATIENCE = 2.0  # seconds that closing waits; a thread that hangs in a dead network drive is abandoned


class SharingThread:
    """Thread that synchronizes shared programs at regular intervals.

    ``interval_s`` is the interval in seconds. ``result_handler`` is called with each result.
    """

    def __init__(
        self,
        sharing: ProgramSharing,
        interval_s: float,
        result_handler: Callable[[SharingResult], None],
        read_clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._sharing, self._every, self._heard = sharing, interval_s, result_handler
        self._wake, self._closing = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._repeat, name="sharing", daemon=True)
        self._now, self._since = read_clock, -1.0  # start time of the present synchronization, or negative

    def start(self) -> None:
        """Start the thread.

        This method may be called only once.
        """
        self._thread.start()

    def synchronize_now(self) -> None:
        """Start a synchronization now, and return without waiting for its end.

        This method can be called from any thread.
        """
        self._wake.set()

    def get_waiting_time_s(self) -> float:
        """Return how long the current synchronization has waited for the shared location, in seconds."""
        since = self._since
        return self._now() - since if since >= 0.0 else 0.0

    def close(self) -> None:
        """Stop the thread. Incomplete work is repeated when TurnDesk runs again."""
        self._closing.set()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join(_PATIENCE)

    def _repeat(self) -> None:
        while not self._closing.is_set():
            self._since = self._now()
            shared = self._sharing.synchronize(is_settled=True)
            self._since = -1.0
            if not self._closing.is_set():
                self._heard(shared)
            self._wake.wait(self._every)
            self._wake.clear()


_AT_ONCE, _BYTES_AT_ONCE = 200, 8 * 2**20  # versions that are published together


class VersionCopyError(CodedError):
    """Error raised if a version could not be copied to the program folder.

    The program is then unchanged. The message states the reason.
    """


@dataclass(frozen=True, slots=True)
class SharingResult:
    """Immutable result of a synchronization with the shared location.

    ``error_text`` is the reason why the location could not be used, or an empty string.
    """

    versions_by_program: Mapping[str, ProgramVersions] = field(default_factory=dict)
    states_by_program: Mapping[str, str] = field(
        default_factory=dict
    )  # state of each family, see ``ProgramVersions.sharing_state``
    # machines that have a version, by id
    machines_by_version: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    machine_states: tuple[PublishedMachineState, ...] = ()
    foreign_items: tuple[str, ...] = ()
    rejected_files: Mapping[str, str] = field(
        default_factory=dict
    )  # files of this machine that are not shared
    unpublished_version_count: int = 0  # versions that are not published yet
    error_text: str = ""

    def find_machines_with_version(self, version_id: str) -> tuple[str, ...]:
        """Return the names of the machines that have a version in their program folder."""
        return self.machines_by_version.get(version_id, ())


class ProgramSharing:
    """Synchronization of the local programs with the shared location.

    The methods can wait for the disk or the network, so only workers may call them.
    """

    def __init__(
        self,
        location: SharedLocation,
        machine_name: str,
        machine_id: str,
        program_folder: Path,
        get_store: Callable[[], Store],
    ) -> None:
        self.location, self.machine_name, self.machine_id = location, machine_name, machine_id
        self.last_result = SharingResult()
        self._files, self._store = LocalProgramFiles(program_folder), get_store
        self._lock = threading.Lock()  # for one synchronization or change at a time

    # --- synchronization -------------------------------------------------------------------------------

    def synchronize(self, *, is_settled: bool = False) -> SharingResult:
        """Read remote versions, store local changes, and publish local versions.

        If the location cannot be used, ``error_text`` of the result contains the reason.
        """
        with self._lock:
            found, error_text = None, ""
            try:
                store = self._store()
                try:
                    found = self._learn(store)
                except SharingError as error:
                    error_text = str(error)
                self._note(store, is_settled=is_settled)
                if found is not None:
                    error_text = self._publish(store, found)
                self._tell(store, found, error_text)
            except StoreError as error:  # a restore can close the store at any time
                self.last_result = replace(self.last_result, error_text=str(error))
            return self.last_result

    def preview_synchronization(self) -> SharingResult:
        """Return the result that a synchronization would have, without storing anything.

        Raises StoreError if the store cannot be read.
        """
        with self._lock:
            store, found, error_text = self._store(), None, ""
            fresh: Sequence[SharedVersion] = ()
            try:
                with store.read() as connection:
                    known = {each.id: each for each in shared_versions.read_all_versions(connection)}
                found = self.location.read_contents(known)
                fresh = found.unknown_versions
            except SharingError as error:
                error_text = str(error)
            self._tell(store, found, error_text, fresh)
            return self.last_result

    def _learn(self, store: Store) -> Found:
        with store.read() as connection:
            known = {each.id: each for each in shared_versions.read_all_versions(connection)}
        found = self.location.read_contents(known)

        def store_found_versions(connection: sqlite3.Connection) -> None:
            shared_versions.add_versions(connection, found.unknown_versions)
            shared_versions.set_published_versions(connection, found.stored_ids)

        store.write(store_found_versions).result()
        return found

    def _note(self, store: Store, *, is_settled: bool) -> None:
        """Store the current program files as versions, and mark programs whose files no longer exist."""
        files = self._files.read_files(is_settled=is_settled)
        store.write(partial(self._noted, files)).result()

    def _noted(self, files: Mapping[str, ProgramFile], connection: sqlite3.Connection) -> None:
        families = shared_versions.read_shared_programs(connection)
        for key, file in files.items():
            self._note_file(connection, file, families.get(key, ProgramVersions()))
        for key, family in families.items():
            if family.local_version_id and key not in self._files.program_keys:
                shared_versions.set_local_version(connection, key, "")

    def _note_file(self, connection: sqlite3.Connection, file: ProgramFile, family: ProgramVersions) -> None:
        here = family.versions.get(family.local_version_id)
        if here is not None and here.text == file.sha256_digest:
            return
        version = family.find_newer_by_text(file.sha256_digest)
        if version is None:
            try:
                text = read_input_bytes(file.path, MAX_PROGRAM_BYTES)
            except OSError:
                return  # the file was deleted in the meantime
            follows = (family.local_version_id,) if here is not None else ()
            version = make_version(file.name, text, follows, self.machine_name, get_utc_now_text(), "saved")
            program_records.save_program_version(connection, file.name, text, "shared")
            shared_versions.add_versions(connection, [version])
        shared_versions.set_local_version(connection, make_program_key(file.name), version.id)

    def _publish(self, store: Store, found: Found) -> str:
        """Publish the local versions. Return an error message, or an empty string if there is no error."""
        others = [each for each in found.machine_states if each.machine_id != self.machine_id]
        if any(make_program_key(each.machine_name) == make_program_key(self.machine_name) for each in others):
            return str(SharingErrorCause.NAME_TAKEN.make_error(self.location.name, self.machine_name))
        state = self._state(store)
        mine = next((each for each in found.machine_states if each.machine_id == self.machine_id), None)
        is_state_published = mine is not None and (mine.machine_name, dict(mine.version_ids)) == (
            state.machine_name,
            dict(state.version_ids),
        )
        try:
            for batch in self._batches(store):
                self.location.publish_versions(batch, state)
                versions = [each.version for each in batch]
                store.write(partial(_published, versions)).result()
                is_state_published = True
            if not is_state_published:
                self.location.publish_versions([], state)
        except SharingError as error:
            return str(error)
        return ""

    @staticmethod
    def _batches(store: Store) -> Iterator[Sequence[PublishedVersion]]:
        with store.read() as connection:
            waiting = shared_versions.read_unpublished_versions(connection)
        batch, size = list[PublishedVersion](), 0
        for version in waiting:
            with store.read() as connection:
                text = shared_versions.read_version_text(connection, version.text)
            if text is None:
                continue
            batch.append(PublishedVersion(version, text))
            size += len(text)
            if len(batch) >= _AT_ONCE or size >= _BYTES_AT_ONCE:
                yield batch
                batch, size = [], 0
        if batch:
            yield batch

    def _state(self, store: Store) -> PublishedMachineState:
        with store.read() as connection:
            families = shared_versions.read_shared_programs(connection)
        has = {
            each.versions[each.local_version_id].program: each.local_version_id
            for each in families.values()
            if each.local_version_id in each.versions
        }
        return PublishedMachineState(self.machine_id, self.machine_name, get_utc_now_text(), has)

    def _tell(
        self, store: Store, found: Found | None, error_text: str, fresh: Sequence[SharedVersion] = ()
    ) -> None:
        with store.read() as connection:
            families = shared_versions.read_shared_programs(connection, fresh)
            waiting = len(shared_versions.read_unpublished_versions(connection))
        desks = self.last_result.machine_states
        if found is not None:
            desks = (
                *(each for each in found.machine_states if each.machine_id != self.machine_id),
                self._state(store),
            )
        strays = found.foreign_item_names if found is not None else self.last_result.foreign_items
        states = {key: family.sharing_state for key, family in families.items()}
        refused = dict(self._files.rejected_files)
        self.last_result = SharingResult(
            families, states, _holders(desks), desks, strays, refused, waiting, error_text
        )

    # --- requests of the operator ----------------------------------------------------------------------

    def read_version_text(self, version: SharedVersion) -> bytes:
        """Return the text of a version from the store, or else from the shared location.

        Raises StoreError or SharingError if the text cannot be read.
        """
        with self._store().read() as connection:
            text = shared_versions.read_version_text(connection, version.text)
        return self.location.read_text(version) if text is None else text

    def read_local_text(self, program_key: str) -> bytes:
        """Return the local text of a program, or empty bytes if there is no local version.

        Raises StoreError if the store cannot be read.
        """
        family = self.last_result.versions_by_program.get(program_key, ProgramVersions())
        here = family.versions.get(family.local_version_id)
        if here is None:
            return b""
        with self._store().read() as connection:
            return shared_versions.read_version_text(connection, here.text) or b""

    def copy_version(self, version: SharedVersion) -> str:
        """Copy a version into the program folder and return the file name.

        The previous text remains stored as a version. If both machines have changed the program, the copy
        is stored as the successor of both versions, so that other machines see that the conflict is
        resolved.

        Raises VersionCopyError, SharingError or StoreError if the copy fails. The program is then usually
        unchanged. If the store fails after the file was replaced, the next synchronization recognizes the
        new text.
        """
        text = self.read_version_text(version)
        with self._lock:
            store = self._store()
            self._note(store, is_settled=False)
            family = _family(store, version.program_key)
            if version.id == family.local_version_id:
                raise VersionCopyError(
                    Message("{program} is already the selected version", program=version.program),
                    "already-current",
                )
            name = self._free_name(version)
            taken = version
            if not family.is_newer(version):
                follows = (family.local_version_id, version.id)
                why = Message("copied from {machine}", machine=version.desk)
                taken = make_version(name, text, follows, self.machine_name, get_utc_now_text(), why)
            store.write(partial(_keep, name, taken, text)).result()
            try:
                target = self._files.folder / name
                (write_program_file if family.local_version_id else write_new_file)(target, text)
            except FileOperationError as error:
                store.write(lambda c: shared_versions.delete_unpublished_version(c, taken)).result()
                raise VersionCopyError(str(error), get_error_code(error)) from error
            # After the file, because the next synchronization recognizes its text after a power failure.
            store.write(
                lambda c: shared_versions.set_local_version(c, version.program_key, taken.id)
            ).result()
            self._tell(store, None, self.last_result.error_text)
            return name

    def resolve_with_local_version(self, program_key: str) -> None:
        """Resolve a version conflict in favor of the local version, by making it the newest version.

        The same applies if another machine has a newer version without a conflict. Raises VersionCopyError
        if this machine has no version, if it already has all newest versions, or if the text of the local
        version cannot be read from the store. Raises StoreError if the store fails.
        """
        with self._lock:
            store = self._store()
            self._note(store, is_settled=False)
            family = _family(store, program_key)
            here, others = (
                family.versions.get(family.local_version_id),
                [each.id for each in family.newest_remote_versions],
            )
            if here is None or not others:
                raise VersionCopyError(
                    "no decision is necessary, because no other control has changed this program",
                    "nothing-to-settle",
                )
            follows = (here.id, *others)
            with store.read() as connection:
                text = shared_versions.read_version_text(connection, here.text)
            if text is None:
                raise VersionCopyError(
                    Message(
                        "the text of {program} differs from the saved version; save the program again",
                        program=here.program,
                    ),
                    "damaged-text",
                )
            kept = make_version(here.program, text, follows, self.machine_name, get_utc_now_text(), "kept")
            store.write(partial(_kept, kept)).result()
            self._tell(store, None, self.last_result.error_text)

    def _free_name(self, version: SharedVersion) -> str:
        """Return the file name to which a version is copied.

        If a local file has the same name except for case, its name is used. Otherwise, the name of the
        version is used. Raises VersionCopyError if sharing rejects the local file, or if the name is not
        permitted for a new file.
        """
        names = [each for each in self._files.rejected_files if make_program_key(each) == version.program_key]
        if names:
            raise VersionCopyError(
                Message("{names}: {refused}", names=names[0], refused=self._files.rejected_files[names[0]]),
                "refused-name",
            )
        file = self._files.read_files(is_settled=False).get(version.program_key)
        if file is not None:
            return file.name
        try:
            program_records.check_new_program_name(version.program)
        except StoreError as error:
            raise VersionCopyError(str(error), get_error_code(error)) from error
        return version.program


def _holders(desks: Sequence[PublishedMachineState]) -> dict[str, tuple[str, ...]]:
    found: dict[str, set[str]] = {}
    for desk in desks:
        for version in desk.version_ids.values():
            found.setdefault(version, set()).add(desk.machine_name)
    return {version: tuple(sorted(names)) for version, names in found.items()}


def _family(store: Store, key: str) -> ProgramVersions:
    with store.read() as connection:
        return shared_versions.read_shared_programs(connection).get(key, ProgramVersions())


def _keep(name: str, version: SharedVersion, text: bytes, connection: sqlite3.Connection) -> None:
    program_records.save_program_version(
        connection, name, text, Message("shared by {machine}", machine=version.desk)
    )
    shared_versions.add_versions(connection, [version])


def _published(versions: Sequence[SharedVersion], connection: sqlite3.Connection) -> None:
    shared_versions.mark_versions_published(connection, versions)


def _kept(version: SharedVersion, connection: sqlite3.Connection) -> None:
    shared_versions.add_versions(connection, [version])
    shared_versions.set_local_version(connection, version.program_key, version.id)
