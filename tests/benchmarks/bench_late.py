"""Lateness: whatever can be late, frozen, killed or starved; what then moves, how far, and what is said.

Run with ``python -m tests.benchmarks.bench_late [WORD …]``: every row, or those with one of the words in
their name. It starts the desk without its window (executor, watchdog, store, with and without the driver
host) as processes of its own, stops and kills them, and prints a table. Nothing is asserted. The executor
runs in a thread of the screen's process, as on systems other than Linux; ``tests/control`` and
``tests/killed`` check the process of the control.
"""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import resources
from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.commands import CycleStart, EnableDrives, FeedHold, Jog, LoadJob, Reset
from core.executor.job import Proof, make_job
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.store.store_file import STORE_FILE_NAME
from drivers.simulators.plant_controls import PlantControls

SHOWN = 0.01  # s between two lines of the child
STALLS = (0.1, 0.3, 0.5, 1.0, 5.0)
GO = "G90G94F300\nT1\nM03S600\nM08\nX.5Z0\n"
PROGRAMS = {
    "cut": f"{GO}G01F20Z-4\nM30\n",
    "rapid": f"{GO}" + "X3Z-4\nX.5Z0\n" * 4 + "M30\n",
    "dwell": f"{GO}G04F30\nG01F20Z-1\nM30\n",
    "M00": f"{GO}M00\nG01F20Z-1\nM30\n",
    "hold": f"{GO}G01F20Z-4\nM30\n",
    "thread": f"{GO}X.5Z.2\nX.25\nG33X.2Z-3I.05K.05\nG00Z1\nM30\n",
}
Shot = dict[str, Any]


# --- the desk without its window, in a process of its own ---------------------------------------------------


class Child:
    """Words in by standard input, a line for each look out."""

    def __init__(self, machine_file: str) -> None:
        from app.compose.machine.machine_setup import read_machine  # noqa: PLC0415
        from app.compose.screen_desk import build_desk  # noqa: PLC0415  the parent needs none of it

        self.desk = build_desk(machine_file, begun_control=(read_machine(machine_file), None))
        assert self.desk.machine.machine is not None
        self.lathe = self.desk.machine.machine
        thread = next(t for t in threading.enumerate() if t.name == "executor")
        self.executor = thread._target.__self__.executor  # type: ignore[attr-defined]
        self.jogging = 0.0
        self.programs = 0

    def run(self) -> None:
        """Until standard input ends."""
        for task in (self._show, self._jog):
            threading.Thread(target=task, daemon=True).start()
        post = self.desk.post
        acts: dict[str, Callable[[Any], None]] = {
            "drives": lambda _: post(EnableDrives()),
            "start": lambda _: post(CycleStart()),
            "hold": lambda _: post(FeedHold()),
            "reset": lambda _: post(Reset()),
            "jog": lambda speed: setattr(self, "jogging", speed),
            "load": self._load,
            "block executor": lambda seconds: _once(self.executor, partial(time.sleep, seconds)),
            "kill executor": lambda _: _once(self.executor, _die),
            "lock held": _hog,
            "busy": _two_busy,
            "clock": _shift_clock,
        }
        for line in sys.stdin:
            words = json.loads(line)
            acts[words["do"]](words.get("with"))
        self.desk.close()

    def _load(self, text: str) -> None:
        self.programs += 1
        setup = create_power_up_setup(
            self.lathe, tool_offsets={1: ToolOffset(0.0, 0.0)}, secondary_offsets={}
        )
        job = make_job(ProgramSource(f"PART{self.programs}", text), setup)
        self.desk.post(LoadJob(job, Proof(job.digest, ())))

    def _show(self) -> None:
        while True:
            shot, played = self.desk.read_snapshot(), self.desk.desk_control.station_panel
            rpm, on, at = shot.rpm_actual, set(shot.outputs), shot.actual[:2]
            if isinstance(
                played, PlantControls
            ):  # as the machine really is, also where nobody looks any more
                rpm, at = played.get_spindle_rpm(), played.get_true_positions()[:2]
                on = {name for name, lit in played.outputs().items() if lit}
            told = {
                "t": time.monotonic(),
                "stamp": shot.t,
                "state": shot.state.value,
                "why": shot.waiting_for or (shot.stop.cause if shot.stop else ""),
                "at": at,
                "rpm": rpm,
                "on": sorted(on - {"collet"}),
                "alarms": [f"{alarm.number} {alarm.text}" for alarm in shot.alarms],
                "starts": list(shot.announced),
                "refused": shot.start_refusal_reason,
            }
            sys.stdout.write(json.dumps(told) + "\n")
            sys.stdout.flush()
            time.sleep(SHOWN)

    def _jog(self) -> None:
        """The screen's thread, which renews while the key is held and gives up when it was late itself."""
        while True:
            before = time.monotonic()
            time.sleep(0.04)
            if time.monotonic() - before > 0.3:
                self.jogging = 0.0
            if self.jogging:
                self.desk.post(Jog("Z", self.jogging, self.lathe.timing.motion_lease_s))


def _hog(seconds: float) -> None:
    """One multiplication of such numbers keeps Python's lock for some tenths of a second."""
    big, end = 1 << 3_000_000, time.monotonic() + seconds
    while time.monotonic() < end:
        big = (big * big) >> 3_000_000


def _two_busy(seconds: float) -> None:
    for _ in range(2):
        threading.Thread(target=_spin, args=(seconds,), daemon=True).start()


def _shift_clock(seconds: float) -> None:
    now = time.time
    time.time = lambda: now() + seconds


def _once(executor: Any, what: Callable[[], None]) -> None:
    """In the middle of its next tick."""
    look = executor._look

    def late() -> None:
        executor._look = look
        look()
        what()

    executor._look = late


def _die() -> None:
    raise KeyboardInterrupt


def _spin(seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        pass


# --- whoever stops and kills it -----------------------------------------------------------------------------


class Desk:
    """The process, and the last it has said."""

    def __init__(self, *, host: bool) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self.home = Path(self._folder.name)
        text = resources.read_machine_file("gt75.toml")
        if host:
            text = text.replace("[machine]\n", "[machine]\nfeeder = true\n", 1)
        (self.home / "m.toml").write_text(text)
        self.popen = subprocess.Popen(
            [sys.executable, "-m", __spec__.name, "--child", str(self.home / "m.toml")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=(self.home / "stderr.txt").open("wb"),
            env=os.environ | {"TURNDESK_HOME": str(self.home)},
        )
        self.shots: list[Shot] = []
        threading.Thread(target=self._read, daemon=True).start()
        self.until(lambda: bool(self.shots), 30.0)

    def _read(self) -> None:
        assert self.popen.stdout is not None
        for line in self.popen.stdout:
            self.shots.append(json.loads(line))

    @property
    def now(self) -> Shot:
        return self.shots[-1]

    def do(self, what: str, value: object = None) -> None:
        assert self.popen.stdin is not None
        self.popen.stdin.write(json.dumps({"do": what, "with": value}).encode() + b"\n")
        self.popen.stdin.flush()

    def until(self, true: Callable[[], bool], seconds: float = 15.0) -> bool:
        end = time.monotonic() + seconds
        while not true() and time.monotonic() < end:
            time.sleep(0.005)
        return true()

    def host(self) -> int:
        """Its process."""
        path = Path(f"/proc/{self.popen.pid}/task")
        children = [int(pid) for task in path.iterdir() for pid in (task / "children").read_text().split()]
        return children[0]

    def ready(self) -> None:
        """Drives on, nothing under way."""
        for _ in range(30):
            state = self.now["state"]
            if state == "READY":
                return
            self.do("drives" if state == "DRIVES OFF" and not self.now["alarms"] else "reset")
            time.sleep(0.3)

    def close(self) -> None:
        self.popen.kill()
        self.popen.wait()
        time.sleep(0.1)
        self._folder.cleanup()


def _for_a_while(desk: Desk, state: str, seconds: float) -> bool:
    """Whether the state was reached, which then goes on for so long."""
    reached = desk.until(lambda: bool(desk.now["state"] == state))
    if reached:
        time.sleep(seconds)
    return reached


def bring(desk: Desk, place: str) -> bool:
    """Into this situation; whether it was reached."""
    desk.ready()
    if place == "at rest":
        time.sleep(0.4)
        return bool(desk.now["state"] == "READY")
    if place == "jog":
        desk.do("jog", -20.0 if desk.now["at"][1] > -50.0 else 20.0)
        return _for_a_while(desk, "JOG", 0.5)
    desk.do("load", PROGRAMS[place])
    time.sleep(0.4)
    desk.do("start")
    first = (12.7, 0.0)  # where every program begins: what is seen before is the end of the last one
    if not desk.until(lambda: max(abs(a - b) for a, b in zip(desk.now["at"], first, strict=True)) < 0.3):
        return False
    there: dict[str, Callable[[], bool]] = {
        "dwell": lambda: desk.now["why"] == "DWELL" and desk.now["rpm"] > 590.0,
        "M00": lambda: desk.now["state"] == "PROGRAM STOP" and desk.now["rpm"] > 590.0,
        "thread": lambda: desk.now["at"][0] < 6.2 and desk.now["at"][1] < -5.0,
        "rapid": lambda: desk.now["at"][0] > 20.0,
    }
    default = lambda: desk.now["at"][1] < -4.0 and desk.now["rpm"] > 500.0  # noqa: E731
    if not desk.until(there.get(place, default)):
        return False
    if place == "hold":
        desk.do("hold")
        return _for_a_while(desk, "FEED HOLD", 0.3)
    return True


class Row(NamedTuple):
    """One line of the table."""

    what: str
    place: str
    way: str
    after: str
    goes_on: str


def way(a: Shot, b: Shot) -> float:
    return max(abs(float(p) - float(q)) for p, q in zip(a["at"], b["at"], strict=True))


def measured(desk: Desk, what: str, place: str, act: Callable[[], None], settle: float = 2.5) -> Row:
    """Do it in this situation, and see what comes of it."""
    if not bring(desk, place):
        return Row(what, place, "?", f"not reached: {desk.now['state']} {desk.now['alarms']}", "")
    before = desk.now
    act()
    time.sleep(0.15)
    woken = desk.now
    time.sleep(settle)
    desk.do("jog", 0.0)
    after = desk.now
    still = desk.shots[-30] if len(desk.shots) > 30 else after
    moving = way(still, after) > 0.01
    said = [after["state"], after["why"], *after["alarms"][:1]]
    on = [f"{after['rpm']:.0f} rpm", *after["on"]] if after["rpm"] or after["on"] else ["all off"]
    silent = time.monotonic() - after["t"] > 1.0 or after["stamp"] == woken["stamp"]
    told = f"{': '.join(filter(None, said))}{' (CONTROL SILENT)' if silent else ''}; {', '.join(on)}"
    reach = f"{way(before, woken):.1f}" + ("…" if moving else f" → {way(before, after):.1f}")
    return Row(what, place, reach, told, goes_on(desk, after))


def goes_on(desk: Desk, after: Shot) -> str:
    """Whether Cycle Start goes on from a stop, and what it said that it would start."""
    if after["state"] not in {"FEED HOLD", "PROGRAM STOP"}:
        return "goes on by itself" if after["state"] in {"RUNNING", "WAITING"} else "–"
    starts = ", ".join(after["starts"])
    desk.do("start")
    went = desk.until(lambda: desk.now["state"] in {"RUNNING", "WAITING"}, 1.5)
    fails = desk.now["refused"] or desk.now["state"]
    return ("Cycle Start" if went else f"NO: {fails}") + (f" ({starts})" if starts else "")


def stopped(pid: int, seconds: float) -> None:
    os.kill(pid, signal.SIGSTOP)
    time.sleep(seconds)
    os.kill(pid, signal.SIGCONT)


def starved(pid: int, seconds: float) -> None:
    """Of a computer that swaps it gets a fifth, in pieces."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        stopped(pid, 0.08)
        time.sleep(0.02)


def disk_blocked(home: Path, seconds: float) -> None:
    """Somebody else holds the store."""
    other = sqlite3.connect(home / STORE_FILE_NAME, isolation_level=None)
    other.execute("BEGIN EXCLUSIVE")
    time.sleep(seconds)
    other.execute("ROLLBACK")
    other.close()


Case = tuple[str, str, bool, Callable[[Desk], None]]


def cases() -> list[Case]:
    """Name, situation, with the driver host, what is done."""
    found: list[Case] = []
    for host in (False, True):
        name = "with driver host" if host else "no driver host"
        for place in ("cut", "rapid", "dwell", "M00", "jog", "thread", "hold", "at rest"):
            for seconds in STALLS:

                def stall(desk: Desk, seconds: float = seconds) -> None:
                    stopped(desk.popen.pid, seconds)

                found.append((f"{name}: control stopped {seconds:g} s", place, host, stall))
        for place in ("cut", "dwell"):
            found += [
                (f"{name}: control starved 3 s", place, host, lambda d: starved(d.popen.pid, 3.0)),
                (
                    f"{name}: executor blocked .5 s",
                    place,
                    host,
                    lambda d: d.do("block executor", 0.5),
                ),
                (
                    f"{name}: executor blocked 3 s",
                    place,
                    host,
                    lambda d: d.do("block executor", 3.0),
                ),
                (f"{name}: executor killed", place, host, lambda d: d.do("kill executor")),
                (f"{name}: Python's lock held 2 s", place, host, lambda d: d.do("lock held", 2.0)),
                (f"{name}: two busy workers 3 s", place, host, lambda d: d.do("busy", 3.0)),
                (f"{name}: wall clock + 1 h", place, host, lambda d: d.do("clock", 3600.0)),
                (f"{name}: wall clock − 1 h", place, host, lambda d: d.do("clock", -3600.0)),
                (f"{name}: store held 3 s", place, host, lambda d: disk_blocked(d.home, 3.0)),
            ]
    for place in ("cut", "dwell", "hold"):
        for seconds in (0.1, 0.3, 1.0):

            def host_stall(desk: Desk, seconds: float = seconds) -> None:
                stopped(desk.host(), seconds)

            found.append((f"driver host stopped {seconds:g} s", place, True, host_stall))
        found.append(("driver host killed", place, True, lambda d: os.kill(d.host(), signal.SIGKILL)))
    return found


FINAL = ("killed", "blocked 3 s", "driver host stopped 1")  # behind these the desk is started anew


def main(words: list[str]) -> None:
    """Print the table as it comes."""
    desks: dict[bool, Desk] = {}
    sys.stdout.write(
        "| what | in | way, mm: at its return → at rest | then | goes on |\n|---|---|---|---|---|\n"
    )
    for what, place, host, act in cases():
        if words and not any(word in f"{what} {place}" for word in words):
            continue
        desk = desks.get(host) or Desk(host=host)
        desks[host] = desk
        settle = 4.0 if "3 s" in what or "killed" in what or place == "rapid" else 2.5
        row = measured(desk, what, place, partial(act, desk), settle)
        sys.stdout.write(f"| {' | '.join(row)} |\n")
        sys.stdout.flush()
        if any(word in what for word in FINAL) or row.way == "?":
            desks.pop(host).close()
    for desk in desks.values():
        desk.close()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        Child(sys.argv[2]).run()
    else:
        main(sys.argv[1:])
