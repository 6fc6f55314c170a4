"""Things in a shared folder that no desk has put there: pipes, devices, folders, endless files."""

from __future__ import annotations

import os
import resource
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue
from typing import TypeVar

import pytest

from core.extras.sharing.shared_folder import DESKS, MARKER_FILE_NAME, VERSIONS, SharedFolder
from core.extras.sharing.shared_location import SharingErrorCause
from core.input_file import TooLargeError, read_input_bytes
from tests.extras.sharing.test_places import HOME, cause_of, published, state

Result = TypeVar("Result")
pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in folders here")


@pytest.fixture
def place(tmp_path: Path) -> SharedFolder:
    """A folder that is laid out and has one version."""
    found = SharedFolder(tmp_path)
    found.set_up()
    found.publish_versions([published(1)], state())
    return found


def in_time(call: Callable[[], Result]) -> Result:
    """What the call returns; a call that hangs fails the test instead of holding it."""
    done: SimpleQueue[Result] = SimpleQueue()
    threading.Thread(target=lambda: done.put(call()), daemon=True).start()
    return done.get(timeout=60)


@contextmanager
def little_memory() -> Iterator[None]:
    """Half a GB more than this process has now."""
    limits = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + 512 * 1024 * 1024, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)


@pytest.mark.parametrize("name", [f"{VERSIONS}/{'a' * 64}.version", f"{DESKS}/{'b' * 32}.json"])
def test_pipe_is_listed_as_foreign_and_does_not_block(place: SharedFolder, tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / name)
    found = in_time(lambda: place.read_contents({}))
    assert found.foreign_item_names == (Path(name).name,)
    assert found.unknown_versions == (published(1).version,)


def test_pipe_in_place_of_the_marker_file_is_reported(place: SharedFolder, tmp_path: Path) -> None:
    (tmp_path / MARKER_FILE_NAME).unlink()
    os.mkfifo(tmp_path / MARKER_FILE_NAME)
    cause, words = in_time(lambda: cause_of(place.read_contents, {}))
    assert (cause, MARKER_FILE_NAME in words) == (SharingErrorCause.OTHER, True)


def test_pipe_in_place_of_a_version_is_damaged_and_replaced(place: SharedFolder, tmp_path: Path) -> None:
    one = published(1)
    path = tmp_path / VERSIONS / f"{one.version.id}.version"
    path.unlink()
    os.mkfifo(path)
    assert in_time(lambda: cause_of(place.read_text, one.version))[0] is SharingErrorCause.DAMAGED
    in_time(lambda: place.publish_versions([one], state()))
    assert place.read_text(one.version) == one.program_text


@pytest.mark.parametrize("name", [f"{VERSIONS}/{'a' * 64}.version", f"{DESKS}/{HOME}.json"])
def test_a_file_of_gigabytes_is_not_read(place: SharedFolder, tmp_path: Path, name: str) -> None:
    with (tmp_path / name).open("wb") as file:
        file.truncate(3 * 1024**3)
    with little_memory():
        assert place.read_contents({}).foreign_item_names == (Path(name).name,)


def test_file_that_is_not_regular_is_rejected(tmp_path: Path) -> None:
    for path in (tmp_path, Path("/dev/zero")):
        with pytest.raises(OSError, match=path.name):
            read_input_bytes(path, 10)


def test_file_above_its_size_limit_is_rejected(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"0123456789")
    assert read_input_bytes(path, 10) == b"0123456789"
    with pytest.raises(TooLargeError):
        read_input_bytes(path, 9)
