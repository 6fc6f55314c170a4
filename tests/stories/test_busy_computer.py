"""A short shift beside two busy processes; ``tests/benchmarks/bench_busy.py`` is the long one."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.stories.conftest import Story
from tests.stories.test_stop_keys import cutting

pytestmark = pytest.mark.real_time
PRESSES = 6


@pytest.fixture
def two_busy_processes() -> Iterator[None]:
    """Programs of other people that never wait."""
    running = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    yield
    for each in running:
        each.kill()
        each.wait()


@pytest.mark.usefixtures("two_busy_processes")
def test_busy_computer_loses_no_press_and_executes_each_hold(story: Story) -> None:
    operator = cutting(story)
    switched = len(operator.events("switch"))
    operator.once = True
    for _ in range(PRESSES):
        operator.key("o")
        operator.during(0.1)
    for _ in range(2):
        operator.key("Pause")
        operator.reaches("FEED HOLD")
        operator.cycle_start()
        operator.reaches("RUNNING", "WAITING")
    operator.until(lambda: len(operator.events("switch")) >= switched + PRESSES, "every press")
    assert len(operator.events("switch")) == switched + PRESSES
    assert len(operator.events("stop")) == 2
    assert operator.events("alarm", "estop") == []
