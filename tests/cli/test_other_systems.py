"""The office runs Windows or macOS: proving, reports and the simulated desk import nothing of POSIX alone.

Tried with those modules taken away, on the system at hand; on Windows itself it was not tried.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

PROGRAM = """\
import multiprocessing, os, platformdirs.unix, socket, subprocess, sys, tempfile
GONE = {"fcntl", "termios", "resource", "pwd", "grp", "tty", "pty", "syslog"}

class Gone:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in GONE:
            raise ImportError(f"{name} is not on this system")

for name in GONE:
    sys.modules.pop(name, None)
sys.meta_path.insert(0, Gone())
for name in "fork sched_getaffinity sched_setscheduler geteuid getuid pwrite posix_fallocate".split():
    delattr(os, name)
from app.cli.main import main
program, report = sys.argv[1:]
assert main(["offsets", "set", "T1", "x=1", "z=1"]) == 0
assert main(["prove", program, "--report", report]) == 0
assert main(["run", program, "--headless"]) == 0
from app.compose import backends
backends.FEEDER = False
from app.compose.screen_desk import build_desk
desk = build_desk()
assert not desk.book.locked
desk.close()
import app.screen.run_screen
print("all of it")
"""


def test_nothing_that_only_posix_has_is_imported(tmp_path: Path) -> None:
    part = tmp_path / "part.nc"
    part.write_text("G90G94F300\nT1\nM03S1000\nX.5Z.1\nG95F.01Z0\nX.6\nG94F300Z1\nM30\n")
    own = {"TURNDESK_HOME": str(tmp_path / "home"), "PYTHONPATH": ":".join(sys.path)}
    env = {"HOME": str(tmp_path), "QT_QPA_PLATFORM": "offscreen", **own}
    told = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(part), str(tmp_path / "part.html")],
        capture_output=True,
        text=True,
        check=False,
        env=env,
    )
    assert told.stdout.endswith("all of it\n"), told.stderr[-2000:]
    assert (tmp_path / "part.html").stat().st_size > 1000
