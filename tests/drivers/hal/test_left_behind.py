"""What a session of HAL leaves behind: shared memory that bars the next one, processes that still end it."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from drivers.hal.hal_session import SYSTEM_PYTHON
from tests.drivers.hal import halrun as halrun_here
from tests.drivers.hal.halrun import as_halrun
from tests.drivers.hal.lathes import PATIENT, lathe
from tests.drivers.hal.live import live

# Streams as a killed session with a shorter queue leaves them.
LEAVE = """
import ctypes
libc = ctypes.CDLL(None, use_errno=True)
for key in 0x48535430, 0x48535431:
    assert libc.shmget(key, 64, 0o1600) >= 0, ctypes.get_errno()
"""


@pytest.mark.long
@pytest.mark.real_time
@pytest.mark.usefixtures("halrun")
def test_streams_that_a_killed_session_has_left_do_not_bar_the_next(tmp_path: Path) -> None:
    subprocess.run([*as_halrun(), SYSTEM_PYTHON, "-c", LEAVE], check=True)
    with live(lathe(tmp_path, PATIENT)) as made:
        made.ready()
        assert made.pin("streamer.1.curr-depth") is not None


@pytest.mark.parametrize("name", ["halrun", "realtime"])
def test_hal_session_that_is_shutting_down_counts_as_running(name: str, tmp_path: Path) -> None:
    script = tmp_path / name
    script.write_text("#!/bin/sh\necho runs\nread x\n")
    script.chmod(0o755)
    with subprocess.Popen([script], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as left:
        assert left.stdout
        assert left.stdout.readline() == b"runs\n"
        assert halrun_here.hal_is_up()
        left.communicate(b"\n")
