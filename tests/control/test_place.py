"""Places of controls in a data folder: one owner each, and no drivers with two controls."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

if sys.platform != "linux":
    pytest.skip("the control is a process only on Linux", allow_module_level=True)

from app.compose.backends.driver_host_process import DriverHostProcess
from app.compose.control.control_slot import ControlSlot, ScreenListener
from app.compose.machine.machine_files import load_machine
from core.ports import DriverError
from drivers.wakeups import RealClock

NAMES = ["control.sock", "control-2.sock", "control-3.sock", "control-4.sock"]


def sockets(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.glob("*.sock"))


@contextmanager
def owned(folder: Path) -> Iterator[ScreenListener | None]:
    """A place and its listener."""
    place = ControlSlot(folder)
    listener = place.create_listener()
    try:
        yield listener
    finally:
        if listener is not None:
            listener.close()
        place.close()


def test_each_owner_has_its_own_socket(tmp_path: Path) -> None:
    with owned(tmp_path), owned(tmp_path):
        assert sockets(tmp_path) == sorted(NAMES[:2])
        with owned(tmp_path):
            assert sockets(tmp_path) == sorted(NAMES[:3])
        assert sockets(tmp_path) == sorted(NAMES[:2])
    assert sockets(tmp_path) == []


def test_slot_that_becomes_free_is_used_next(tmp_path: Path) -> None:
    first = ControlSlot(tmp_path)
    with owned(tmp_path):
        first.close()
        with owned(tmp_path):
            assert sockets(tmp_path) == sorted(NAMES[:2])


def test_stale_socket_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / NAMES[0]
    with socket.socket(socket.AF_UNIX) as left:
        left.bind(str(path))  # of a control that was killed
    with owned(tmp_path) as listener, socket.socket(socket.AF_UNIX) as screen:
        assert listener is not None
        screen.connect(str(path))
        listener.accept_screen().close()
        assert sockets(tmp_path) == NAMES[:1]
    assert not path.exists()


def test_control_without_a_free_slot_has_no_listener(tmp_path: Path) -> None:
    places = [ControlSlot(tmp_path) for _ in range(5)]
    assert [place.drivers_lock is not None for place in places] == [True, True, True, True, False]
    assert places[4].create_listener() is None
    for place in places:
        place.close()


def test_slot_is_not_reused_until_drivers_of_its_last_owner_have_ended(tmp_path: Path) -> None:
    killed = ControlSlot(tmp_path)
    assert killed.drivers_lock is not None
    host = os.dup(killed.drivers_lock)  # inherited by a driver host
    killed.close()
    with pytest.raises(DriverError):
        ControlSlot(tmp_path, 0.0)
    found: list[ControlSlot] = []
    waiting = threading.Thread(target=lambda: found.append(ControlSlot(tmp_path, 30.0)))
    waiting.start()
    assert not found
    assert sockets(tmp_path) == []
    assert not (tmp_path / "control-2.lock").exists()  # it waits for the first place
    os.close(host)
    waiting.join(30.0)
    assert found[0].drivers_lock is not None
    found[0].close()


@pytest.mark.real_time
def test_driver_host_holds_the_slot_lock_until_it_has_ended(tmp_path: Path) -> None:
    place = ControlSlot(tmp_path)
    host = DriverHostProcess(load_machine(), RealClock(), place.drivers_lock)
    place.close()
    with pytest.raises(DriverError):
        ControlSlot(tmp_path, 0.0)
    host.close()
    ControlSlot(tmp_path, 0.0).close()


def test_other_processes_do_not_inherit_the_lock(tmp_path: Path) -> None:
    place = ControlSlot(tmp_path)
    with subprocess.Popen(["/bin/cat"], stdin=subprocess.PIPE, close_fds=False) as other:
        place.close()
        ControlSlot(tmp_path, 0.0).close()
        assert other.poll() is None
        assert other.stdin is not None
        other.stdin.close()


def test_unwritable_folder_has_no_slot(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    place = ControlSlot(tmp_path / "file" / "home")
    assert place.drivers_lock is None
    assert place.create_listener() is None
    place.close()


def test_slot_in_folder_with_too_long_socket_path_still_has_its_lock(tmp_path: Path) -> None:
    place = ControlSlot(tmp_path / ("long" * 30))
    assert place.drivers_lock is not None
    assert place.create_listener() is None
    place.close()


def test_closing_a_control_leaves_the_socket_of_another_one(tmp_path: Path) -> None:
    path = tmp_path / NAMES[0]
    first = ScreenListener(path)
    path.unlink()
    second = ScreenListener(path)
    first.close()
    assert path.is_socket()
    second.close()
    assert not path.exists()


def test_listener_closes_without_error_if_its_folder_is_removed(tmp_path: Path) -> None:
    folder = tmp_path / "home"
    folder.mkdir()
    listener = ScreenListener(folder / NAMES[0])
    shutil.rmtree(folder)
    listener.close()
    assert not folder.exists()
