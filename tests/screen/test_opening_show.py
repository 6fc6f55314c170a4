"""Show before the screen: it is closed first, the window remains, and a faulty show prevents no start."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from app.desk.command_errors import CommandError
from app.desk.desk import Desk
from app.desk.pages.attached_parts import ClosingSequence, ControlClosing
from app.screen.screen_startup import run_screen
from app.screen.window.main_window import MainWindow
from app.screen.window.window_frame import WindowFrame
from tests.screen.desks import SAMPLES, desk_on
from tests.screen.fake import FakeMachine


@dataclass
class ShortShow:
    """Show that ends at its first opportunity."""

    log: list[str]
    opens_desk: bool = True
    error: Exception | None = None
    presses_estop: bool = False
    windows: list[MainWindow] = field(default_factory=list)

    def build_model(self) -> Desk:
        if self.error is not None:
            raise self.error
        return make_desk("show", self.log)

    def begin(self, window: MainWindow, on_end: Callable[[], None]) -> None:
        self.log.append("begins")
        self.windows.append(window)
        if self.presses_estop:
            window.press_estop()
        QTimer.singleShot(0, window, on_end)

    def close(self) -> None:
        self.log.append("show over")


def make_desk(name: str, log: list[str]) -> Desk:
    control = ControlClosing(close_drivers=lambda: log.append(f"{name} closed"))
    return desk_on(FakeMachine(), closing=ClosingSequence(control))


def build_desk_that_closes_its_window(
    log: list[str], windows: list[MainWindow], look: Callable[[], None] = lambda: None
) -> Desk:
    def leave() -> None:
        shown = [each for each in QApplication.topLevelWidgets() if isinstance(each, MainWindow)]
        windows[:] = [each for each in shown if each.isVisible()]
        look()
        for window in windows:
            window.close()

    log.append("desk built")
    QTimer.singleShot(50, leave)
    return make_desk("desk", log)


def test_screen_opens_in_the_window_of_the_show_after_the_show_is_closed(qapp: QApplication) -> None:
    log, windows = list[str](), list[MainWindow]()
    show = ShortShow(log)
    status = run_screen(
        build_model=lambda: build_desk_that_closes_its_window(log, windows), opening_show=show
    )
    assert status == 0
    assert log == ["begins", "show closed", "show over", "desk built", "desk closed"]
    assert windows == show.windows


def test_window_closes_after_a_show_without_a_screen(qapp: QApplication) -> None:
    log = list[str]()
    assert run_screen(build_model=lambda: make_desk("desk", log), opening_show=ShortShow(log, False)) == 0
    assert log == ["begins", "show closed", "show over"]


def test_screen_opens_if_the_show_cannot_begin(qapp: QApplication, caplog: pytest.LogCaptureFixture) -> None:
    log = list[str]()
    show = ShortShow(log, error=OSError("no space left"))
    assert run_screen(build_model=lambda: build_desk_that_closes_its_window(log, []), opening_show=show) == 0
    assert log == ["show over", "desk built", "desk closed"]
    assert "no space left" in caplog.text


def run_faulty_show(error: Exception, monkeypatch: pytest.MonkeyPatch, *, opens_desk: bool) -> None:
    """Run a show that cannot begin, with the log as it is before the desk attaches its file."""
    monkeypatch.setattr(logging.getLogger(), "handlers", [])
    log = list[str]()
    run_screen(
        build_model=lambda: build_desk_that_closes_its_window(log, []),
        opening_show=ShortShow(log, opens_desk, error),
    )


@pytest.mark.parametrize(
    "error",
    [
        CommandError("[Errno 28] No space left on device: '.tour.x'", "cannot-write"),
        FileNotFoundError(2, "No such file or directory", "tour.nc"),
    ],
)
def test_expected_error_of_the_show_is_one_line_without_a_traceback(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], error: Exception
) -> None:
    run_faulty_show(error, monkeypatch, opens_desk=True)
    assert [
        line for line in capfd.readouterr().err.splitlines() if "the opening show" in line or "File" in line
    ] == [f"the opening show cannot begin: {error}"]


def test_error_of_a_show_without_a_screen_is_only_raised(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(CommandError, match="disk full"):
        run_faulty_show(CommandError("disk full", "cannot-write"), monkeypatch, opens_desk=False)
    assert "disk full" not in capfd.readouterr().err


def test_unexpected_error_of_the_show_is_logged_with_its_traceback(
    qapp: QApplication, caplog: pytest.LogCaptureFixture
) -> None:
    show = ShortShow([], error=KeyError("fault"))
    run_screen(build_model=lambda: build_desk_that_closes_its_window([], []), opening_show=show)
    assert "Traceback" in caplog.text


@pytest.mark.parametrize("is_accepted", [True, False])
def test_second_screen_opens_only_if_no_other_screen_accepts_the_program(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, is_accepted: bool
) -> None:
    log = list[str]()

    def hand_over(program_path: str) -> bool:
        log.append(f"hands over {program_path}")
        return is_accepted

    monkeypatch.setattr("app.screen.window.running_screen.hand_over_program", hand_over)
    program = str(SAMPLES / "pin.nc")
    status = run_screen(
        program_file=program,
        build_model=lambda: build_desk_that_closes_its_window(log, []),
        opening_show=ShortShow(log),
    )
    assert status == 0
    screen = [] if is_accepted else ["desk built", "desk closed"]
    assert log == ["begins", "show closed", "show over", f"hands over {program}", *screen]


@pytest.mark.parametrize("is_pressed", [True, False])
def test_emergency_stop_pressed_in_the_show_remains_pressed_on_the_screen(
    qapp: QApplication, is_pressed: bool
) -> None:
    log, shown = list[str](), list[bool]()
    show = ShortShow(log, presses_estop=is_pressed)

    def look() -> None:
        (window,) = (
            each
            for each in QApplication.topLevelWidgets()
            if isinstance(each, MainWindow) and each.isVisible()
        )
        assert window.frame is not None
        shown.append(window.frame.desk.station_controls.is_estop_pressed)

    run_screen(build_model=lambda: build_desk_that_closes_its_window(log, [], look), opening_show=show)
    assert shown == [is_pressed]


def test_show_without_a_screen_that_cannot_begin_is_reported(qapp: QApplication) -> None:
    log = list[str]()
    show = ShortShow(log, opens_desk=False, error=OSError("no space left"))
    with pytest.raises(OSError, match="no space left"):
        run_screen(build_model=lambda: make_desk("desk", log), opening_show=show)
    assert log == ["show over"]


def test_only_the_frame_of_the_screen_is_visible_after_the_show(qapp: QApplication) -> None:
    log, windows, frames = list[str](), list[MainWindow](), list[bool]()

    def count_frames() -> None:
        frames.extend(each.isVisible() for each in windows[0].findChildren(WindowFrame) if each.isVisible())

    show = ShortShow(log)
    run_screen(
        build_model=lambda: build_desk_that_closes_its_window(log, windows, count_frames), opening_show=show
    )
    assert frames == [True]
