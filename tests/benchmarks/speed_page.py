"""Measures how fast TurnDesk is, writes its page: ``python -m tests.benchmarks.speed_page docs/speed.md``.

All figures are processor time, taken by turns with what they are compared with. Peers run beside where they
are installed: LinuxCNC's ``rs274``, which only interprets, and shapely. Takes some minutes. What the screen
and the driver host do was measured by benchmarks of their own, which keep their figures in
``tests/benchmarks/results``; ``--kept FILE`` writes those parts of a page and leaves the others.
"""

from __future__ import annotations

import json
import math
import os
import platform
import re
import shutil
import statistics
import sys
import tempfile
import textwrap
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.motion.axis_limits import MotionLimits
from core.motion.motion_plan import plan_motion
from core.page_contents import make_table_of_contents
from core.proving.prove_program import prove
from tests.benchmarks import bench_driver_host, bench_removal, bench_start
from tests.benchmarks.bench_prove import feeds, program
from tests.benchmarks.footprint import RESULTS
from tests.benchmarks.installed import installed
from tests.benchmarks.processor_time import BARE, compared
from tests.benchmarks.speed_goals import goal_of, not_met
from tests.motion.moves import rounded_chords
from tests.motion.paths import build_path

FEW = 3  # rounds of what takes seconds
_SHOWS_GROWTH = 100_000  # lines from which the time per line exceeds the differences between two starts
RADIUS, CHORD, FEED = 50.0, 0.02, 100.0
TITLES = (
    "Start of a process",
    "Long programs",
    "Proofs in a running process",
    "Cutting the stock",
    "Chords of a half circle",
    "Growth with the length of a program",
    "Long jobs",
    "Frames of the window with a long program",
    "At rest",
    "SYNC of the driver host under load",
)
STARTS, BULK, WARM, STOCK, CHORDS, FIRST_KEPT, JOBS, FRAMES, REST, SYNC = TITLES
_SHOWN = {
    "longest by the clock, ms": "longest, wall-clock, ms",
    "of processor time, ms": "longest, CPU time, ms",
    "running, held and started": "running, with feed hold and restart",
    "minimised": "minimized",
    "servo off": "drives off",
    "servo on": "drives on",
}
"""Names of the stored results, as the page shows them; other names stay."""
_LATE = "setpoints were {} because this computer stalled for too long"
"""Fault in the stored results, in the present words of the product."""
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
        ("growth", FIRST_KEPT, _growth),
        ("long_jobs", JOBS, _jobs),
        ("frames", FRAMES, _frames),
        ("idle", REST, _idle),
        ("feeder", SYNC, _host),
    ):
        file = folder / f"{name}.json"
        if not file.exists():
            parts.append(f"## {title}\n\nNot measured yet.\n")
            continue
        result = json.loads(file.read_text())
        parts.append(f"{write(title, result)}\n*{result['date']}, {result['machine']}.*\n")
    return "\n".join(parts)


def with_kept(text: str) -> str:
    """Return a page with those parts written again."""
    return text.partition(f"## {FIRST_KEPT}\n")[0] + kept()


def _head() -> str:
    return f"""# Speed, measured

This page lists the CPU time and memory that TurnDesk needs, with goals. If a goal is not met, the
reason is given below the table.

{make_table_of_contents(TITLES)}
`python -m tests.benchmarks.speed_page docs/speed.md` created this page on {time.strftime("%Y-%m-%d")}:
{_machine()}.

All times are medians of CPU time (user and system). They apply to a whole process unless the section
states otherwise. Measurements that are compared are taken alternately. If other users share the
computer, the times are longer, but the ratios change less. The goals apply to a computer without other
users.
"""


def _filled(text: str) -> str:
    """Return a paragraph wrapped at 100 columns."""
    return textwrap.fill(text, 100, break_long_words=False, break_on_hyphens=False)


def _machine() -> str:
    """Return the processor, system and Python."""
    cpu = Path("/proc/cpuinfo")
    lines = cpu.read_text().splitlines() if cpu.exists() else []
    name = next((each.partition(": ")[2] for each in lines if each.startswith("model name")), "")
    cores = sum(each.startswith("processor") for each in lines)
    system = f"{platform.system()}, Python {platform.python_version()}"
    return f"{name or platform.machine()}, {cores} cores, {system}"


def _table(title: str, head: Row, rows: Sequence[Row], below: str = "", above: str = "") -> str:
    lines = [head, ["---"] * len(head), *rows]
    text = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    return f"## {title}\n\n" + (f"{above}\n\n" if above else "") + text + (f"\n{below}\n" if below else "")


def _starts(home: Path) -> str:
    costs = bench_start.compared_starts(home)
    rows = [
        (name, seconds, goal_of(name, "{:.2f}"), *ratios)
        for name, seconds, *ratios in bench_start.table(costs)
    ]
    below = _reasons({name: (cost.seconds,) for name, cost in costs.items()})
    return _table(
        STARTS, ("process", "CPU time, s", "goal, s", "× bare interpreter", "× importing Qt"), rows, below
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
            commands[f"rs274 {count:,} blocks, interpreted only"] = [
                peer,
                "-g",
                str(for_rs274(long)),
                os.devnull,
            ]
        costs = compared(
            {"bare interpreter": BARE, **commands}, installed(home, OPENBLAS_NUM_THREADS="1"), FEW
        )
        bare = costs.pop("bare interpreter").seconds
        other = costs.get(f"rs274 {count:,} blocks, interpreted only")
        for name, cost in costs.items():
            ratio = cost.seconds / other.seconds if other is not None else 0.0
            figures[name] = (*cost, ratio)
            rows.append(
                (
                    name,
                    f"{cost.seconds:.2f}",
                    goal_of(name, "{:.1f}"),
                    f"{cost.seconds / bare:.0f}",
                    f"{ratio:.2f}" if ratio else "–",
                    goal_of(name, "{:.2f}", "peer"),
                    f"{cost.memory:.0f}",
                    goal_of(name, "{:.0f}", "memory"),
                )
            )
    head = (
        *("process", "CPU time, s", "goal, s", "× bare interpreter", "× rs274", "goal, × rs274"),
        *("memory, MiB", "goal, MiB"),
    )
    above = "`rs274` is the interpreter of LinuxCNC. It interprets the program but does not prove it."
    return _table(BULK, head, rows, _reasons(figures), above)


def _reasons(figures: Mapping[str, Sequence[float]]) -> str:
    """Return the list below a table: why goals are not met, as profiles have shown."""
    told = list(not_met(figures))
    return (
        "\n".join(
            [
                "These goals are not met. A profile shows where the time is spent:",
                "",
                *(f"- {each}" for each in told),
            ]
        )
        if told
        else ""
    )


def for_rs274(path: Path) -> Path:
    """Return a file with the same lines in RS-274: G01 with the first move, the feed per minute, no tool."""
    lines = [line for line in path.read_text().replace("G95F.003", "F6").splitlines() if line != "T1"]
    lines = [line.replace("G72", "G20") for line in lines]
    first = next(at for at, line in enumerate(lines) if line.startswith("X"))
    lines[first] = f"G1{lines[first]}"
    other = path.with_suffix(".ngc")
    other.write_text("\n".join([*lines, ""]))
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


def _proved(text: str, setup: InterpreterSetup, machine: Machine) -> None:
    """Read and prove a text."""
    prove(ProgramSource("speed", text), setup, machine)


def _warm() -> str:
    """Proofs in a process that has proved before, as the editor's."""
    machine = load_machine(None)
    setup = create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    rows, figures = [], {}
    for count, rounds in ((200, 50), (20_000, 7)):
        text, name = program(count), f"prove {count:,} blocks, read again"
        cost = _median_ms(partial(_proved, text, setup, machine), rounds)
        rows.append((name, cost, goal_of(name, "{:.0f}")))
        figures[name] = (float(cost),)
    text, name = feeds(20_000), "prove 20,000 blocks with F on each, read again"
    cost = _median_ms(partial(_proved, text, setup, machine), FEW)
    rows.append((name, cost, goal_of(name, "{:.0f}")))
    figures[name] = (float(cost),)
    return _table(WARM, ("proof", "CPU time, ms", "goal, ms"), rows, _reasons(figures))


def _removal() -> str:
    """Moves a second that are taken off the stock; shapely beside where it is installed."""
    todo = bench_removal.moves()
    works: dict[str, bench_removal.Work] = {
        "with all checks": bench_removal.checked,
        "without checks": bench_removal.alone,
    }
    below = ""
    try:
        works["shapely"] = bench_removal.by_shapely()
    except ImportError:
        below = "shapely was not installed, so there is no comparison."
    rows = [
        (name, f"{1000.0 * bench_removal.MOVES / float(_median_ms(partial(work, todo), FEW)):,.0f}")
        for name, work in works.items()
    ]
    above = (
        f"Each calculation removes the material of {bench_removal.MOVES} roughing moves. TurnDesk's model of "
        f"the part has a resolution of {bench_removal.STEP} mm."
    )
    return _table(STOCK, ("calculation", "moves per second"), rows, below, above)


def _chords() -> str:
    """Half a circle in chords of rounded words: planned time over the ideal one, by the tolerance stated."""
    ideal = math.pi * RADIUS / FEED + FEED / MotionLimits().max_plane_acceleration
    tolerances, count = (0.0, 0.0025, 0.0036, 0.005), 0.00127

    def ratios(grid: float) -> Iterator[str]:
        blocks = rounded_chords(round(math.pi * RADIUS / CHORD), FEED, grid)
        for each in tolerances:
            limits = MotionLimits(grain=max(count, each / math.sqrt(2.0)))
            yield f"{plan_motion(build_path(blocks, limits)).duration_s / ideal:.3f}"

    rows = [(f"coordinates rounded to {grid} mm", *ratios(grid)) for grid in (0.00127, 0.00254, 0.005)]
    head = ("program", *(f"corner_tolerance {each} mm" for each in tolerances))
    above = (
        f"The path is half a circle of radius {RADIUS:g} mm, programmed as chords of {CHORD} mm at "
        f"{FEED:g} mm/s. Each value is the planned time divided by the ideal time."
    )
    return _table(CHORDS, head, rows, above=above)


def _growth(title: str, result: Result) -> str:
    """Return the time and memory of proofs by the length of the program."""
    rows: list[Row] = []
    before: tuple[int, float] | None = None
    for lines, figures in ((int(name), figures) for name, figures in result["rows"].items()):
        seconds, peer = figures["prove, s"], figures.get("rs274, s")
        step = (
            "–"
            if before is None or lines < _SHOWS_GROWTH
            else f"{1e6 * (seconds - before[1]) / (lines - before[0]):.1f}"
        )
        other = ("–", "–") if peer is None else (f"{peer:.2f}", f"{seconds / peer:.2f}")
        rows.append((f"{lines:,}", f"{seconds:.2f}", step, f"{figures['memory, MiB']:.0f}", *other))
        before = lines, seconds
    head = ("lines", "CPU time, s", "µs per added line", "memory, MiB", "rs274, s", "× rs274")
    below = (
        "Each program is proved in its own process, without the part. The time per added line is the "
        "difference to the row above, divided by the added lines. In short programs, it is hidden by the "
        "start of the process. If the time grows linearly, the values do not increase."
    )
    return _table(title, head, rows, _filled(below))


def _jobs(title: str, result: Result) -> str:
    """Return the time and memory of long jobs with their goals."""
    rows = [
        (
            name,
            f"{seconds:.2f}",
            goal_of(name, "{:.1f}"),
            f"{seconds / result['bare, s']:.0f}",
            f"{memory:.0f}",
        )
        for name, (seconds, memory) in result["rows"].items()
    ]
    head = ("process", "CPU time, s", "goal, s", "× bare interpreter", "memory, MiB")
    return _table(title, head, rows, _reasons(result["rows"]))


def _frames(title: str, result: Result) -> str:
    """Return the times of frames, and of a feed hold until the axes are at rest."""
    median, most = result["a hold stands after, ms"]
    columns = ("frames", "over 33 ms", "longest by the clock, ms", "of processor time, ms")
    rows = [
        (_SHOWN.get(name, name), *(str(row[column]) for column in columns))
        for name, row in result["rows"].items()
    ]
    below = (
        f"The program has {result['blocks']:,} blocks. After a feed hold, the axes come to rest in {median} "
        f"ms (median) and in at most {most} ms. The goal is that no frame takes more than 33 ms."
    )
    return _table(
        title, ("action", *(_SHOWN.get(column, column) for column in columns)), rows, _filled(below)
    )


def _idle(title: str, result: Result) -> str:
    """Return the processor time while nothing happens."""
    rows = [
        (machine, _SHOWN.get(name, name), f"{share / 10.0:.1f}")
        for machine, shares in result["rows"].items()
        for name, share in shares.items()
    ]
    below = "The goal is at most 2 % of a core while the machine is idle."
    return _table(title, ("machine", "state of TurnDesk", "% of a core"), rows, below)


def _host(title: str, result: Result) -> str:
    """How late SYNC was, run by run."""
    below = (
        "Delays are in ms. On each core, a witness process with a higher priority than the driver host "
        'only waits. Its delay is the delay of the computer itself. The column "own" counts only the SYNCs '
        "at times when no witness was late. The last column gives the fault that ended the run. The goal is "
        "a delay of at most 0.1 ms at the 99th percentile, and no gap."
    )
    rows = [
        [re.sub(r"setpoints came (.* late): .*", lambda late: _LATE.format(late[1]), cell) for cell in row]
        for row in result["rows"]
    ]
    return _table(title, bench_driver_host.HEAD, rows, _filled(below))


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
