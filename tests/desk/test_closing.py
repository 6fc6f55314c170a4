"""Closing: the machine first; no step that raises or hangs keeps another from its end."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from app.compose.control.live_control import LiveControl
from app.compose.screen_desk import build_desk
from app.desk.desk import Desk
from app.desk.pages.attached_parts import ClosingSequence, ControlClosing
from core.closing_steps import ClosingStep
from core.executor.commands import EnableDrives
from core.executor.snapshot import MachineState
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine

MACHINE = ("executor", "drivers")
STEPS = (*MACHINE, "loading", "levels", "Part", "recorder", "broker", "backup", "store", "log")
LONG = 60.0  # s that a test waits for what has to come


class Closings:
    """Notes which steps were carried out. One of them raises or hangs, and is not waited for."""

    def __init__(self, bad: str, how: str) -> None:
        self._bad, self._how = bad, how
        self._lock = threading.Lock()
        self._hangs = threading.Event()
        self.ran: list[str] = []
        self.release = threading.Event()

    def run(self, name: str) -> None:
        """Carry out a step."""
        with self._lock:
            self.ran.append(name)
        if name == self._bad and self._how == "raises":
            raise OSError("the network folder is away")
        if name == self._bad:
            self._hangs.set()
            self.release.wait()

    def wait(self, name: str, ended: threading.Event, _seconds: float) -> bool:
        """A step that hangs has used up its time; the others end."""
        if name == self._bad and self._how == "hangs":
            return not self._hangs.wait(LONG)
        return ended.wait(LONG)


class Part:
    """The model of a page."""

    def __init__(self, closed: Callable[[], None]) -> None:
        self._closed = closed

    def close(self) -> None:
        self._closed()


def desk_of(machine: FakeMachine, closings: Closings) -> Desk:
    """A desk whose every step of closing is noted."""
    step = partial(partial, closings.run)
    sequence = ClosingSequence(
        ControlClosing(
            (ClosingStep("executor", step("executor")),),
            step("drivers"),
            (ClosingStep("recorder", step("recorder")),),
        ),
        lambda: [ClosingStep(name, step(name)) for name in ("broker", "backup")],
        tuple(ClosingStep(name, step(name)) for name in ("store", "log")),
        closings.wait,
    )
    desk = desk_on(machine, closing=sequence)
    desk.program_loader = Part(step("loading"))  # type: ignore[misc, assignment]
    desk.user_access = Part(step("levels"))  # type: ignore[misc, assignment]
    desk.page_registry.attach_model(Part(step("Part")))
    return desk


@pytest.mark.parametrize("how", ["raises", "hangs"])
@pytest.mark.parametrize("bad", STEPS)
def test_every_closing_step_runs_even_if_another_fails(machine: FakeMachine, bad: str, how: str) -> None:
    closings = Closings(bad, how)
    desk = desk_of(machine, closings)
    desk.close()
    closings.release.set()
    assert tuple(closings.ran[:2]) == MACHINE
    assert sorted(closings.ran) == sorted(STEPS)
    assert tuple(closings.ran[-2:]) == ("store", "log")


@pytest.fixture
def machine() -> FakeMachine:
    return FakeMachine()


def test_hanging_program_load_does_not_prevent_switching_drives_off(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The drives are off while the worker still waits for its dead network folder."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    reads, release, off = threading.Event(), threading.Event(), threading.Event()
    let_go = LiveControl.close

    def shut(control: LiveControl) -> None:
        let_go(control)
        off.set()

    monkeypatch.setattr(LiveControl, "close", shut)
    desk = build_desk()

    def hang(_request: object) -> None:
        reads.set()
        release.wait()

    desk.post(EnableDrives())
    desk.program_loader.worker.request_work(hang, lambda _: None, lambda _: None)
    assert reads.wait(LONG)
    closing = threading.Thread(target=desk.close, daemon=True)
    closing.start()
    safe = off.wait(10.0)
    state = desk.read_snapshot().state
    release.set()
    closing.join(LONG)
    assert safe
    assert state is MachineState.DISABLED
    assert not closing.is_alive()
