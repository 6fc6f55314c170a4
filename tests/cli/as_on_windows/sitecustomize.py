"""What Windows has not or forbids, played on the system at hand: Python loads this file before all others.

Windows' own rules, as its documents say them: no module and no call of POSIX alone; a file that is open or
mapped is neither replaced nor deleted; only what is open for writing is brought to the disk; no folder is
opened; names without ``<>:"|?*`` and without those of devices; text that says no encoding is cp1252, and its
lines end in CR LF. Not played: paths with ``\\``, names without case, Windows' console and its processes.
"""

# mypy: ignore-errors
from __future__ import annotations

import asyncio
import builtins
import concurrent.futures.process
import errno
import fcntl
import io
import multiprocessing.popen_spawn_posix
import multiprocessing.resource_tracker
import multiprocessing.synchronize
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import types

import numpy as np
import platformdirs.unix
from PySide6 import QtGui

LOADED = (asyncio, concurrent.futures.process, socket, subprocess, tempfile, np, platformdirs.unix, QtGui)
"""They ask for the system when they are loaded; only what is loaded later shall take this one for Windows."""
MODULES = {"curses", "fcntl", "grp", "nis", "pty", "pwd", "readline", "resource", "spwd", "syslog", "termios"}
OF_OS = """chown fchown fdatasync fork forkpty fstatvfs getegid geteuid getgid getgroups getloadavg getpgid
getuid killpg lchown mkfifo mknod nice openpty posix_fadvise posix_fallocate pread preadv pwrite pwritev
sched_getaffinity sched_setaffinity sched_setscheduler setpgid setsid statvfs sync ttyname
O_CLOEXEC O_DIRECTORY O_DSYNC O_NOFOLLOW O_NONBLOCK O_SYNC"""
OF_SIGNAL = """SIGALRM SIGCHLD SIGHUP SIGKILL SIGPIPE SIGQUIT SIGTTIN SIGUSR1 SIGUSR2 alarm pthread_kill
setitimer"""
WRONG_IN_NAMES = frozenset('<>:"|?*')
DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))}
NOT_FILES = ("/proc", "/dev", "/sys")

_flock, _getfl = fcntl.flock, fcntl.F_GETFL
_fcntl, _lock = fcntl.fcntl, fcntl.LOCK_EX | fcntl.LOCK_NB
_open, _os_open, _replace, _unlink = io.open, os.open, os.replace, os.unlink
_fsync, _mkdir = os.fsync, os.mkdir


class Gone:
    """Finds none of the modules that are POSIX's alone."""

    def find_spec(self, name, _path=None, _target=None):
        if name.partition(".")[0] in MODULES:
            raise ImportError(f"{name} is not on this system")


def _check_name(path) -> None:
    if isinstance(path, int) or os.fsdecode(path).startswith(NOT_FILES):
        return
    name = os.path.basename(os.fsdecode(path))
    ends_badly = name != name.rstrip(". ") and name not in {".", ".."}
    if WRONG_IN_NAMES & set(name) or ends_badly or name.partition(".")[0].lower() in DEVICES:
        raise OSError(errno.EINVAL, "Invalid argument", path)


def _check_no_folder(path) -> None:
    if not isinstance(path, int) and os.path.isdir(path):
        raise PermissionError(errno.EACCES, "Permission denied", path)


def _check_free(path) -> None:
    """No file that this process has open or mapped."""
    whole = os.path.realpath(os.fsdecode(path))
    held = []
    for each in os.listdir("/proc/self/fd"):
        try:
            held.append(os.readlink(f"/proc/self/fd/{each}"))
        except OSError:
            continue
    with _open("/proc/self/maps", encoding="utf-8") as maps:
        held += [line.rstrip().partition("/")[2] for line in maps]
    if whole in held or whole.removeprefix("/") in held:
        raise PermissionError(errno.EACCES, "It is being used by another process", path)


def open_as_there(file, mode="r", buffering=-1, encoding=None, errors=None, newline=None, **more):
    _check_name(file)
    _check_no_folder(file)
    if "b" not in mode and not isinstance(file, int):
        encoding = encoding or "cp1252"
        newline = "\r\n" if newline is None and set(mode) & set("awx+") else newline
    return _open(file, mode, buffering, encoding, errors, newline, **more)


def os_open_as_there(path, flags, mode=0o777, *, dir_fd=None):
    _check_name(path)
    _check_no_folder(path)
    return _os_open(path, flags, mode, dir_fd=dir_fd)


def replace_as_there(old, new, **more):
    _check_name(new)
    _check_free(old)
    _check_free(new)
    return _replace(old, new, **more)


def rename_as_there(old, new, **more):
    if os.path.lexists(new):
        raise FileExistsError(errno.EEXIST, "File exists", new)
    return replace_as_there(old, new, **more)


def unlink_as_there(path, *, dir_fd=None):
    _check_free(path)
    return _unlink(path, dir_fd=dir_fd)


def fsync_as_there(file):
    number = file if isinstance(file, int) else file.fileno()
    if _fcntl(number, _getfl) & os.O_ACCMODE == os.O_RDONLY:
        raise OSError(errno.EBADF, "Bad file descriptor")
    return _fsync(file)


def mkdir_as_there(path, mode=0o777, *, dir_fd=None):
    _check_name(path)
    return _mkdir(path, mode, dir_fd=dir_fd)


for _name in MODULES:
    sys.modules.pop(_name, None)
sys.meta_path.insert(0, Gone())
for _name in OF_OS.split():
    delattr(os, _name)
for _name in OF_SIGNAL.split():
    delattr(signal, _name)
for _name in [each for each in dir(time) if each.startswith(("CLOCK_", "clock_", "pthread_"))]:
    delattr(time, _name)
builtins.open = io.open = open_as_there
os.open, os.mkdir, os.fsync = os_open_as_there, mkdir_as_there, fsync_as_there
os.replace, os.rename = replace_as_there, rename_as_there
os.unlink = os.remove = unlink_as_there
shutil._use_fd_functions = False
msvcrt = types.ModuleType("msvcrt")
msvcrt.LK_NBLCK = 2
msvcrt.locking = lambda file, _mode, _count: _flock(file, _lock)
sys.modules["msvcrt"] = msvcrt
# A worker is started by this system's means all the same.
multiprocessing.synchronize.sys = types.SimpleNamespace(platform=sys.platform)
if "--multiprocessing-fork" not in sys.orig_argv:
    sys.platform = "win32"
