"""The real window for an hour: pins are made by the real clock, and somebody looks at every page meanwhile.

``python -m tests.benchmarks.bench_screen_hour [--minutes 60] [--seed 1] [--keep FOLDER]``: the desk as it is
started in the shop, in a process of its own under an X server of its own, real keys. What it holds of the
computer is looked at from outside; a shorter run is extrapolated to an hour, and says so.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any
from unittest import mock

from core.store.store import Store
from tests.benchmarks.bench_night_shift import counted_in
from tests.benchmarks.footprint import Footprint, footprint, keep_result, plain
from tests.benchmarks.night_shift import INCH, NAME, PROGRAM, TOOLS, Truth
from tests.stories.x11 import Server, server

PAGES = ("F3", "F5", "F6", "F8", "F9", "F10", "b", "q", "w", "j", "F2")
COMES, SETTLES, MARKS = 20.0, 1.2, 20  # s until the window is there, s on a page, marks of a run
WARM = 0.25  # of a run: pages are opened for the first time, rings are filled
STANDS = {"READY", "FEED_HOLD", "INTERRUPTED", "OPTIONAL_STOP", "PROGRAM_STOPPED", "STOPPED"}
MADE = {"READY", "PROGRAM_COMPLETED"}


# --- the desk, in a process of its own ------------------------------------------------------------------


def desk(words: list[str]) -> int:
    """The screen as it is; beside it pins are counted at the slide itself, and told at the end.

    X is behind the middle of the parting tool only while a pin is parted off, and the plant knows the slide
    at every millisecond, however late its control is.
    """
    from app.cli.main import run_console  # noqa: PLC0415  the parent needs none of it
    from drivers.simulators.plant import SimulatedPlant  # noqa: PLC0415

    follow, middle = SimulatedPlant._follow_setpoints, TOOLS[3][0] * INCH
    pins, behind = 0, False

    def seen(plant: SimulatedPlant, *how: Any) -> bool:
        nonlocal pins, behind
        answer = follow(plant, *how)
        now = plant.servos[0].where < middle
        pins += now and not behind
        behind = now
        return answer

    sys.argv = ["turndesk", *words]
    try:
        with mock.patch.object(SimulatedPlant, "_follow_setpoints", seen):
            return run_console()
    finally:
        say(json.dumps({"pins": pins}) + "\n")


# --- who sits in front of it ----------------------------------------------------------------------------


class Looker:
    """Walks through the pages, holds the feed now and then, and goes on."""

    def __init__(self, stage: Server, home: Path, popen: subprocess.Popen[str], seed: int) -> None:
        self._stage, self._home, self.popen = stage, home, popen
        self._chance = random.Random(seed)
        self.pages = self.holds = self.starts = 0

    def key(self, *names: str) -> None:
        """One after the other, as a finger presses them."""
        for name in names:
            self._stage.down(name)
            time.sleep(0.06)
            self._stage.up(name)
            time.sleep(0.3)

    @property
    def state(self) -> str:
        """As ``status.json`` has it."""
        path = self._home / "status.json"
        return str(json.loads(path.read_text())["execution"]) if path.exists() else ""

    def begin(self) -> None:
        """Drives on, Cycle Repeat, both palms."""
        self.key("d")
        time.sleep(SETTLES)
        self.key("c")
        self.start()

    def start(self) -> None:
        """Both palms, on the page on which they count."""
        self.key("F1", "F2", "Escape")
        time.sleep(SETTLES)
        self._stage.down("F11", "F12")
        time.sleep(0.3)
        self._stage.up("F11", "F12")
        self.starts += 1
        time.sleep(SETTLES)

    def step(self) -> None:
        """A page, or a hold, or what has stopped goes on."""
        if self.popen.poll() is not None:
            raise RuntimeError(f"the desk has ended with {self.popen.returncode}")
        if self.state in STANDS:
            self.start()
        elif self._chance.random() < 0.03:
            self.key("F1", "F2", "Escape", "h")
            self.holds += 1
            time.sleep(SETTLES)
        else:
            self.key("F1", self._chance.choice(PAGES))
            self.pages += 1
            time.sleep(SETTLES)

    def finish(self) -> None:
        """Cycle Repeat off; the part under way is made, also one that is held, then the window is shut."""
        self.key("F1", "F2", "Escape", "c")
        for _ in range(60):
            if self.state in MADE:
                break
            if self.state in STANDS:
                self.start()
            time.sleep(1.0)
        time.sleep(SETTLES)


@contextmanager
def begun(stage: Server, home: Path, seed: int) -> Iterator[Looker]:
    """The window of a desk with tools and program."""
    (home / "programs").mkdir(parents=True)
    program = home / "programs" / NAME
    program.write_text(PROGRAM)
    with Store.open(home) as store:
        for number, (x, z) in TOOLS.items():
            store.offsets.tool_offsets.change_row(
                number, "touched off", {"x": x * INCH, "z": z * INCH}
            ).result()
    words = [sys.executable, "-m", __spec__.name, "--desk", "--program", str(program)]
    popen = subprocess.Popen(
        words,
        env=stage.environment | {"TURNDESK_HOME": str(home)},
        stdout=subprocess.PIPE,
        text=True,
    )
    while popen.poll() is None and not (home / "status.json").exists():
        time.sleep(1.0)
    time.sleep(COMES)
    try:
        yield Looker(stage, home, popen, seed)
    finally:
        popen.terminate()
        popen.wait(60)


def watched(home: Path, seed: int, minutes: float) -> dict[str, Any]:
    """The figures of so many minutes."""
    marks: dict[str, Footprint] = {}
    with server(home.parent / "x") as stage, begun(stage, home, seed) as looker:
        looker.begin()
        first = time.monotonic()
        for number in range(MARKS):
            while time.monotonic() < first + minutes * 60.0 * (number + 1) / MARKS:
                looker.step()
            mark = footprint(home, looker.popen.pid)
            marks[f"{minutes * (number + 1) / MARKS:.1f}"] = mark
            say(f"{minutes * (number + 1) / MARKS:6.1f} min, {mark}\n")
        looker.finish()
    assert looker.popen.stdout is not None
    told = json.loads(looker.popen.stdout.read().splitlines()[-1])
    with Store.open(home, read_only=True) as store:
        counts = counted_in(store, Truth(pins=told["pins"]))
        alarms = Counter(
            event.text.split(" line ")[0] for event in store.events.read_events(limit=1000, kinds=("alarm",))
        )
    return {
        "minutes": minutes,
        "marks": plain(marks),
        "counts": counts,
        "alarms": alarms,
        "done": {"pages": looker.pages, "holds": looker.holds, "starts": looker.starts},
        "in an hour": grown(list(marks.values()), minutes),
    }


def grown(marks: list[Footprint], minutes: float) -> dict[str, float]:
    """By how much each grows in an hour, from what it grew by behind the warm part of the run."""
    warm = int(len(marks) * WARM)
    first, last = asdict(marks[warm]), asdict(marks[-1])
    hours = minutes / 60.0 * (len(marks) - 1 - warm) / len(marks)
    return {name: round((last[name] - first[name]) / hours, 2) for name in first}


def say(text: str) -> None:
    """A line of the table."""
    sys.stdout.write(text)
    sys.stdout.flush()


def main() -> int:
    """Print the hour, keep its figures; status 1 when a count is not what was made.

    A program that an alarm breaks off behind the parting leaves a pin that nobody counts: there are at most
    as many of them as starts.
    """
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder of the figures")
    wanted = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        figures = watched(Path(folder) / "home", wanted.seed, wanted.minutes)
    say(f"{keep_result('screen_hour', figures, wanted.keep)}\n{figures['counts']}\n{figures['in an hour']}\n")
    made, starts = figures["counts"]["seen at the slides"], figures["done"]["starts"]
    counted = {figures["counts"][who] for who in ("store", "log", "cycles")}
    return int(len(counted) > 1 or not all(made - starts <= count <= made for count in counted))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--desk"]:
        sys.exit(desk(sys.argv[2:]))
    sys.exit(main())
