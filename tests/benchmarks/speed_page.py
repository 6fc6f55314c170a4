"""Measures how fast TurnDesk is, writes its page: ``python -m tests.benchmarks.speed_page docs/speed.md``.

All figures are processor time, taken by turns with what they are compared with. Peers run beside where they
are installed: LinuxCNC's ``rs274``, which only interprets, and shapely. Takes some minutes. What the screen
and the feeder do was measured by benchmarks of their own, which keep their figures in
``tests/benchmarks/results``; ``--kept FILE`` writes those parts of a page anew and leaves the others.
"""

from __future__ import annotations

import json
import math
import platform
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from app.compose.machine_files import load_machine
from app.compose.machine_setup import setup_for
from core.interpreter.job_setup import Setup, ToolOffset
from core.language.source import Source
from core.machine.machine_model import Machine
from core.motion.axis_limits import MotionLimits
from core.motion.motion_plan import plan
from core.proving.prove_program import prove
from tests.benchmarks import bench_feeder, bench_removal, bench_start
from tests.benchmarks.bench_prove import feeds, program
from tests.benchmarks.footprint import RESULTS
from tests.benchmarks.installed import installed
from tests.benchmarks.processor_time import BARE, compared
from tests.benchmarks.speed_goals import GOALS, goal_of, not_met
from tests.motion.moves import rounded_chords
from tests.motion.paths import build_path

FEW = 3  # rounds of what takes seconds
RADIUS, CHORD, FEED = 50.0, 0.02, 100.0
FIRST_KEPT = "Frames of the window with a long program"
Row = Sequence[str]
Result = Mapping[str, Any]


def page() -> str:
    """The whole page."""
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        parts = [_head(), _starts(home), _bulk(home), _warm(), _removal(), _chords()]
    return "\n".join([*parts, kept()])


def kept(folder: Path = RESULTS) -> str:
    """The parts that other benchmarks have measured; one that never ran is named."""
    parts = []
    for name, title, write in (
        ("frames", FIRST_KEPT, _frames),
        ("idle", "At rest", _idle),
        ("feeder", "SYNC of the feeder beside other work", _feeder),
    ):
        file = folder / f"{name}.json"
        if not file.exists():
            parts.append(f"## {title}\n\nNot measured yet.\n")
            continue
        result = json.loads(file.read_text())
        parts.append(f"{write(title, result)}\n*{result['date']}, {result['machine']}.*\n")
    return "\n".join(parts)


def with_kept(text: str) -> str:
    """A page with those parts written anew."""
    return text.partition(f"## {FIRST_KEPT}\n")[0] + kept()


def _head() -> str:
    return f"""# Speed

Written by `python -m tests.benchmarks.speed_page docs/speed.md` on {time.strftime("%Y-%m-%d")}:
{_machine()}.
Figures are processor time, user and system, of whole processes or of the work alone where that is said:
medians, taken by turns with what they are compared with. A machine that others use stretches them, ratios
less. Goals are those of a machine that nobody else uses.
"""


def _machine() -> str:
    """Processor, system and Python."""
    cpu = Path("/proc/cpuinfo")
    lines = cpu.read_text().splitlines() if cpu.exists() else []
    name = next((each.partition(": ")[2] for each in lines if each.startswith("model name")), "")
    cores = sum(each.startswith("processor") for each in lines)
    system = f"{platform.system()}, Python {platform.python_version()}"
    return f"{name or platform.machine()}, {cores} cores, {system}"


def _table(title: str, head: Row, rows: Sequence[Row], below: str = "") -> str:
    lines = [head, ["---"] * len(head), *rows]
    text = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    return f"## {title}\n\n{text}" + (f"\n{below}\n" if below else "")


def _starts(home: Path) -> str:
    costs = bench_start.compared_starts(home)
    rows = [
        (name, seconds, goal_of(name, "{:.2f}"), *ratios)
        for name, seconds, *ratios in bench_start.table(costs)
    ]
    below = _reasons({name: (cost.seconds,) for name, cost in costs.items()})
    return _table(
        "From a cold process", ("", "s", "goal", "× bare interpreter", "× importing Qt"), rows, below
    )


def _bulk(home: Path) -> str:
    """Long programs as whole processes, rs274 beside."""
    offsets = home / "offsets.toml"
    offsets.write_text("[tool.1]\nx = 0.0\nz = 0.0\n")
    rows: list[Row] = []
    figures: dict[str, Sequence[float]] = {}
    for count in (100_000, 1_000_000):
        long = home / f"{count}.nc"
        long.write_text(program(count))
        commands: dict[str, Sequence[str]] = {
            f"{word} {count:,} blocks": [
                *bench_start.TURNDESK,
                *word.split(),
                str(long),
                "--offsets",
                str(offsets),
            ]
            for word in ("prove", "expand", "expand --json")
        }
        if peer := shutil.which("rs274"):
            commands[f"rs274 {count:,} blocks, interpreted only"] = [peer, "-g", str(_for_rs274(long))]
        costs = compared(
            {"bare interpreter": BARE, **commands}, installed(home, OPENBLAS_NUM_THREADS="1"), FEW
        )
        bare = costs.pop("bare interpreter").seconds
        figures |= costs
        rows += [
            (
                name,
                f"{cost.seconds:.2f}",
                goal_of(name, "{:.1f}"),
                f"{cost.seconds / bare:.0f}",
                f"{cost.memory:.0f}",
                _memory_goal(name),
            )
            for name, cost in costs.items()
        ]
    head = ("", "s", "goal", "× bare interpreter", "MiB", "goal")
    return _table("Long programs, whole processes", head, rows, _reasons(figures))


def _memory_goal(name: str) -> str:
    goal = GOALS.get(name)
    return f"{goal.memory:.0f}" if goal is not None and goal.memory else "–"


def _reasons(figures: Mapping[str, Sequence[float]]) -> str:
    """What stands below a table: why goals are not met, as profiles have shown."""
    told = list(not_met(figures))
    return "\n".join(["Over the goal, by profile:", "", *(f"- {each}" for each in told)]) if told else ""


def _for_rs274(path: Path) -> Path:
    """The same moves in RS-274: G01 on every line, the feed per minute, no tool."""
    lines = [line for line in path.read_text().replace("G95F.003", "F6").splitlines() if line != "T1"]
    lines = [line.replace("G72", "G20") for line in lines]
    other = path.with_suffix(".ngc")
    other.write_text("".join(f"G1{line}\n" if line.startswith("X") else f"{line}\n" for line in lines))
    return other


def _median_ms(work: Callable[[], object], rounds: int) -> str:
    """Median processor time of work in this process, ms, after a first time that does not count."""
    work()
    taken = []
    for _ in range(rounds):
        begun = time.process_time()
        work()
        taken.append(time.process_time() - begun)
    return f"{1000.0 * statistics.median(taken):.1f}"


def _proved(text: str, setup: Setup, machine: Machine) -> None:
    """Read anew and proved."""
    prove(Source("speed", text), setup, machine)


def _warm() -> str:
    """Proofs in a process that has proved before, as the editor's."""
    machine = load_machine(None)
    setup = setup_for(machine, tools={1: ToolOffset()}, secondary={})
    rows, figures = [], {}
    for count, rounds in ((200, 50), (20_000, 7)):
        text, name = program(count), f"prove {count:,} blocks, read anew"
        cost = _median_ms(partial(_proved, text, setup, machine), rounds)
        rows.append((name, cost, goal_of(name, "{:.0f}")))
        figures[name] = (float(cost),)
    text, name = feeds(20_000), "prove 20,000 blocks with an F on each, read anew"
    cost = _median_ms(partial(_proved, text, setup, machine), FEW)
    rows.append((name, cost, goal_of(name, "{:.0f}")))
    return _table("In a process that runs", ("", "ms", "goal"), rows, _reasons(figures))


def _removal() -> str:
    """Moves a second that are taken off the stock; shapely beside where it is installed."""
    todo = bench_removal.moves()
    works: dict[str, bench_removal.Work] = {
        "with all checks": bench_removal.checked,
        "metal alone": bench_removal.alone,
    }
    below = ""
    try:
        works["shapely"] = bench_removal.by_shapely()
    except ImportError:
        below = "shapely was not installed: no peer."
    rows = [
        (name, f"{1000.0 * bench_removal.MOVES / float(_median_ms(partial(work, todo), FEW)):,.0f}")
        for name, work in works.items()
    ]
    return _table("Removal of metal, 1000 roughing moves at .01 mm", ("", "moves a second"), rows, below)


def _chords() -> str:
    """Half a circle in chords of rounded words: planned time over the ideal one, by the tolerance stated."""
    ideal = math.pi * RADIUS / FEED + FEED / MotionLimits().plane_acceleration
    tolerances, count = (0.0, 0.0025, 0.0036, 0.005), 0.00127

    def ratios(grid: float) -> Iterator[str]:
        blocks = rounded_chords(round(math.pi * RADIUS / CHORD), FEED, grid)
        for each in tolerances:
            limits = MotionLimits(grain=max(count, each / math.sqrt(2.0)))
            yield f"{plan(build_path(blocks, limits)).duration / ideal:.3f}"

    rows = [(f"words of {grid} mm", *ratios(grid)) for grid in (0.00127, 0.00254, 0.005)]
    head = ("", *(f"corner_tolerance {each} mm" for each in tolerances))
    title = "Half a circle of R 50 mm in .02 mm chords at 100 mm/s: time over the ideal one"
    return _table(title, head, rows)


def _frames(title: str, result: Result) -> str:
    """How long the window took for a frame, and a hold until the slides stood."""
    median, most = result["a hold stands after, ms"]
    head = ("", "frames", "over 33 ms", "longest by the clock, ms", "of processor time, ms")
    rows = [(name, *(str(row[column]) for column in head[1:])) for name, row in result["rows"].items()]
    stands = f"a hold stands after {median} ms, {most} at most"
    below = f"{result['blocks']:,} blocks; {stands}. No frame over 33 ms is wanted."
    return _table(title, head, rows, below)


def _idle(title: str, result: Result) -> str:
    """Processor time of a desk at which nothing happens."""
    rows = [
        (machine, name, f"{share / 10.0:.1f}")
        for machine, shares in result["rows"].items()
        for name, share in shares.items()
    ]
    below = "At most 2 % are wanted of a desk whose machine does nothing."
    return _table(title, ("machine", "desk", "% of a core"), rows, below)


def _feeder(title: str, result: Result) -> str:
    """How late SYNC was, run by run."""
    below = (
        "Late in ms. A witness on each core, above the feeder's priority, only waits: how late it is, the "
        "computer is by itself; `own` are SYNCs at times when no witness was. p99 of .1 ms and no gap are "
        "wanted."
    )
    return _table(title, bench_feeder.HEAD, result["rows"], below)


def main() -> None:
    """Write the page to the file that is named, or print it."""
    if sys.argv[1:2] == ["--kept"]:
        file = Path(sys.argv[2])
        file.write_text(with_kept(file.read_text(encoding="utf-8")), encoding="utf-8")
        return
    text = page()
    if len(sys.argv) > 1:
        Path(sys.argv[1]).write_text(text, encoding="utf-8")
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
