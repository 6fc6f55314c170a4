"""The whole suite: the same examples at every run, so that a failure is a change and not a throw of dice.

``HYPOTHESIS_PROFILE=search pytest …`` looks for new ones. A run of the whole suite fails when a test that
``docs/safety.md`` or ``docs/late.md`` names did not run: a rule whose test was skipped is not shown.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Generator
from pathlib import Path

import pytest
from hypothesis import settings

from tests import late_computer
from tests.named import all_named, not_run
from tests.steady_examples import same_examples_whatever_is_loaded
from tests.store_template import use_template
from tests.waiting_apart import in_order, shuffled

pytest_plugins = ["tests.forked_workers"]
settings.register_profile("steady", derandomize=True, deadline=None)
settings.register_profile("search", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))
if "HYPOTHESIS_PROFILE" not in os.environ:
    same_examples_whatever_is_loaded()


MOST_LATE = 3  # named tests without a verdict in one run; a run at a load of 16 had one


class SafetyRan:
    """Compare the tests that passed with those that the two documents name.

    A test without a verdict, because the computer was late, is listed. Few of them do not fail the run.
    """

    def __init__(self) -> None:
        self._passed: set[str] = set()
        self._late: set[str] = set()
        self._missing: list[str] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Collect the reports, also those of the workers."""
        name = report.nodeid.partition("[")[0]
        if report.when == "call" and report.passed:
            self._passed.add(name)
        elif report.skipped and late_computer.NO_VERDICT in str(report.longrepr):
            self._late.add(name)

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session, exitstatus: int) -> None:
        """Fail a run that would have passed if a named test did not run, or if too many have no verdict."""
        if exitstatus == pytest.ExitCode.OK:
            text = all_named()
            without = set(not_run(text, self._passed))
            never = set(not_run(text, self._passed | self._late))
            self._late = without - never
            self._missing = sorted(without if len(self._late) > MOST_LATE else never)
        if self._missing:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """List both kinds."""
        for name in self._missing:
            terminalreporter.write_line(f"NOT RUN, but named in docs/safety.md or docs/late.md: {name}")
        for name in sorted(self._late - set(self._missing)):
            terminalreporter.write_line(f"NO VERDICT, the computer was late: {name}")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What waits, for a machine or another process, in an order in which it does not wait for itself.

    ``TEST_ORDER=SEED`` shuffles files, and the tests of each file, to show that none needs another.
    """
    seed = os.environ.get("TEST_ORDER")
    items[:] = in_order(items if seed is None else shuffled(items, int(seed)))


def pytest_collection() -> None:
    """Collect without garbage collection, which takes a quarter of the time and finds nothing."""
    gc.disable()


def pytest_collection_finish() -> None:
    """What was collected stays to the end: half a million objects that are not garbage.

    The product excludes its objects from collection too, once it has loaded a program and its pages. Here
    that would keep the window of every test, and each later test would take longer.
    """
    _keep_for_good()
    gc.enable()
    setattr(gc, "freeze", lambda: None)  # noqa: B010 - the product's function, for this process alone


_freeze = gc.freeze
_file: list[Path] = []  # of the test that runs


def _keep_for_good() -> None:
    """Exclude what lives now from collection: a test of the screen looks through all the rest at its end."""
    gc.collect()
    _freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Prepare a test without a fixture, which would take a fifth of the time of an empty test.

    What the machine of an earlier test reported is forgotten, a store begins as a copy, and the caches that
    earlier files of tests have left are kept for good.
    """
    late_computer.forget()
    use_template(item)
    if _file != [item.path]:
        _file[:] = [item.path]
        _keep_for_good()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Skip a failed test of real processes if the computer was late."""
    report = yield
    late_computer.without_verdict(item, report)
    return report


def pytest_configure(config: pytest.Config) -> None:
    """For whole runs alone, and where the reports of all workers come together."""
    parts = ("keyword", "markexpr", "deselect", "lf", "collectonly", "maxfail")
    whole = config.args_source is pytest.Config.ArgsSource.TESTPATHS and not any(
        config.getoption(part, default=None) for part in parts
    )
    if whole and not hasattr(config, "workerinput"):
        config.pluginmanager.register(SafetyRan(), "safety-ran")
