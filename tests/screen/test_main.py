"""The screen as a program: how it opens, what it says when it cannot, how it ends."""

from __future__ import annotations

import os
import signal
from dataclasses import replace

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from pytestqt.exceptions import capture_exceptions

from app.desk.desk import Desk
from app.desk.pages.attached_parts import ClosingSequence, ControlClosing
from app.screen.screen_startup import run_screen, warn_about_delayed_stop_keys
from app.screen.window.main_window import MainWindow
from app.screen.window.window_frame import WindowFrame
from core.executor.snapshot import MachineState
from tests.screen.desks import SAMPLES, desk_on
from tests.screen.fake import FakeMachine
from tests.texts import shows, text


@pytest.mark.parametrize("theme", ["system", "dark", "light", "contrast"])
def test_failed_model_build_ends_screen_with_reason(theme: str) -> None:
    def broken() -> None:
        raise ValueError("lathe.toml: no axis X")

    with pytest.raises(ValueError, match="no axis X"):
        run_screen(theme=theme, build_model=broken)  # type: ignore[arg-type]


def test_the_screen_opens_loads_and_closes(machine: FakeMachine) -> None:
    closed = list[bool]()
    control = ControlClosing(close_drivers=lambda: closed.append(True))
    desk = desk_on(machine, closing=ClosingSequence(control))

    def leave() -> None:
        if desk.program_loader.loaded_program.picture is None:
            QTimer.singleShot(5, leave)
            return
        (window,) = (w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow) and w.isVisible())
        window.close()

    QTimer.singleShot(0, leave)
    assert run_screen(program_file=str(SAMPLES / "pin.nc"), build_model=lambda: desk) == 0
    assert desk.program_loader.loaded_program.name == "pin.nc"
    assert closed == [True]


def test_computer_shutdown_closes_screen_in_feed_hold(machine: FakeMachine) -> None:
    closed = list[MachineState]()
    control = ControlClosing(close_drivers=lambda: closed.append(machine.now.state))
    desk = desk_on(machine, closing=ClosingSequence(control))

    def strike() -> None:
        if desk.program_loader.loaded_program.picture is None:
            QTimer.singleShot(5, strike)
            return
        machine.now = replace(machine.now, state=MachineState.HOLD)
        os.kill(os.getpid(), signal.SIGTERM)

    QTimer.singleShot(0, strike)
    assert run_screen(program_file=str(SAMPLES / "pin.nc"), build_model=lambda: desk) == 0
    assert closed == [MachineState.HOLD]


@pytest.mark.parametrize(
    ("platform", "is_real", "is_warned"),
    [("wayland", True, True), ("wayland", False, False), ("xcb", True, False), ("offscreen", True, False)],
)
def test_operator_of_real_machine_is_warned_of_delayed_stop_keys_on_wayland(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch, platform: str, *, is_real: bool, is_warned: bool
) -> None:
    desk = desk_on(machine)
    if is_real:
        desk.desk_control.station_panel = None
    monkeypatch.setattr(QApplication, "platformName", lambda: platform)
    desk.clear_prompt_line()
    warn_about_delayed_stop_keys(desk)
    assert shows(desk.prompt_notice, "screen.stop-keys-wait-on-wayland") is is_warned
    desk.close()


def test_warning_about_stop_keys_replaces_no_other_message(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk = desk_on(machine)
    desk.desk_control.station_panel = None
    monkeypatch.setattr(QApplication, "platformName", lambda: "wayland")
    desk.say("THE MACHINE FILE HAS CHANGED")
    warn_about_delayed_stop_keys(desk)
    assert desk.prompt_notice == "THE MACHINE FILE HAS CHANGED"
    desk.close()


def test_missing_program_is_reported(machine: FakeMachine) -> None:
    desk = desk_on(machine)
    QTimer.singleShot(50, lambda: [w.close() for w in QApplication.topLevelWidgets()])
    assert run_screen(program_file="nowhere.nc", build_model=lambda: desk) == 0
    assert desk.prompt_notice == text("screen.file-not-found", name="nowhere.nc")


def test_screen_error_is_reported_and_screen_continues(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    desk = desk_on(machine)

    def broken(_desk: Desk) -> None:
        raise KeyError("a figure that is not there")

    monkeypatch.setattr(WindowFrame, "toggle_alarm_log", broken)

    def press() -> None:
        (window,) = (w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow) and w.isVisible())
        QTimer.singleShot(20, window.close)
        window.press_key("F7")

    QTimer.singleShot(50, press)
    with capture_exceptions() as caught:
        assert run_screen(build_model=lambda: desk) == 0
    assert caught == []
    assert shows(desk.prompt_notice, "screen.screen-mistake")
    assert "a figure that is not there" in caplog.text
