"""A shift on a busy computer: the real window, a robot at its keys, and programs that want the processors.

``python -m tests.benchmarks.bench_busy [--minutes 30] [--busy 8] [--presses 2000] [--beside COMMAND] [--name
NAME] [--all-rights]``: an X server with a window manager, the demo with a program of a cut, a thread and C
moves in cycle repeat. The robot presses OPTIONAL STOP again and again, at known times, and Feed Hold every
twenty seconds. Busy processes and one that allocates memory in bursts run at the same time. ``--beside`` also
runs a shell command on the same display, such as a browser that plays a video, again and again until the end.
Each feed hold outside a thread pass is compared with the stated time: that of a prompt computer, and what the
screen had announced before the key. Without ``--all-rights`` the processes have the rights of an ordinary
user. The result is printed and stored as NAME for docs/late.md. Nothing is asserted.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import queue
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from PySide6.QtCore import QEvent, QObject

from app.cli.main import run_console
from app.compose.control.control_client import ControlClient
from app.screen import screen_startup
from core.store.store import Store
from tests.benchmarks.footprint import keep_result
from tests.stories.x11 import Server, server

PROGRAM = """G90G94F300
T1
M03S900
M08
X.5Z.1
G01F12Z-.6
G00X.6
Z.1
X.45
G33X.44Z-.5I.01K.05
G00X.6Z.2
M05
M19
C0
G01C90F300
G00X.5Z0.
G01F20C180Z-.1
G00X.7Z.3
C0
G04F.5
M05
M09
M30
"""
THREAD_LINE = next(n for n, line in enumerate(PROGRAM.splitlines(), 1) if line.startswith("G33"))
HOLDS_EVERY = 20.0  # s
LEAST_PICTURES = 10  # a second
PROMPT_HOLD = 0.25  # s from the key to a standstill on a computer that is not late; measured: up to .22 s
RESUMES_AFTER = 1.0  # s
PALMS = ("F11", "F12")
CAPABILITIES = "-sys_nice,-ipc_lock"
ORDINARY = [
    *("setpriv", "--bounding-set", CAPABILITIES, f"--inh-caps={CAPABILITIES}"),
    *("prlimit", "--memlock=8388608:8388608", "--rtprio=0:0"),
]
BUSY = "while True: pass"
BURSTS = """import time
while True:
    kept = bytearray(600_000_000)
    kept[::4096] = kept[::4096]
    del kept
    time.sleep(1.0)
"""


# --- the screen, in a process of its own --------------------------------------------------------------------


def screen(words: list[str]) -> int:
    """The screen as it is; each change of state and each second of painting is a line of JSON."""
    take, application = ControlClient._take, screen_startup._application
    before: list[object] = [None]

    def told(client: ControlClient, message: object, events: Any) -> None:
        take(client, message, events)
        shot = client.snapshot
        now = (
            shot.state.value,
            shot.parts,
            shot.hold_delay_s,
            shot.underruns,
            [each.number for each in shot.alarms],
            shot.line == THREAD_LINE,
        )
        if now != before[0]:
            before[0] = now
            seconds = client.hello_message.clock_zero_s + shot.t
            names = ("state", "parts", "later", "underruns", "alarms", "threads")
            say({"t": seconds, **dict(zip(names, now, strict=True))})

    class Paints(QObject):
        def __init__(self) -> None:
            super().__init__()
            self.times: list[float] = []

        def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
            if event.type() == QEvent.Type.UpdateRequest:
                now = time.monotonic()
                self.times.append(now)
                if now - self.times[0] >= 1.0:
                    say({"paints": self.times})
                    self.times = [now]
            return False

    paints: list[Paints] = []

    def watched(theme: str) -> Any:
        app = application(theme)
        paints.append(Paints())
        app.installEventFilter(paints[0])
        return app

    ControlClient._take = told  # type: ignore[method-assign, assignment]
    screen_startup._application = watched
    sys.argv[1:] = words
    return run_console()


def say(line: dict[str, object]) -> None:
    sys.stdout.write(json.dumps(line) + "\n")
    sys.stdout.flush()


# --- the robot ----------------------------------------------------------------------------------------------


class Hold(NamedTuple):
    """A feed hold: s from the key to the standstill, s that were stated before the key, and where it was."""

    took: float
    stated: float
    in_thread: bool


class Robot:
    """Hands on the keys of one screen, and what that screen says."""

    def __init__(self, display: Server, command: list[str], home: Path) -> None:
        self._display = display
        environment = display.environment | {"TURNDESK_HOME": str(home)}
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, env=environment, text=True)
        self._lines: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
        self.paints: list[float] = []
        self.later, self.alarms, self.parts, self.underruns = 0.0, set[int](), 0, 0
        self.announced, self.threads = 0.0, False  # at the moment
        self.state, self.since = "", 0.0
        self.states: list[tuple[float, str]] = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._lines.put(json.loads(line))

    def look(self) -> None:
        """Take what the screen has said."""
        while not self._lines.empty():
            line = self._lines.get()
            if "paints" in line:
                self.paints += line["paints"]
                continue
            self.later, self.parts = max(self.later, line["later"]), line["parts"]
            self.announced, self.threads = line["later"], line["threads"]
            self.alarms.update(line["alarms"])
            self.underruns = line["underruns"]
            if line["state"] != self.state:
                self.state, self.since = line["state"], line["t"]
                self.states.append((self.since, self.state))

    def wait(self, states: set[str], limit: float = 60.0) -> bool:
        """Wait for one of the states; False if none comes."""
        end = time.monotonic() + limit
        while time.monotonic() < end:
            self.look()
            if self.state in states:
                return True
            time.sleep(0.01)
        return False

    def press(self, *keys: str) -> float:
        """Press and release keys; the time of the press, s of the monotonic clock."""
        now = time.monotonic()
        self._display.down(*keys)
        time.sleep(0.03)
        self._display.up(*reversed(keys))
        return now


def shift(robot: Robot, seconds: float, presses: int) -> dict[str, Any]:
    """Make parts for so long; what came of it."""
    assert robot.wait({"DRIVES OFF"}), robot.state
    time.sleep(5.0)
    robot.press("d")
    assert robot.wait({"READY"}), robot.state
    robot.press("c")
    time.sleep(3.0)
    start(robot)
    held, missed = list[Hold](), 0
    end, next_hold, every = time.monotonic() + seconds, time.monotonic() + HOLDS_EVERY, seconds / presses
    pressed, next_press = 0, time.monotonic()
    while time.monotonic() < end and not robot.alarms:
        robot.look()
        now = time.monotonic()
        if now >= next_press:
            robot.press("o")
            pressed, next_press = pressed + 1, next_press + every
        if now >= next_hold and robot.state == "RUNNING":
            stated, in_thread = PROMPT_HOLD + robot.announced, robot.threads
            at = robot.press("Pause")
            if robot.wait({"FEED HOLD"}, 10.0):
                held.append(Hold(robot.since - at, stated, in_thread))
            else:
                missed += 1
            time.sleep(RESUMES_AFTER)
            start(robot)
            next_hold = time.monotonic() + HOLDS_EVERY
        time.sleep(0.01)
    robot.press("Pause")
    time.sleep(2.0)
    return {"pressed": pressed, "held": held, "holds missed": missed}


def start(robot: Robot) -> None:
    """Press both palm buttons until the cycle goes on; people try again, too."""
    for _ in range(5):
        robot.press(*PALMS)
        if robot.wait({"RUNNING", "WAITING"}, 3.0):
            return


# --- the load -----------------------------------------------------------------------------------------------


@contextmanager
def load(count: int, beside: str, environment: dict[str, str]) -> Iterator[None]:
    """Run busy processes, with one that allocates memory in bursts, and repeat a shell command."""
    words = [[sys.executable, "-c", each] for each in [BUSY] * count + [BURSTS] * bool(count)]
    words += [["sh", "-c", f"while true; do {beside}\ndone"]] * bool(beside)
    running = [
        subprocess.Popen(
            each,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        for each in words
    ]
    try:
        yield
    finally:
        for each in running:
            os.killpg(each.pid, signal.SIGKILL)
            each.wait()


def find_running_periods(states: list[tuple[float, str]]) -> list[tuple[float, float]]:
    """Return start and end of the periods in which the axes moved by a program, s of the monotonic clock."""
    return [(t, end) for (t, state), (end, _) in pairwise(states) if state == "RUNNING"]


def measure_pictures(paints: list[float], periods: list[tuple[float, float]]) -> tuple[float, float]:
    """Return the longest time without a picture, s, and the share of seconds with fewer than ten pictures.

    Only the periods count: a screen on which nothing changes is not painted.
    """
    longest, few, seconds = 0.0, 0, 0
    for start, end in periods:
        times = [start, *(each for each in paints if start < each < end), end]
        longest = max(longest, *(b - a for a, b in pairwise(times)))
        whole = range(math.ceil(start), math.floor(end))
        counts = Counter(math.floor(each) for each in times[1:-1])
        few += sum(counts[each] < LEAST_PICTURES for each in whole)
        seconds += len(whole)
    return longest, few / max(seconds, 1)


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--busy", type=int, default=8)
    parser.add_argument("--presses", type=int, default=2000)
    parser.add_argument("--name", default="busy")
    parser.add_argument("--beside", default="", metavar="COMMAND")
    parser.add_argument("--all-rights", action="store_true")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, server(Path(folder, "x")) as display:
        home, program = Path(folder, "home"), Path(folder, "shift.nc")
        program.write_text(PROGRAM)
        words = [sys.executable, "-m", "tests.benchmarks.bench_busy", "screen", "--demo"]
        words += ["--program", str(program)]
        robot = Robot(display, words if args.all_rights else [*ORDINARY, *words], home)
        with load(args.busy, args.beside, display.environment):
            told = shift(robot, 60.0 * args.minutes, args.presses)
        robot.process.terminate()
        robot.process.wait(60)
        with Store.open(home / "demo", read_only=True) as store:
            events = store.events.read_events("", 100_000, ())
        switched = sum(event.kind == "switch" and "optional" in event.text.lower() for event in events)
        periods = find_running_periods(robot.states)
        held, (longest, few) = told.pop("held"), measure_pictures(robot.paints, periods)
        free = [hold for hold in held if not hold.in_thread]  # the others act at the end of the thread pass
        times = [hold.took for hold in free]
        in_thread = [hold.took for hold in held if hold.in_thread]
        result = {
            "minutes": args.minutes,
            "busy": args.busy,
            "beside": args.beside,
            "rights": "all" if args.all_rights else "ordinary",
            "load": os.getloadavg()[0],
            **told,
            "keys that acted": switched,
            "parts": robot.parts,
            "alarms": sorted(robot.alarms),
            "holds": len(held),
            "holds in a thread pass": len(in_thread),
            "hold in a thread pass, worst s": max(in_thread, default=None),
            "hold, median s": statistics.median(times) if times else None,
            "hold, worst s": max(times, default=None),
            "holds later than stated": sum(hold.took > hold.stated for hold in free),
            "hold, worst s later than stated": max((hold.took - hold.stated for hold in free), default=None),
            "holds later than announced, s": robot.later,
            "longest time without a picture, s": longest,
            "seconds with fewer than 10 pictures": few,
            "holds by a low queue": robot.underruns,
        }
    sys.stdout.write(json.dumps(result, indent=1) + "\n")
    keep_result(args.name, result)
    return 0


if __name__ == "__main__":
    sys.exit(screen(sys.argv[2:]) if sys.argv[1:2] == ["screen"] else main())
