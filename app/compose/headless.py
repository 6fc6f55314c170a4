"""A run without a screen: the executor on the simulated lathe, on a clock that moves as fast as it can."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import TextIO

from app.cli.errors import CommandError
from app.compose.simulated import simulated
from app.desk.headless import HeadlessRun
from app.desk.home import home
from core.executor.executor import Executor
from core.executor.snapshot import Event
from core.machine.model import Machine
from core.ports import DriverError
from drivers.simulated import RealClock, StepClock


class EventLog:
    """The events of one run, a JSON object a line."""

    def __init__(self, path: Path, file: TextIO) -> None:
        self.path = path
        self._file = file

    @classmethod
    def new(cls, program: str) -> EventLog:
        """A log in the product's folder, named after the time and the program."""
        folder = home() / "logs"
        stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S%f")
        path = folder / f"{stamp}-{Path(program).stem}.jsonl"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            return cls(path, path.open("x", encoding="utf-8"))
        except OSError as error:
            raise CommandError(f"{path}: the event log cannot be written: {error.strerror}") from error

    def __enter__(self) -> EventLog:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def add(self, event: Event) -> None:
        """One more line."""
        line = {"t": round(event.t, 4), "kind": event.kind, "text": event.text, "line": event.line}
        self._file.write(json.dumps(line) + "\n")


def headless(
    machine: Machine,
    *,
    inputs: Mapping[str, bool],
    realtime: bool,
    log: EventLog,
    say: Callable[[str], None],
    progress: Callable[[float], None],
) -> HeadlessRun:
    """An executor on the simulated lathe with these inputs, and somebody to press its buttons.

    Raises CommandError for a machine that is not simulated and for an input it does not have.
    """
    if machine.backend != "sim":
        raise CommandError(f"{machine.source}: only simulated machines can be run yet, not {machine.backend}")
    clock = RealClock() if realtime else StepClock()
    simulation = simulated(machine, clock)
    try:
        for name, on in inputs.items():
            simulation.machine.set_input(name, on)
    except DriverError as error:
        raise CommandError(f"--inputs: {error}") from error
    executor = Executor(machine, simulation.ports, log.add)
    return HeadlessRun(executor, clock, say, progress)
