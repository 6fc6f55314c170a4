"""The shipped HAL lathe with something changed, as files of their own; programs run on it by the command."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import resources
from tests.late_computer import command_was_late

Changes = Sequence[tuple[str, str]]
# The longest that a machine file may say of setpoints ahead, and of patience with a computer that is late.
PATIENT: Changes = (
    ("commit_ms = 50", "commit_ms = 200"),
    ("lookahead_ms = 1000", "lookahead_ms = 2000"),
    ("low_water_ms = 120", "low_water_ms = 250"),
    ("ahead_ms = 100 ", "ahead_ms = 500 "),
    ("watchdog_ms = 250", "watchdog_ms = 1000"),
)
OFFSETS = "[tool.1]\nx = 0.0\nz = 0.0\n"
# The spindle's speed swings by 2 % three times a second.
WANDER_HAL: Changes = (
    ("loadrt sim_spindle names=spindle\n", "loadrt sim_spindle names=spindle\nloadrt siggen num_chan=1\n"),
    ("loadrt lowpass", "loadrt mult2 names=swing\nloadrt lowpass"),
    (
        "addf spindle servo-thread\n",
        "addf siggen.0.update servo-thread\naddf swing servo-thread\naddf spindle servo-thread\n",
    ),
    (
        "net spindle-rps spindle-rps.out spindle.velocity-cmd",
        "net even-rps spindle-rps.out swing.in0\nnet sine siggen.0.sine swing.in1\n"
        "setp siggen.0.amplitude 0.02\nsetp siggen.0.frequency 3\nsetp siggen.0.offset 1\n"
        "net spindle-rps swing.out spindle.velocity-cmd",
    ),
)
WANDER: Changes = (('velocity = "spindle-rps.out"', 'velocity = "swing.out"'),)


def changed(text: str, changes: Changes) -> str:
    """With texts replaced, which must be there."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def lathe(folder: Path, machine: Changes = (), hal: Changes = (), text: str = "") -> Path:
    """Its machine file, the HAL file beside it: ``text``, or the shipped one."""
    text = text or resources.get_hal_path("gt75-hal.hal").read_text(encoding="utf-8")
    (folder / "gt75-hal.hal").write_text(changed(text, hal), encoding="utf-8")
    file = folder / "lathe.toml"
    file.write_text(changed(resources.read_machine_file("gt75-hal.toml"), machine), encoding="utf-8")
    return file


def run(folder: Path, program: str, machine: Path) -> subprocess.CompletedProcess[str]:
    """``turndesk run`` of a program, in a folder of its own; whether the computer was late is noted."""
    file, offsets, home = folder / "PIECE.nc", folder / "offsets.toml", folder / "home"
    file.write_text(program, encoding="utf-8")
    command = [sys.executable, "-m", "app.cli.main", "run", str(file), "--headless"]
    command += ["--machine", str(machine)]
    if "T1" in program:
        offsets.write_text(OFFSETS, encoding="utf-8")
        command += ["--offsets", str(offsets)]
    environment = {**os.environ, "TURNDESK_HOME": str(home)}

    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=150)
    command_was_late(home)
    return done
