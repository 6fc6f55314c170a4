"""Programs shared in a git repository: a branch of its own, to which commits with new files are pushed.

The files are those of the shared folder, named by what they hold: two desks never change the same one, so
there is nothing to merge by hand. A push that comes second is made again on top of the first.
"""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from core.message import Message
from core.sharing.git_command import GitCommand
from core.sharing.shared_folder import DESKS, LONGEST, MARK, VERSIONS, check_mark
from core.sharing.shared_place import Found, Published, repository_at
from core.sharing.sharing_errors import Cause, SharingError, of_system
from core.sharing.version_record import (
    FORMAT,
    DeskState,
    RecordError,
    checked_text,
    is_id,
    read_state,
    read_version,
    written,
)
from core.store.shared_versions import SharedVersion

BRANCH = "turndesk"  # the repository may hold other things besides
_HERE, _THERE = f"refs/heads/{BRANCH}", f"refs/remotes/origin/{BRANCH}"
_LONGEST_HEAD = 400  # bytes
_TRIES = 8  # pushes, while other desks push
_SECOND = ("[rejected]", "stale info", "cannot lock ref", "failed to update ref", "incorrect old value")
_DAMAGED = (
    "bad config",
    "not a git repository: ",
    "bad object",
    "corrupt",
    "loose object",
    "bad ref",
    "packfile",
)


class SharedGit:
    """``folder`` is this desk's own copy of the branch, which can be made again at any time."""

    def __init__(self, remote: str, folder: Path) -> None:
        self.name = repository_at(_named(remote))
        self._remote, self._folder = remote, folder
        self._git = GitCommand(folder, self.name)

    def begin(self) -> None:
        """The branch with its mark; where it is there already nothing is done.

        A branch that somebody has emptied or begun anew by hand is gone on with: nothing in it is lost, and
        desks publish again what it lacks.
        """
        try:
            self._fetch()
        except SharingError as error:
            if error.cause is not Cause.NOT_BEGUN:
                raise
            self._commit(
                {MARK: json.dumps({"format": FORMAT}).encode()}, "Shared programs", onto=self._branch()
            )
            self._push()
            self._fetch()

    def look(self, known: Mapping[str, SharedVersion]) -> Found:
        """Fetched first; then all is read from the copy."""
        self._fetch()
        names = (
            self._git.run(["ls-tree", "-r", "-z", "--name-only", _THERE]).decode(errors="replace").split("\0")
        )
        versions = {path: _last(path) for path in names if path.startswith(f"{VERSIONS}/")}
        strays = [path for path, name in versions.items() if not is_id(name)]
        there = {name for name in versions.values() if name in known}
        wanted = [path for path, name in versions.items() if is_id(name) and name not in known]
        homes = [path for path in names if path.startswith(f"{DESKS}/")]
        blobs = self._blobs([*wanted, *homes])
        fresh, desks = list[SharedVersion](), list[DeskState]()
        for path, data in blobs.items():
            try:
                if path in versions:
                    fresh.append(_whole(_last(path), data))
                else:
                    desks.append(read_state(_last(path).removesuffix(".json"), data))
            except RecordError:
                strays.append(path)
        there |= {version.id for version in fresh}
        return Found(frozenset(there), tuple(fresh), tuple(desks), tuple(strays))

    def put(self, versions: Sequence[Published], state: DeskState) -> None:
        """One commit for all of them."""
        self._fetch()
        files = {
            f"{VERSIONS}/{each.version.id}": written(each.version) + b"\n" + each.text for each in versions
        }
        files[f"{DESKS}/{state.home}.json"] = state.written()
        for _ in range(_TRIES):
            self._commit(
                files,
                Message(
                    "{machine}: {versions_count} versions", machine=state.desk, versions_count=len(versions)
                ),
                onto=_THERE,
            )
            if self._push():
                return
            self._fetch()
        raise Cause.AWAY.error(self.name, "other controls keep pushing changes")

    def text(self, version: SharedVersion) -> bytes:
        """From the copy: also while the repository is away, once the version was fetched."""
        path = f"{VERSIONS}/{version.id}"
        data = self._blobs([path]).get(path, b"")
        try:
            return checked_text(version, data.partition(b"\n")[2])
        except RecordError as error:
            raise Cause.DAMAGED.error(self.name, error) from error

    def close(self) -> None:
        """What git does is ended."""
        self._git.close()

    # --- the copy --------------------------------------------------------------------------------------

    def _fetch(self) -> None:
        """Raises SharingError. A copy that a power cut has damaged is made again."""
        self._demand_copy()
        try:
            self._fetch_once()
        except SharingError as error:
            if not any(sign in error.told.lower() for sign in _DAMAGED):
                raise
            shutil.rmtree(self._folder, ignore_errors=True)
            self._demand_copy()
            self._fetch_once()
        blobs = self._blobs([MARK])
        if MARK not in blobs:
            raise Cause.NOT_BEGUN.error(self.name)
        check_mark(self.name, blobs[MARK])

    def _demand_copy(self) -> None:
        if (self._folder / "HEAD").exists():
            return
        try:
            shutil.rmtree(self._folder, ignore_errors=True)
            self._folder.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise of_system(str(self._folder), error) from error
        self._git.run(["init", "--quiet", "--bare", f"--initial-branch={BRANCH}", "--", str(self._folder)])

    def _branch(self) -> str:
        """What the repository has by its name, fetched; empty: nothing."""
        try:
            self._fetch_once()
        except SharingError as error:
            if error.cause is not Cause.NOT_BEGUN:
                raise
            return ""
        return _THERE

    def _fetch_once(self) -> None:
        refs = f"+{_HERE}:{_THERE}"
        try:
            self._git.run(
                ["fetch", "--quiet", "--no-tags", "--no-write-fetch-head", "--", self._remote, refs]
            )
        except SharingError as error:
            if "find remote ref" in error.told:
                raise Cause.NOT_BEGUN.error(self.name) from error
            raise

    def _blobs(self, paths: Sequence[str]) -> dict[str, bytes]:
        """Return the contents of files of the branch, without those that are missing or too long."""
        names = [path for path in paths if "\n" not in path]
        sizes = self._objects("--batch-check", names).splitlines()
        wanted = [name for name, head in zip(names, sizes, strict=False) if 0 <= _size(head) <= LONGEST]
        out, at, found = self._objects("--batch", wanted), 0, dict[str, bytes]()
        for path in wanted:
            head, _, _ = out[at : at + _LONGEST_HEAD].partition(b"\n")
            at += len(head) + 1
            found[path] = out[at : at + _size(head)]
            at += _size(head) + 1
        return found

    def _objects(self, how: str, paths: Sequence[str]) -> bytes:
        asked = "".join(f"{_THERE}:{path}\n" for path in paths)
        return self._git.run(["cat-file", how], asked.encode())

    def _commit(self, files: Mapping[str, bytes], subject: str, *, onto: str) -> None:
        """On top of a commit, as git's fast-import takes it: one process for a thousand files."""
        said = subject.encode()
        now = f"TurnDesk <turndesk@localhost> {int(time.time())} +0000".encode()
        parts = [b"commit %s\ncommitter %s\ndata %d\n%s\n" % (_HERE.encode(), now, len(said), said)]
        if onto:
            parts.append(b"from %s^0\n" % onto.encode())
        for path, data in files.items():
            parts.append(b"M 100644 inline %s\ndata %d\n%s\n" % (path.encode(), len(data), data))
        self._git.run(["fast-import", "--quiet", "--force", "--date-format=raw-permissive"], b"".join(parts))

    def _push(self) -> bool:
        """False: another desk was first."""
        try:
            self._git.run(["push", "--quiet", "--", self._remote, f"{_HERE}:{_HERE}"])
        except SharingError as error:
            if any(sign in error.told for sign in _SECOND):
                return False
            raise
        return True


def _named(remote: str) -> str:
    """Without a password: it stands in sentences and logs. On the web the user's name may be a token too."""
    scheme, between, rest = remote.partition("://")
    who, at, where = rest.rpartition("@")
    if scheme in {"http", "https"}:
        return f"{scheme}{between}{where.partition('?')[0]}"
    return f"{scheme}{between}{who.partition(':')[0]}{at}{where}"


def _size(head: bytes) -> int:
    """Of a file, by the line in front of it; -1: there is none of that name, or it is no file."""
    words = head.split(b" ")
    return int(words[2]) if len(words) == 3 and words[1] == b"blob" else -1


def _last(path: str) -> str:
    return path.rpartition("/")[2]


def _whole(name: str, data: bytes) -> SharedVersion:
    record, _, text = data.partition(b"\n")
    version = read_version(name, record)
    checked_text(version, text)
    return version
