"""LinuxCNC's halrun for tests: one session at a time on a computer, and never as root, which it refuses."""

from __future__ import annotations

import fcntl
import functools
import os
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from drivers.hal.hal_session import CLEAR_STREAMS_SCRIPT

_NOBODY = 65534
_LOCK = Path(tempfile.gettempdir()) / "turndesk-halrun.lock"
_WRAPPER = """#!/bin/sh
[ "$1" = -f ] && chown -R {nobody}:{nobody} "$(dirname "$2")"
exec setpriv --reuid={nobody} --regid={nobody} --clear-groups env HOME={home} {halrun} "$@"
"""
_PATIENCE = 600  # tenths of a second
_TRIED = (
    "loadusr -w /bin/sh {}\nloadrt threads name1=t period1=1000000\nloadrt streamer depth=8 cfg=f\nstart\n"
)


def folder_with_halrun(folder: Path) -> Path:
    """A folder for the head of PATH: for root with a halrun that goes on as nobody."""
    real = shutil.which("halrun")
    if real is not None and os.geteuid() == 0:
        home = folder / "home"
        home.mkdir(parents=True)
        for each in (folder, home):
            os.chmod(each, 0o755)
        os.chown(home, _NOBODY, _NOBODY)
        wrapper = folder / "halrun"
        wrapper.write_text(_WRAPPER.format(nobody=_NOBODY, home=home, halrun=real), encoding="utf-8")
        wrapper.chmod(0o755)
    return folder


@contextmanager
def folder_for_all() -> Iterator[Path]:
    """A folder that whoever runs HAL can read. In pytest's own he can until another pytest begins on this
    computer, which shuts them for everybody but their owner.
    """
    with tempfile.TemporaryDirectory(prefix="turndesk-lathe-", ignore_cleanup_errors=True) as name:
        os.chmod(name, 0o755)
        yield Path(name)


def as_halrun() -> list[str]:
    """What makes a command one of the user who runs HAL."""
    if os.geteuid() != 0:
        return []
    return ["setpriv", f"--reuid={_NOBODY}", f"--regid={_NOBODY}", "--clear-groups"]


@functools.cache
def why_not() -> str:
    """Why no HAL can be run here; empty where it can. Tried once."""
    if shutil.which("halrun") is None:
        return "there is no LinuxCNC here: apt install linuxcnc-uspace"
    with tempfile.TemporaryDirectory() as name, one_session():
        folder = Path(name)
        os.chmod(folder, 0o755)
        script = folder / "tried" / "tried.hal"
        script.parent.mkdir()
        clear = script.with_name("clear.sh")
        clear.write_text(CLEAR_STREAMS_SCRIPT, encoding="utf-8")
        script.write_text(_TRIED.format(clear), encoding="utf-8")
        path = f"{folder_with_halrun(folder / 'bin')}:{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path}
        halrun = shutil.which("halrun", path=path)
        assert halrun is not None
        done = subprocess.run(
            [halrun, "-f", str(script)],
            env=environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=150,
        )
    said = (done.stderr or done.stdout).strip().splitlines()
    return "" if done.returncode == 0 else f"LinuxCNC's HAL does not run here: {' / '.join(said[-2:])}"


@contextmanager
def one_session() -> Iterator[None]:
    """Wait until no other session of HAL runs on this computer, and bar others until this one is left.

    HAL has one shared memory for the whole computer. Raises TimeoutError.
    """
    with _LOCK.open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        for _ in range(_PATIENCE):
            if not hal_is_up():
                break
            threading.Event().wait(0.1)
        else:
            raise TimeoutError(f"another session of HAL has not ended within {_PATIENCE / 10:g} s")
        yield


def hal_is_up() -> bool:
    """Return whether a session of HAL runs or is being taken down; zombies do not count.

    ``realtime stop``, which halrun ends with, removes HAL's shared memory after rtapi_app has gone: a session
    that begins in between loses its own.
    """
    listed = ["ps", "-C", "rtapi_app,halrun,realtime", "-o", "stat="]
    shown = subprocess.run(listed, capture_output=True, text=True, check=False).stdout
    return any(not each.startswith("Z") for each in shown.split())


@contextmanager
def halrun_on_path() -> Iterator[None]:
    """halrun on PATH, for one session alone; skipped with the reason where HAL cannot be run."""
    if why := why_not():
        pytest.skip(why)
    with (
        pytest.MonkeyPatch.context() as patch,
        tempfile.TemporaryDirectory(prefix="turndesk-halrun-") as name,
        one_session(),
    ):
        patch.setenv("PATH", f"{folder_with_halrun(Path(name))}:{os.environ['PATH']}")
        yield


@pytest.fixture
def halrun() -> Iterator[None]:
    """halrun on PATH, for this test alone."""
    with halrun_on_path():
        yield
