"""The office runs Windows or macOS: proving, reports, the store and the simulated desk hold Windows' rules.

Those that can be played are in ``as_on_windows``; on Windows itself it was not tried.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from textwrap import indent

import pytest

import resources
from app.cli.main import list_commands

RULES = Path(__file__).with_name("as_on_windows")
PART = "G90G94F300\nT1\nM03S1000\nX.5Z.1\nG95F.01Z0\nX.6\nG94F300Z1\nM30\n"
COMMANDS = """\
offsets set T1 x=1 z=1 remark=Ω→
offsets history
offsets undo
offsets set T1 x=1 z=1
prove part.nc --report part.html
prove part.nc --report part.pdf
prove parts --jobs 2
trace part.nc --dt .01 --out part.csv
run part.nc --headless
scope home/records/run.ring --csv run.csv
store backup copy.db
store backup copy.db
store restore copy.db
store export exported
store import exported
store verify
shift --report shift.html
machine check mine.toml
jobs add part.nc 3
share begin --machine sharing.toml
share publish --machine sharing.toml
share status --machine sharing.toml
machine accept mine.toml
setup save desk.setup --machine mine.toml
setup load desk.setup
setup load desk.setup
"""
DESK = r"""from app.compose.backends import connection
from app.compose.screen_desk import build_desk
assert not connection.HAS_DRIVER_HOST
desk = build_desk()
assert not desk.offset_book.lock_reason
desk.close()
from pathlib import Path
from app.programs.atomic_files import copy_to_medium, flush_folder, write_program_file
for write in (write_program_file, copy_to_medium):
    for text in (b"G90\nM30\n", b"G90\nX1\nM30\n"):
        write(Path("part.nc").resolve(), text)
flush_folder(Path.cwd())
import app.screen.screen_startup
print("a desk")
"""


def _as_on_windows(tmp_path: Path, *words: str) -> subprocess.CompletedProcess[str]:
    env = {
        "TURNDESK_HOME": str(tmp_path / "home"),
        "PYTHONPATH": os.pathsep.join([str(RULES), *sys.path]),
        "HOME": str(tmp_path),
        "QT_QPA_PLATFORM": "offscreen",
        "PYTHONIOENCODING": "cp1252",
    }
    return subprocess.run(
        [sys.executable, *words],
        capture_output=True,
        encoding="cp1252",
        check=False,
        env=env,
        cwd=tmp_path,
    )


@pytest.fixture
def office(tmp_path: Path) -> Path:
    """A folder with a program, some more of them, and a machine file."""
    (tmp_path / "parts").mkdir()
    for path in (tmp_path / "part.nc", tmp_path / "parts" / "a.nc", tmp_path / "parts" / "b.nc"):
        path.write_text(PART)
    (tmp_path / "home" / "programs").mkdir(parents=True)
    (tmp_path / "home" / "programs" / "part.nc").write_text(PART)
    (tmp_path / "place").mkdir()
    lathe = resources.read_machine_file("gt75.toml")
    (tmp_path / "mine.toml").write_text(lathe)
    (tmp_path / "sharing.toml").write_text(f'{lathe}\n[sharing]\nfolder = "{tmp_path / "place"}"\n')
    return tmp_path


@pytest.mark.long
def test_commands_run_under_simulated_windows_rules(office: Path) -> None:
    lines = [line for line in COMMANDS.splitlines() if line.split()[0] in list_commands()]
    script = (
        "import sys; from app.cli.main import run_console\n"
        f"for line in {lines!r}:\n"
        "    sys.argv[1:] = line.split()\n"
        "    status = run_console()\n"
        "    assert status == 0, f'{line}: {status}'\n"
    )
    file = office / "all.py"  # a worker loads it again, as on Windows
    file.write_text(f"if __name__ == '__main__':\n{indent(script, '    ')}", encoding="utf-8")
    told = _as_on_windows(office, str(file))
    assert told.returncode == 0, told.stdout[-500:] + told.stderr[-2000:]
    assert "T1  not set ? X +1.00000" in told.stdout
    assert (office / "part.html").stat().st_size > 1000
    assert (office / "part.pdf").read_bytes().startswith(b"%PDF")
    assert (office / "part.csv").read_bytes().startswith(b"t,x,z,c,spindle_deg,line\n")


def test_simulated_operator_screen_runs_under_windows_rules(tmp_path: Path) -> None:
    told = _as_on_windows(tmp_path, "-c", DESK)
    assert told.stdout == "a desk\n", told.stderr[-2000:]


@pytest.mark.parametrize(
    "wrong",
    [
        "import fcntl",
        "import os; os.sync()",
        "import os; os.fsync(open('part.nc', 'rb').fileno())",
        "import os; a = open('part.nc', 'rb'); os.replace('part.nc', 'other.nc')",
        "import os; a = open('part.nc', 'rb'); os.unlink('part.nc')",
        "import os; os.open('parts', os.O_RDONLY)",
        "open('17:30.nc', 'w')",
        "print('→')",
    ],
)
def test_violation_of_a_windows_rule_raises_an_error(office: Path, wrong: str) -> None:
    told = _as_on_windows(office, "-c", wrong)
    assert told.returncode == 1
    assert "Error" in told.stderr
