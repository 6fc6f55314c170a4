"""The window on a grblHAL controller over TCP, in real time: start, hold, reset, cable out."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

import resources
from app.compose.screen_desk import build_desk
from app.desk.desk import Desk
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.main_window import MainWindow
from core.executor.snapshot import MachineState
from drivers.simulators.grblhal_connections import TcpConnection, run_simulator
from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.wakeups import RealClock
from tests.screen.hands import Key
from tests.screen.yes import yes
from tests.texts import text as wording

LIMIT = 60_000  # ms of a loaded computer
PROGRAM = "G90G94\nM03S600\nM08\nG01X.4Z-.4F30\nX0.Z0.\nM30\n"


class Controller:
    """The simulator in a thread; ``pull`` takes the cable out."""

    def __init__(self) -> None:
        self.end = TcpConnection("127.0.0.1", 0)
        self._going = threading.Event()
        self._going.set()
        self._thread = threading.Thread(target=self._serve, name="controller")
        self._thread.start()

    def _serve(self) -> None:
        run_simulator(self.end, GrblFirmware(RealClock()), self._going.is_set)

    def pull(self) -> None:
        self._going.clear()
        self._thread.join(LIMIT / 1000.0)


@pytest.fixture
def controller() -> Iterator[Controller]:
    made = Controller()
    yield made
    made.pull()


CHANGES = (("two_hand_start = true", "two_hand_start = false"),)


@pytest.fixture
def desk(
    controller: Controller, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qapp: object
) -> Iterator[Desk]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    text = resources.read_machine_file("gt75-grblhal.toml")
    for old, new in (("/dev/ttyACM0", controller.end.device_name), *CHANGES):
        assert old in text, old
        text = text.replace(old, new, 1)
    (tmp_path / "grbl.toml").write_text(text)
    (tmp_path / "part.nc").write_text(PROGRAM)
    made = build_desk(str(tmp_path / "grbl.toml"))
    made.program_choice.load_by_name(str(tmp_path / "part.nc"))
    yield made
    made.close()


@pytest.fixture
def window(desk: Desk) -> Iterator[MainWindow]:
    window = MainWindow(ScreenTheme(DARK_PALETTE))
    window.resize(1024, 600)
    window.show_model(desk)
    window.show()
    yield window
    window.close_silently()


def test_controller_runs_part_hold_reset_and_detects_lost_cable(
    window: MainWindow, desk: Desk, controller: Controller, qtbot: QtBot
) -> None:
    frame = window.frame
    assert frame is not None

    def sees(state: MachineState) -> None:
        def so() -> None:
            assert frame is not None
            assert frame.title_line.state_text.startswith(state.value), (
                frame.prompt_line.main_text,
                desk.read_snapshot().alarms,
            )

        qtbot.waitUntil(so, timeout=LIMIT)

    def start() -> None:
        qtbot.waitUntil(
            lambda: frame.prompt_line.main_text.startswith(wording("screen.to-start")), timeout=LIMIT
        )
        QTest.keyClick(window, Key.Key_F12)

    sees(MachineState.DISABLED)
    QTest.keyClick(window, Key.Key_D)
    start()
    qtbot.waitUntil(lambda: desk.read_snapshot().actual[0] > 1.0, timeout=LIMIT)
    QTest.keyClick(window, Key.Key_H)
    sees(MachineState.HOLD)
    held = desk.read_snapshot().actual
    assert 1.0 < held[0] < 10.16
    QTest.keyClick(window, Key.Key_F12)
    qtbot.waitUntil(lambda: desk.read_snapshot().parts == 1, timeout=LIMIT)
    sees(MachineState.IDLE)
    assert desk.read_snapshot().actual[:2] == pytest.approx((0.0, 0.0), abs=0.01)
    start()
    qtbot.waitUntil(lambda: desk.read_snapshot().actual[0] > 1.0, timeout=LIMIT)
    QTest.keyClick(window, Key.Key_H)
    sees(MachineState.HOLD)
    QTest.keyClick(window, Key.Key_R)
    yes(window)
    sees(MachineState.IDLE)
    controller.pull()
    sees(MachineState.FAULT)
    assert "connection" in str(desk.read_snapshot().alarms[-1]).lower(), desk.read_snapshot().alarms
