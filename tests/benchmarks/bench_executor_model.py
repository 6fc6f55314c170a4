"""The model of the executor for many steps: operator, faults and times in any order.

Run with ``python -m tests.benchmarks.bench_executor_model [STEPS] [SEED]``; it fails at the
first invariant that does not hold, and says how to get there. No time is judged.
"""

from __future__ import annotations

import logging
import sys
import time

from hypothesis import HealthCheck, Phase, seed, settings
from hypothesis.stateful import run_state_machine_as_test

from core.executor.snapshot import STATE_TRANSITIONS
from tests.executor.model import ExecutorModel
from tests.executor.model_machine import SEEN

STEPS = 100_000
_RUNS, _LONG = 40, 60  # examples of one search, steps of one example


def main(arguments: list[str]) -> int:
    """Search until so many steps were taken; print what was met."""
    logging.disable(logging.CRITICAL)  # every fault would be logged, as it has to be
    wanted, first = [*map(int, arguments), *(STEPS, 1)[len(arguments) :]][:2]
    began, turn = time.monotonic(), 0
    sys.stdout.write(
        "| search | steps | ticks | machine, s | took, s | parts at last |\n|---|---|---|---|---|---|\n"
    )
    while SEEN.steps < wanted:
        search = seed(first + turn)(ExecutorModel)
        run_state_machine_as_test(
            search,
            settings=settings(
                max_examples=_RUNS,
                stateful_step_count=_LONG,
                deadline=None,
                derandomize=False,
                database=None,
                phases=(Phase.generate, Phase.shrink),
                suppress_health_check=list(HealthCheck),
            ),
        )
        turn += 1
        sys.stdout.write(
            f"| {turn} | {SEEN.steps} | {SEEN.ticks} | {SEEN.seconds:.0f} | {time.monotonic() - began:.0f} "
            f"| {SEEN.parts} of {SEEN.runs} |\n"
        )
        sys.stdout.flush()
    _table()
    return 0


def _table() -> None:
    legal = sum(len(after) for after in STATE_TRANSITIONS.values())
    met = sum(new in STATE_TRANSITIONS[old] for old, new in SEEN.changes)
    lines = [
        "",
        f"states seen: {len(SEEN.states)} of {len(STATE_TRANSITIONS)}; changes of state seen: "
        f"{len(SEEN.changes)}, "
        f"{met} of the {legal} in the table",
        "states, ticks: " + ", ".join(f"{state.value} {n}" for state, n in SEEN.states.most_common()),
        "alarms: " + ", ".join(f"{code} {n}" for code, n in SEEN.alarms.most_common()),
        "steps: " + ", ".join(f"{rule} {n}" for rule, n in SEEN.rules.most_common()),
        "",
    ]
    sys.stdout.write("\n".join(lines))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
