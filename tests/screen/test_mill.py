"""The screen on the mill with an A-C table: a tilted program is chosen, run and edited by keys."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.automatic.automatic_view import AutomaticPage
from app.compose.desk_assembly import create_desk_and_executor
from app.compose.program_proving import get_samples_folder
from app.compose.stored_offsets import read_offsets_file
from app.editor.editor_view import EditorPage
from app.jog.jog_view import JogPage
from app.offsets.cell_table_view import MillToolsPage
from app.screen import page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.main_window import MainWindow
from app.searchto.searchto_view import RestartPage
from core.executor.snapshot import MachineState, Snapshot
from core.store.store import Store
from drivers.wakeups import ManualClock
from tests.offset_store import use_store
from tests.screen.hands import Key
from tests.screen.yes import yes
from tests.texts import shows
from tests.texts import text as wording

TICK = 0.01
LONG = 200.0  # s of machine time


class Mill:
    """The desk on the simulated mill, on a clock that the test moves, and the window in front of it."""

    def __init__(self, folder: Path, machine: str = "ac-table-mill") -> None:
        self._clock = ManualClock()
        offsets = get_samples_folder() / "offsets.toml"
        self.desk, self._executor = create_desk_and_executor(
            machine, lambda: read_offsets_file(offsets), self._clock
        )
        self._store = Store.open(folder)
        for number, tool in read_offsets_file(offsets).tool_offsets.items():
            self._store.offsets.tool_offsets.change_row(
                number, "measured", {"x": tool.x, "z": tool.z, "nose_radius": tool.nose_radius}
            )
        use_store(self.desk, self._store)
        self.desk.station_controls.clock = self._clock.now
        self.window = MainWindow(ScreenTheme(DARK_PALETTE))
        self.window.resize(1024, 600)
        self.window.show_model(self.desk)
        self.window.show()

    def close(self) -> None:
        self.window.close_silently()
        self.desk.close()
        self._store.close()

    def key(self, key: Key) -> None:
        QTest.keyClick(QApplication.focusWidget() or self.window, key)

    def type(self, text: str) -> None:
        QTest.keyClicks(QApplication.focusWidget() or self.window, text)

    def goes_on(self, until: Callable[[Snapshot], bool]) -> Snapshot:
        end = self._clock.now() + LONG
        while not until(self.desk.read_snapshot()):
            assert self._clock.now() < end, self.desk.read_snapshot()
            self._executor.run_tick()
            self._clock.sleep_until(self._clock.now() + TICK)
        self.window.refresh()
        return self.desk.read_snapshot()

    def held(self, key: Key, until: Callable[[Snapshot], bool]) -> Snapshot:
        """Hold a key while the machine goes on and the screen looks at it, then let it go."""
        QTest.keyPress(QApplication.focusWidget() or self.window, key)
        end = self._clock.now() + LONG
        while not until(self.desk.read_snapshot()):
            assert self._clock.now() < end, self.desk.read_snapshot()
            self._executor.run_tick()
            self.window.refresh()
            self._clock.sleep_until(self._clock.now() + TICK)
        QTest.keyRelease(QApplication.focusWidget() or self.window, key)
        return self.goes_on(lambda s: s.state is MachineState.IDLE)

    def choose(self, name: str) -> None:
        self.key(Key.Key_F2)
        self.type(name)
        self.key(Key.Key_Return)
        assert not self.desk.program_loader.wait_until_loaded(60.0).blocking_errors
        self.goes_on(lambda s: s.state is MachineState.DISABLED)
        self.key(Key.Key_D)
        self.goes_on(lambda s: s.state is MachineState.IDLE)

    def start(self) -> None:
        QTest.keyPress(self.window, Key.Key_F11)
        QTest.keyPress(self.window, Key.Key_F12)
        self.goes_on(lambda s: s.state is not MachineState.IDLE)
        QTest.keyRelease(self.window, Key.Key_F11)
        QTest.keyRelease(self.window, Key.Key_F12)

    @property
    def page(self) -> AutomaticPage:
        assert self.window.frame is not None
        return self.window.frame.automatic_page


@pytest.fixture
def mill_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))


@pytest.fixture
def mill(qapp: QApplication, tmp_path: Path, mill_home: None) -> Iterator[Mill]:
    made = Mill(tmp_path / "store")
    yield made
    made.close()


def line_of(text: str) -> int:
    """The first line of the sample that holds this."""
    lines = (get_samples_folder() / "roof.h").read_text().splitlines()
    return next(number for number, line in enumerate(lines, start=1) if text in line)


def test_tilted_program_runs_from_list_to_end(mill: Mill) -> None:
    mill.choose("roof")
    page = mill.page
    assert page.plane_view.isVisible()
    mill.start()
    cut = line_of("L X+90 F900")
    mill.goes_on(lambda s: s.line == cut and s.modal.tool == 20)
    first = line_of("PLANE AXIAL")
    assert page.plane_view.words.startswith(
        f"{wording('screen.tilted-plane', line=first)}:  A+30.000  C+0.000"
    )
    picture = page.plane_view.grab().toImage()
    mill.goes_on(lambda s: s.line == cut and s.actual[4] > 170.0)
    assert page.plane_view.grab().toImage() != picture
    end = mill.goes_on(lambda s: s.state is MachineState.IDLE)
    assert not end.alarms
    assert end.actual[3] == pytest.approx(0.0, abs=0.01)


def test_program_resumes_after_hold_during_swivel(mill: Mill) -> None:
    mill.choose("roof")
    mill.start()
    swivel = line_of("PLANE AXIAL A+30 C+180")
    mill.goes_on(lambda s: s.line == swivel and s.actual[4] > 20.0)
    mill.key(Key.Key_H)
    held = mill.goes_on(lambda s: s.state is MachineState.HOLD).actual
    assert 20.0 < held[4] < 175.0
    later = mill.desk.read_snapshot().t + 1.0
    mill.goes_on(lambda s: s.t > later)
    assert mill.desk.read_snapshot().actual == pytest.approx(held, abs=0.01)
    QTest.keyPress(mill.window, Key.Key_F11)
    QTest.keyPress(mill.window, Key.Key_F12)
    mill.goes_on(lambda s: s.state is MachineState.RUN)
    end = mill.goes_on(lambda s: s.state is MachineState.IDLE)
    assert not end.alarms


def test_canceled_program_leaves_no_tilted_plane_active(mill: Mill) -> None:
    mill.choose("roof")
    mill.start()
    cut = line_of("L X+90 F900")
    mill.goes_on(lambda s: s.line == cut and s.actual[0] > 260.0)
    mill.key(Key.Key_H)
    held = mill.goes_on(lambda s: s.state is MachineState.HOLD)
    assert held.swivel is not None
    assert held.swivel.system.is_tilted  # it can go on
    mill.key(Key.Key_R)
    yes(mill.window)
    end = mill.goes_on(lambda s: s.state is MachineState.IDLE)
    assert end.swivel is not None
    assert end.swivel.system.is_workpiece_system
    x, y, z, *_ = end.actual
    assert end.swivel.system.transform.convert_to_frame_point((x, y, z)) == pytest.approx(
        (x - 230.0, y - 210.0, z + 350.0 - 76.2)
    )


def test_view_keys_control_3d_camera(mill: Mill) -> None:
    mill.choose("roof")
    space = mill.page.plane_view
    assert space.camera is not None
    mill.key(Key.Key_V)
    assert space.camera.view_direction.name == "FRONT"
    near = space.camera.zoom_factor
    mill.key(Key.Key_Z)
    assert space.camera.zoom_factor > near
    mill.key(Key.Key_F5)
    assert space.camera.zoom_factor == near


def test_the_editor_shows_the_plane_of_the_cursors_line(mill: Mill, qtbot: QtBot) -> None:
    mill.choose("roof")
    mill.key(Key.Key_F3)
    assert mill.window.frame is not None
    page = mill.window.frame.current_page
    assert isinstance(page, EditorPage)
    qtbot.waitUntil(lambda: page.text_field.blockCount() > 40 and page.plane_view.isVisible(), timeout=60_000)
    plane = line_of("PLANE POINTS")
    for _ in range(plane - page.text_field.cursor_line):
        mill.key(Key.Key_Down)
    assert page.text_field.cursor_line == plane
    wanted = f"{wording('screen.tilted-plane', line=plane)}:  A+59.999  C+90.000"
    qtbot.waitUntil(lambda: page.plane_view.words.startswith(wanted), timeout=60_000)


def test_searchto_shows_table_and_plane_at_line(mill: Mill, qtbot: QtBot) -> None:
    mill.choose("roof")
    mill.key(Key.Key_F6)
    assert mill.window.frame is not None
    page = mill.window.frame.current_page
    assert isinstance(page, RestartPage)
    mill.window.refresh()
    assert page.plane_view.isVisible()
    line = line_of("PLANE AXIAL A+30 C+180") + 1
    mill.type(str(line))
    mill.key(Key.Key_Return)

    def found() -> bool:
        mill.window.refresh()
        return page.model.restart_plan is not None

    qtbot.waitUntil(found, timeout=60_000)
    assert page.plane_view.words.startswith(
        f"{wording('screen.tilted-plane', line=line - 1)}:  A+30.000  C+180.000"
    )
    shown = page.plane_view.scene_instant
    assert shown is not None
    assert (shown.axis_positions["A"], shown.axis_positions["C"]) == pytest.approx(
        (30.0, 180.0)
    )  # turned, where the line begins
    assert page.model.restart_plan is not None
    assert shown.active_block_number == page.model.restart_plan.restart_point.checkpoint.blocks


@pytest.mark.parametrize(
    ("key", "axis", "sign"),
    [
        (Key.Key_Right, 0, 1),
        (Key.Key_Up, 1, 1),
        (Key.Key_Down, 1, -1),
        (Key.Key_PageDown, 2, -1),
        (Key.Key_Insert, 3, 1),
        (Key.Key_Delete, 3, -1),
        (Key.Key_BracketRight, 4, 1),
    ],
)
def test_every_axis_jogs_while_its_key_is_down(mill: Mill, key: Key, axis: int, sign: int) -> None:
    mill.goes_on(lambda s: s.state is MachineState.DISABLED)
    mill.key(Key.Key_D)
    mill.goes_on(lambda s: s.state is MachineState.IDLE)
    mill.key(Key.Key_F1)
    mill.key(Key.Key_F5)
    before = mill.desk.read_snapshot().actual
    after = mill.held(key, lambda s: abs(s.actual[axis] - before[axis]) > 0.5).actual
    assert sign * (after[axis] - before[axis]) > 0.5
    assert all(abs(after[other] - before[other]) < 0.01 for other in range(5) if other != axis)


def test_mill_jog_page_offers_no_tool_setting(mill: Mill) -> None:
    """Tools and presets have pages of their own: no wear Ø, no touch X, no master here."""
    mill.key(Key.Key_F1)
    mill.key(Key.Key_F5)
    mill.window.refresh()
    frame = mill.window.frame
    assert frame is not None
    page = frame.current_page
    assert isinstance(page, JogPage)
    assert page.make_key_labels() == (
        *("MENU", "STEP", "SPEED", "", "3D-ROT", "", "ALARMS", "TOOLS", "PRESETS", "READOUT"),
    )
    assert (page.mill_panel.isVisible(), page.tool_panel.isVisible(), page.entry_panel.isVisible()) == (
        True,
        False,
        False,
    )
    for key in (Key.Key_T, Key.Key_X, Key.Key_W, Key.Key_M, Key.Key_F6):
        mill.key(key)
        assert page.model.tool_setting.question_name == ""
    mill.key(Key.Key_F5)
    mill.window.refresh()
    assert shows(frame.prompt_line.main_text, "screen.nothing-tilted")
    mill.key(Key.Key_F8)
    assert frame.title_line.page_title == "TOOL TABLE"


def test_tilted_tool_retracts_along_its_own_axis(qapp: QApplication, tmp_path: Path, mill_home: None) -> None:
    """The fork head: A is jogged aside, 3D-ROT on, Z' moves Y and Z as -tan A; turning A again ends it."""
    mill = Mill(tmp_path / "store", "fork-head-mill")
    try:
        mill.goes_on(lambda s: s.state is MachineState.DISABLED)
        mill.key(Key.Key_D)
        mill.goes_on(lambda s: s.state is MachineState.IDLE)
        mill.key(Key.Key_F1)
        mill.key(Key.Key_F5)
        frame = mill.window.frame
        assert frame is not None
        page = frame.current_page
        assert isinstance(page, JogPage)
        axes = mill.desk.read_snapshot().axes
        a, y, z = (axes.index(name) for name in "AYZ")
        key = next(
            way.key_name for way in page.model.directions if (way.axis_name, way.direction_sign) == ("A", 1)
        )
        mill.held(getattr(Key, f"Key_{key}"), lambda s: s.actual[a] > 20.0)
        lean = math.radians(mill.desk.read_snapshot().actual[a])
        mill.key(Key.Key_F5)
        mill.window.refresh()
        assert page.model.tilted_jog.is_on
        before = mill.desk.read_snapshot().actual
        after = mill.held(Key.Key_PageDown, lambda s: s.actual[z] - before[z] < -1.0).actual
        assert after[y] - before[y] == pytest.approx(-math.tan(lean) * (after[z] - before[z]), abs=0.005)
        mill.key(Key.Key_F1)
        mill.key(Key.Key_F5)
        assert not page.model.tilted_jog.is_on
    finally:
        mill.close()


@pytest.mark.parametrize("name", ["name", "stops"])
def test_home_in_the_first_row_does_not_open_or_change_its_cell(mill: Mill, name: str) -> None:
    """A second selection of a cell by touch opens its text or turns its flag over."""
    mill.goes_on(lambda s: s.state is MachineState.DISABLED)
    frame = mill.window.frame
    assert frame is not None
    assert frame.open_page(page_table.MILL_TOOLS)
    page = frame.current_page
    assert isinstance(page, MillToolsPage)
    page.model.column_index = page.model.columns.index(name)
    before = page.model.stored_value
    for key in (Key.Key_Home, Key.Key_PageUp, Key.Key_Home):
        mill.key(key)
    assert (page.model.row_index, page.model.is_text_open) == (0, False)
    assert not mill.desk.offset_book.is_saving
    assert page.model.stored_value == before
