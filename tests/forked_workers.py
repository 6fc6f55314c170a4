"""Worker processes of a test run, forked when the tests have been collected: ``pytest --forked-workers 5``.

A worker of pytest-xdist collects all tests for itself, which takes as long as a thousand tests. A forked one
has them, and shares the memory of what was imported. It needs ``os.fork``: elsewhere, ``pytest -n``.
"""

from __future__ import annotations

import multiprocessing
import os
import warnings
from collections import deque
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from tests.waiting_apart import KINDER, URGENT, PortionQueue, waits_first

_KNOWN = 2  # tests that a worker has to know: its fixtures end when the next test does not need them


class Outcome(NamedTuple):
    """What a worker sends when a test has ended."""

    reports: list[dict[str, Any]]
    warnings: list[tuple[str, str, str, int]]  # the text, when it was given, file and line


@dataclass
class Worker:
    """A worker, as the process that forked it has it."""

    number: int
    process: BaseProcess
    line: Connection
    given: deque[int] = field(default_factory=deque)  # the tests that have not ended; it runs the first
    has_all: bool = False

    @property
    def is_done(self) -> bool:
        """Whether it has run everything."""
        return self.has_all and not self.given

    def supply(self, queue: PortionQueue) -> None:
        """Give it the next portion if it has nothing behind the test that runs; an empty one is the last."""
        while len(self.given) < _KNOWN and not self.has_all:
            portion = queue.take(waiting=waits_first(self.number))
            with suppress(BrokenPipeError):  # it died: the next message from it is its end
                self.line.send(portion)
            self.given += portion
            self.has_all = not portion


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that this module reads."""
    text = "run the tests in N processes that are forked after the collection"
    parser.addoption("--forked-workers", type=_number_of_workers, metavar="N", help=text)


def _number_of_workers(text: str) -> int:
    number = int(text)
    if number < 1:
        raise ValueError(f"{number} workers cannot run a test")
    return number


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> bool | None:
    """Run the collected tests in workers, if workers were asked for."""
    options = session.config.option
    failed = session.testsfailed and not options.continue_on_collection_errors
    if options.forked_workers is None or options.collectonly or failed:
        return None
    queue = PortionQueue([item.nodeid for item in session.items], options.forked_workers)
    workers: list[Worker] = []
    try:
        for number in range(options.forked_workers):
            workers.append(_fork(session, number, workers))
        _run(session, workers, queue)
    finally:
        for worker in workers:
            worker.line.close()
            if not worker.is_done:
                worker.process.terminate()
            worker.process.join()
    return True


def _fork(session: pytest.Session, number: int, earlier: list[Worker]) -> Worker:
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()
    base = getattr(session.config, "_tmp_path_factory").getbasetemp()  # noqa: B009 - pytest has no public way
    others = [ours, *(worker.line for worker in earlier)]
    process = context.Process(target=_work, args=(session, number, theirs, others, base / f"worker{number}"))
    process.start()
    theirs.close()
    return Worker(number, process, ours)


def _run(session: pytest.Session, workers: Iterable[Worker], queue: PortionQueue) -> None:
    """Report what the workers send, until each has ended. Raises ``Session.Failed`` if one dies."""
    running = {worker.line: worker for worker in workers}
    for worker in running.values():
        worker.supply(queue)
    while running:
        for line in wait(list(running)):
            worker = running[line]  # type: ignore[index]
            try:
                outcome: Outcome = worker.line.recv()
            except (EOFError, ConnectionResetError):
                del running[worker.line]
                _check_end(session, worker)
            else:
                _report(session, session.items[worker.given.popleft()], outcome)
                worker.supply(queue)


def _report(session: pytest.Session, item: pytest.Item, outcome: Outcome) -> None:
    """Tell pytest of a test as if it had run in this process. Raises what ends the run early."""
    hook, config = session.config.hook, session.config
    hook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for data in outcome.reports:
        report = hook.pytest_report_from_serializable(config=config, data=data)
        hook.pytest_runtest_logreport(report=report)
    hook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    for text, when, file, line in outcome.warnings:
        message = warnings.WarningMessage(UserWarning(text), UserWarning, file, line)
        told = {"warning_message": message, "when": when, "nodeid": item.nodeid, "location": None}
        hook.pytest_warning_recorded.call_historic(kwargs=told)
    if session.shouldfail:
        raise session.Failed(session.shouldfail)
    if session.shouldstop:
        raise session.Interrupted(session.shouldstop)


def _check_end(session: pytest.Session, worker: Worker) -> None:
    """End the run if a worker has died: the tests that it had are lost."""
    if not worker.is_done:
        worker.process.join()
        item = session.items[worker.given[0]]
        text = f"worker {worker.number} died with exit status {worker.process.exitcode}"
        report = pytest.TestReport(item.nodeid, item.location, {}, "failed", text, "call")
        session.config.hook.pytest_runtest_logreport(report=report)
        raise session.Failed(f"{text} in {item.nodeid}")


# --- in the worker -------------------------------------------------------------------------------------


class _Records:
    """What a worker has to send of the test that runs."""

    def __init__(self, config: pytest.Config) -> None:
        self._config, self._outcome = config, Outcome([], [])

    def take(self) -> Outcome:
        """Return it, and begin again."""
        taken, self._outcome = self._outcome, Outcome([], [])
        return taken

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep a report in the form in which it can be sent."""
        hook = self._config.hook
        data = hook.pytest_report_to_serializable(config=self._config, report=report)
        self._outcome.reports.append(data)

    def pytest_warning_recorded(self, warning_message: warnings.WarningMessage, when: str) -> None:
        """Keep the text of a warning."""
        text = f"{warning_message.category.__name__}: {warning_message.message}"
        self._outcome.warnings.append((text, when, warning_message.filename, warning_message.lineno))


def _work(
    session: pytest.Session, number: int, line: Connection, others: list[Connection], folder: Path
) -> None:
    """Run the tests that come by ``line``, in a process of their own."""
    for other in others:
        other.close()
    with suppress(PermissionError):  # only root may claim more of a core than others
        os.nice(-URGENT if waits_first(number) else KINDER)
    records = _Records(session.config)
    _make_own(session.config, folder)
    session.config.pluginmanager.register(records)
    records.take()  # warnings of the collection
    given: deque[int] = deque()
    has_all = False
    while True:
        while len(given) < _KNOWN and not has_all:
            portion: list[int] = line.recv()
            given += portion
            has_all = not portion
        if not given:
            return
        item = session.items[given.popleft()]
        following = session.items[given[0]] if given else None
        session.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        line.send(records.take())


def _make_own(config: pytest.Config, folder: Path) -> None:
    """Replace what a worker must not share: temporary folder and captured output; it shows no results."""
    folder.mkdir()
    setattr(getattr(config, "_tmp_path_factory"), "_basetemp", folder)  # noqa: B009, B010
    config.pluginmanager.unregister(name="terminalreporter")
    capture: Any = config.pluginmanager.getplugin("capturemanager")
    capture.stop_global_capturing()
    capture.start_global_capturing()
    capture.suspend_global_capture()
