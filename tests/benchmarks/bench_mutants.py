"""Mutation: of how many small changes of a room its fast tests tell.

``python -m tests.benchmarks.bench_mutants ROOM [--number N] [--seed 1] [--keep FOLDER]``: the tests of the
room run once under coverage, which tells which of them come by a line; then each mutant gets a fork of that
process and those tests, the quickest first. Survivors are printed, and kept for ``docs/reliability.md``.
The test that tells must pass without the change right after: one that this computer's load has broken tells
nothing, and a fork that has to wait for a processor does not hang.

``--again TESTS``: what lived is played against these tests, also such as are marked long; which test told of
it is kept beside it.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import signal
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

import coverage
import pytest
from _pytest.runner import runtestprotocol

from tests.benchmarks.bench_branches import figures
from tests.benchmarks.footprint import RESULTS, keep_result
from tests.benchmarks.mutants import Mutant, mutants_of, put_in

ROOMS = {
    "core/executor": (120, ("tests/executor",)),
    "core/motion": (70, ("tests/motion", "tests/executor/test_chords.py")),
    "core/interpreter": (80, ("tests/interpreter", "tests/klartext", "tests/sinumerik", "tests/dialects")),
    "drivers/simulated": (30, ("tests/drivers/test_plant.py", "tests/drivers/test_plant_samples.py",
        "tests/drivers/test_schedule.py", "tests/drivers/test_station.py", "tests/drivers/test_gear.py",
        "tests/drivers/test_wear.py", "tests/drivers/test_wander.py", "tests/executor/test_jog.py",
        "tests/executor/test_faults.py", "tests/executor/test_run.py", "tests/executor/test_touch_off.py")),
}  # fmt: skip
SLOW = 2.0  # s of processor time; a test that takes longer is none of the fast ones
BUDGET = 25.0  # s of processor time for the tests of a mutant
WALL = 240.0  # s, but those in which it waits for a processor; what takes longer hangs
TOLD, QUIET, NOT_PUT = "told", "survives", "not put in"


class Session:
    """The plugin: maps lines to tests, then plays the mutants."""

    def __init__(self, room: str, number: int, seed: int, keep: Path, *, again: bool) -> None:
        self.room, self._number, self._seed, self._keep, self._again = room, number, seed, keep, again
        self._took: dict[str, float] = {}
        self._failed: set[str] = set()
        self.results: list[tuple[Mutant, str, int]] = []

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Instead of pytest's own."""
        items = {item.nodeid: item for item in session.items}
        tests_at = self._map(session)
        chosen = self._chosen()
        for number, mutant in enumerate(chosen, 1):
            names = self._tests(tests_at, mutant)
            outcome, by = self._sure([items[name] for name in names], mutant)
            self.results.append((mutant, outcome, len(names)))
            if outcome != TOLD or self._again or not by:
                say(f"{number:4d} {outcome:10s} {len(names):4d} tests  {mutant.name}  {by}\n")
            if not self._again:
                self._keep_so_far()
            elif outcome == TOLD:
                self._keep_told(mutant, by or "what ended by itself")
        return True

    def _tests(self, tests_at: dict[tuple[str, int], list[str]], mutant: Mutant) -> list[str]:
        """Those that come by any line of the statement as far as the change."""
        lines = range(mutant.first, mutant.line + 1)
        names = {name for line in lines for name in tests_at.get((mutant.path, line), ())}
        return sorted(names, key=self._took.__getitem__)

    def _chosen(self) -> list[Mutant]:
        if self._again:
            return [found for each in self._lived() if (found := _found_again(each)) is not None]
        paths = sorted(Path(self.room).rglob("*.py"))
        every = [mutant for path in paths for mutant in mutants_of(path)]
        return random.Random(self._seed).sample(every, min(self._number, len(every)))

    def _map(self, session: pytest.Session) -> dict[tuple[str, int], list[str]]:
        """By line the fast tests that come by it."""
        cover = coverage.Coverage(source=[self.room], data_file=None, config_file=False, branch=True)
        cover.start()
        for item, following in zip(session.items, [*session.items[1:], None], strict=True):
            cover.switch_context(item.nodeid)
            begun = time.process_time()
            reports = runtestprotocol(item, log=False, nextitem=following)
            self._took[item.nodeid] = time.process_time() - begun
            if any(report.failed for report in reports):
                self._failed.add(item.nodeid)
                say(f"fails without any change: {item.nodeid}\n")
        cover.stop()
        data, here = cover.get_data(), f"{Path.cwd()}/"
        say(f"{len(session.items)} tests, {sum(self._took.values()):.0f} s of processor time\n")
        self._tell_branches(cover)
        return {
            (file.removeprefix(here), line): [name for name in names if self._is_fast(name)]
            for file in data.measured_files()
            for line, names in data.contexts_by_lineno(file).items()
        }

    def _tell_branches(self, cover: coverage.Coverage) -> None:
        """Those that the fast tests take."""
        with tempfile.TemporaryDirectory() as folder:
            report = Path(folder) / "report.json"
            cover.json_report(outfile=str(report))
            found = figures(json.loads(report.read_text()))
        say(f"{found['taken']} of {found['branches']} branches, {found['per cent']} %\n")
        for each in found["not taken"]:
            say(f"    {each['file']}: {each['lines']}\n")

    def _is_fast(self, name: str) -> bool:
        return bool(name) and name not in self._failed and self._took[name] < SLOW

    def _sure(self, items: list[pytest.Item], mutant: Mutant) -> tuple[str, str]:
        """As ``_play``, by a test that passes without the change."""
        while items:
            outcome, by = self._play(items, mutant)
            teller = [item for item in items if item.nodeid == by]
            if not teller or self._play(teller, None)[0] == QUIET:
                return outcome, by
            say(f"fails now without any change: {by}\n")
            items = [item for item in items if item.nodeid != by]
        return QUIET, ""

    def _play(self, items: list[pytest.Item], mutant: Mutant | None) -> tuple[str, str]:
        """How it ended, and the test that told; empty where it ended by itself, or hung."""
        told, tells = os.pipe()
        child = os.fork()
        if child == 0:
            self._in_fork(items, mutant, tells)
        os.close(tells)
        outcome = self._ended(child)
        with os.fdopen(told, "rb") as pipe:
            return outcome, pipe.read().decode() if outcome == TOLD else ""

    def _ended(self, child: int) -> str:
        end = time.monotonic() + WALL
        while time.monotonic() < end + _waited(child):
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                if os.WIFSIGNALED(status):  # beyond its processor time, or it has broken the interpreter
                    return TOLD
                return (QUIET, TOLD, NOT_PUT)[min(os.WEXITSTATUS(status), 2)]
            time.sleep(0.005)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return TOLD

    def _in_fork(self, items: list[pytest.Item], mutant: Mutant | None, tells: int) -> None:
        """Never comes back."""
        resource.setrlimit(resource.RLIMIT_CPU, (int(2 * BUDGET), int(2 * BUDGET) + 1))
        status = 2
        try:
            if mutant is None or put_in(mutant):
                by = self._tells(items)
                os.write(tells, by.encode())
                status = int(bool(by))
        finally:
            os._exit(status)

    def _tells(self, items: list[pytest.Item]) -> str:
        """The first test that fails, or none."""
        spent = 0.0
        for item in items:
            spent += self._took[item.nodeid]
            if spent > BUDGET:
                return ""
            item._initrequest()  # type: ignore[attr-defined]  # as it was before it ran
            if any(report.failed for report in runtestprotocol(item, log=False, nextitem=None)):
                return item.nodeid
        return ""

    def _rooms(self) -> dict[str, Any]:
        kept = self._keep / "mutants.json"
        return dict(json.loads(kept.read_text())["rooms"]) if kept.exists() else {}

    @property
    def _name(self) -> str:
        fresh = f", seed {self._seed}" if self._seed != 1 else ""  # a sample that no test was written for
        return f"{self.room}{fresh}"

    def _lived(self) -> list[dict[str, Any]]:
        every: list[dict[str, Any]] = self._rooms()[self._name]["survivors"]
        return [each for each in every if "told by" not in each]

    def _keep_told(self, mutant: Mutant, by: str) -> None:
        rooms = self._rooms()
        for each in rooms[self._name]["survivors"]:
            if all(each[key] == getattr(mutant, key) for key in ("path", "function", "kind", "words")):
                each["told by"] = by.partition("[")[0]
        keep_result("mutants", {"rooms": rooms}, self._keep)

    def _keep_so_far(self) -> None:
        rooms = self._rooms()
        rooms[self._name] = {
            "seed": self._seed,
            "mutants": len(self.results),
            "told": sum(outcome == TOLD for _, outcome, _ in self.results),
            "not put in": sum(outcome == NOT_PUT for _, outcome, _ in self.results),
            "survivors": [asdict(m) | {"tests": n} for m, outcome, n in self.results if outcome == QUIET],
        }
        keep_result("mutants", {"rooms": rooms}, self._keep)


def _waited(child: int) -> float:
    """For how long its threads have waited for a processor that others had, s."""
    waited = 0.0
    for task in Path(f"/proc/{child}/task").glob("*/schedstat"):
        with suppress(OSError):  # a thread that has just ended
            waited += int(task.read_text().split()[1]) * 1e-9
    return waited


def _found_again(kept: dict[str, Any]) -> Mutant | None:
    """The mutant in the module as it is now: at its place, or the nearest with its words in its function."""
    same = [
        each
        for each in mutants_of(Path(kept["path"]))
        if (each.function, each.kind, each.words) == (kept["function"], kept["kind"], kept["words"])
    ]
    return min(
        same, key=lambda each: (each.place != kept["place"], abs(each.line - kept["line"])), default=None
    )


def say(text: str) -> None:
    """Past what pytest captures."""
    assert sys.__stdout__ is not None
    sys.__stdout__.write(text)
    sys.__stdout__.flush()


def main() -> int:
    """Play the mutants of one room."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("room", choices=ROOMS)
    parser.add_argument("--number", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=RESULTS, help="folder of the figures")
    parser.add_argument("--again", nargs="+", metavar="TESTS", help="play what lived against these tests")
    wanted = parser.parse_args()
    number, tests = ROOMS[wanted.room]
    again: list[str] = wanted.again or []
    plugin = Session(wanted.room, wanted.number or number, wanted.seed, wanted.keep, again=bool(again))
    which = again or [*tests]
    pytest.main(["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--capture=fd", *which], plugins=[plugin])
    told = sum(outcome == TOLD for _, outcome, _ in plugin.results)
    say(f"{wanted.room}: {told} of {len(plugin.results)} told\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
