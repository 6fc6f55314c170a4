"""Tour on the screen: it makes its part, any input ends it, and it never moves a real machine."""

from __future__ import annotations

import errno
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import ClassVar

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.compose.machine.machine_files import load_machine
from app.desk.data_folder import find_data_folder
from app.desk.persistence import Persistence
from app.desk.translation import tr
from app.extras.tour import tour_view
from app.extras.tour.extra import EXTRA
from app.extras.tour.tour_director import MAX_STEP_S, TourDirector
from app.extras.tour.tour_function import TourFunction
from app.extras.tour.tour_setup import SHOWN_SETTING, use_tour_folder
from app.extras.tour.tour_view import TourInputFilter, WindowKeyboard
from app.offsets.offset_effect import OffsetEffectWorker
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, measure_text, set_language
from app.screen.window.window_bars import CAPTION_TEXT
from app.screen.window_layout import MIN_WINDOW_PX, make_automatic_layout
from app.special.special_functions import SpecialFunctionsModel
from core.executor.snapshot import Alarm, MachineState
from core.extras.tour.tour_script import FAULTY_PROGRAM_NAME, TOUR_STEPS, TourStep
from core.proving.offset_comparison import FeatureKind, Pair
from tests.screen.day import Day, Key, begun
from tests.texts import shows

INCH = 25.4
WORK_TIMEOUT_S = 60.0


@dataclass
class ShownTour:
    """Tour in the window of a day, whose clock the test moves."""

    day: Day
    ends: list[bool] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.keyboard = WindowKeyboard(self.day.window)
        self.director = TourDirector(self.day.desk, self.keyboard, lambda: self.ends.append(True))
        self.day.desk.page_registry.set_guidance_card(self.director)

    @property
    def step(self) -> TourStep | None:
        return self.director.current_step

    def run_until(self, is_true: Callable[[], bool]) -> None:
        """Advance machine, screen and tour until something is true."""

        def tick() -> bool:
            for _ in range(20):
                self.day.run(0.05)
                self.wait_for_workers()
                self.director.advance()
                if is_true():
                    return True
            return False

        self.day.qtbot.waitUntil(tick, timeout=120_000)

    def wait_for_workers(self) -> None:
        """Wait for the proof and the comparison, because the clock of the test runs ahead of them."""
        self.day.desk.program_loader.wait_until_loaded(WORK_TIMEOUT_S)
        effect = self.day.desk.page_registry.find_model(OffsetEffectWorker)
        if effect is not None:
            effect.worker.wait_for_results(WORK_TIMEOUT_S)

    def run_to(self, caption_start: str) -> None:
        self.run_until(lambda: self.step is not None and self.step.caption.startswith(caption_start))

    @property
    def caption(self) -> str:
        self.day.window.refresh()
        rows = self.day.frame.notice_rows.notice_rows
        return rows[0].text if rows else ""


class EndingDirector(TourDirector):
    """Director of a tour that ends at once."""

    def advance(self) -> None:
        self._end()


@contextmanager
def tour_on(qtbot: QtBot) -> Iterator[ShownTour]:
    with use_tour_folder(), begun(qtbot) as day:
        yield ShownTour(day)


@pytest.fixture
def tour(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[ShownTour]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    with tour_on(qtbot) as shown:
        yield shown


@pytest.fixture
def input_filter(tour: ShownTour, qapp: QApplication) -> Iterator[TourInputFilter]:
    made = TourInputFilter(tour.day.window, tour.keyboard, tour.director.stop)
    qapp.installEventFilter(made)
    yield made
    qapp.removeEventFilter(made)


# --- the whole tour -------------------------------------------------------------------------------------


def test_tour_makes_a_part_corrects_wear_and_finds_the_crash(tour: ShownTour) -> None:
    day = tour.day
    seen, pairs = list[str](), list[Pair]()

    def watch() -> bool:
        if not pairs and tour.step is not None and tour.step.caption.startswith("EVERY DIAMETER"):
            effect = day.desk.page_registry.find_model(OffsetEffectWorker)
            assert effect is not None
            assert effect.compared_part is not None
            pairs.extend(effect.compared_part.feature_pairs)
        if tour.step is not None and (not seen or seen[-1] != tour.step.caption):
            seen.append(tour.step.caption)
        return bool(tour.ends)

    tour.run_until(watch)
    assert seen == [step.caption for step in TOUR_STEPS]
    assert day.shot.parts == 1
    assert day.shot.underruns == 0
    d1 = day.desk.offset_book.secondary_offsets[1]
    assert d1.x == pytest.approx(-0.0006 * INCH)  # half of -.0012 in, because X is stored as a radius
    assert day.desk.program_loader.loaded_program.name == FAULTY_PROGRAM_NAME
    assert day.shot.begun == 1  # the program with the wrong sign did not start
    assert day.shot.state is MachineState.IDLE
    assert day.shot.rpm_command == 0.0
    assert tour.ends == [True]
    assert tour.caption == ""
    check_table_of_the_caption(pairs)


def check_table_of_the_caption(pairs: list[Pair]) -> None:
    """Check that shank and head, both cut with D1, get .0012 in smaller, and that each row has two values."""
    diameters = [
        (before.at / INCH, after.at / INCH)
        for before, after in pairs
        if before is not None and after is not None and before.kind is FeatureKind.DIAMETER
    ]
    assert all(None not in each for each in pairs)
    assert [before for before, _ in diameters] == pytest.approx([0.5, 0.86], abs=2e-5)
    assert [after for _, after in diameters] == pytest.approx([0.4988, 0.8588], abs=2e-5)


def test_caption_names_the_line_with_the_wrong_sign(tour: ShownTour) -> None:
    tour.run_to("A WRONG SIGN")
    tour.run_until(lambda: tour.day.desk.program_loader.loaded_program.name == FAULTY_PROGRAM_NAME)
    tour.day.sees(
        lambda: shows(tour.caption, "tour.wrong-sign", line=8)
    )  # line 8 of tour.nc, counted by hand


@pytest.mark.parametrize("language", ["en", "es"])
def test_every_caption_fits_in_the_smallest_window(qapp: object, language: str) -> None:
    theme = ScreenTheme(DARK_PALETTE)
    theme.set_window_size(*MIN_WINDOW_PX)
    width_px = make_automatic_layout(*MIN_WINDOW_PX, has_dock=True).strip.w - 2.4 * theme.unit_px
    set_language(language)
    texts = [tr(step.caption) for step in TOUR_STEPS]
    set_language("en")
    widths = {text: measure_text(text, theme.fit_font(text, CAPTION_TEXT, width_px)) for text in texts}
    assert [text for text, width in widths.items() if width > width_px] == []


def is_caption_alone(tour: ShownTour) -> bool:
    tour.day.window.refresh()
    return [row.is_caption for row in tour.day.frame.notice_rows.notice_rows] in ([], [True])


# --- the end by the operator ----------------------------------------------------------------------------


@pytest.mark.parametrize("caption", ["TURNING", "THREADING", "MILLING", "PARTING"])
def test_stop_in_the_cut_leaves_the_machine_at_rest_with_the_spindle_off(
    tour: ShownTour, caption: str
) -> None:
    tour.run_to(caption)
    tour.run_until(lambda: tour.day.shot.line > 0)
    tour.director.stop()
    assert shows(tour.caption, "tour.ends")
    tour.run_until(lambda: bool(tour.ends) or not is_caption_alone(tour))
    assert tour.ends == [True]
    assert tour.day.shot.state is MachineState.IDLE
    assert tour.day.shot.rpm_command == 0.0
    assert "coolant" not in tour.day.shot.outputs
    assert not tour.keyboard.is_pressing


@pytest.mark.parametrize("key", [Key.Key_F9, Key.Key_X, Key.Key_5, Key.Key_D])
def test_key_ends_the_tour_and_does_nothing_else(
    tour: ShownTour, input_filter: TourInputFilter, key: Key
) -> None:
    tour.run_to("TURNING")
    tour.day.key(key)
    assert tour.director.is_stopping
    assert tour.day.page == "AUTOMATIC"
    tour.day.key(Key.Key_F9)  # also while the tour is stopping
    assert tour.day.page == "AUTOMATIC"
    tour.run_until(lambda: bool(tour.ends))
    assert tour.day.shot.state is MachineState.IDLE


def test_emergency_stop_key_presses_the_emergency_stop_and_ends_the_tour(
    tour: ShownTour, input_filter: TourInputFilter
) -> None:
    tour.run_to("TURNING")
    tour.run_until(lambda: tour.day.shot.state is MachineState.RUN)
    tour.day.key(Key.Key_E)
    assert tour.director.is_stopping
    tour.run_until(lambda: bool(tour.ends))
    assert tour.day.shot.state is MachineState.ESTOP


def test_click_ends_the_tour_without_its_effect(tour: ShownTour, input_filter: TourInputFilter) -> None:
    tour.run_to("TURNING")
    bar = tour.day.frame.key_bar
    QTest.mouseClick(bar, Qt.MouseButton.LeftButton, pos=QPoint(bar.width() // 2, bar.height() // 2))
    assert tour.director.is_stopping
    assert tour.day.page == "AUTOMATIC"
    assert not input_filter.was_closed


def test_touch_ends_the_tour_without_its_effect(tour: ShownTour, input_filter: TourInputFilter) -> None:
    tour.run_to("TURNING")
    bar = tour.day.frame.key_bar
    finger = QTest.createTouchDevice()
    QTest.touchEvent(bar, finger).press(0, QPoint(bar.width() // 2, bar.height() // 2), bar).commit()
    assert tour.director.is_stopping
    assert tour.day.page == "AUTOMATIC"
    QTest.touchEvent(bar, finger).release(0, QPoint(bar.width() // 2, bar.height() // 2), bar).commit()
    assert tour.day.page == "AUTOMATIC"


def test_closing_the_window_ends_the_tour_but_keeps_the_window_until_the_machine_is_at_rest(
    tour: ShownTour, input_filter: TourInputFilter
) -> None:
    tour.run_to("TURNING")
    assert not tour.day.window.close()
    assert input_filter.was_closed
    assert tour.director.is_stopping
    assert tour.day.window.isVisible()


def test_key_pressed_while_the_next_screen_is_built_does_not_act_on_it(
    tour: ShownTour, monkeypatch: pytest.MonkeyPatch
) -> None:
    day, pages = tour.day, list[str]()

    def build_screen() -> None:
        day.key(Key.Key_F9)
        pages.append(day.page)
        day.key(Key.Key_E)

    monkeypatch.setattr(tour_view, "TourDirector", EndingDirector)
    show = tour_view.Tour(find_data_folder(), opens_desk=True)
    show.begin(day.window, build_screen)
    day.qtbot.waitUntil(lambda: bool(pages))
    assert pages == ["AUTOMATIC"]
    assert day.desk.station_controls.is_estop_pressed  # stop keys act at once

    def press_key() -> bool:
        day.key(Key.Key_F9)
        return day.page == "SECONDARY OFFSETS"

    day.qtbot.waitUntil(press_key)
    show.close()


def test_keys_of_the_tour_do_not_end_it(tour: ShownTour, input_filter: TourInputFilter) -> None:
    tour.keyboard.press_key("F9")
    assert tour.day.page == "SECONDARY OFFSETS"
    assert not tour.director.is_stopping


# --- rejected -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["gt75-canopen", "gt75-hal", "gt75-grblhal", "gt75-vfd"])
def test_tour_presses_no_key_on_a_machine_that_is_not_simulated(
    tour: ShownTour, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = load_machine(Path(f"resources/machines/{name}.toml"))
    pressed = list[str]()
    monkeypatch.setattr(tour.keyboard, "press_key", pressed.append)
    monkeypatch.setattr(tour.day.desk, "machine", replace(tour.day.desk.machine, machine=real))
    assert not tour.director.can_move_machine()
    tour.run_until(lambda: bool(tour.ends))
    assert pressed == []
    assert tour.day.shot.begun == 0
    assert tour.day.shot.state is MachineState.DISABLED


def hold_feed(day: Day) -> None:
    day.desk.start_feed_hold()


def press_estop(day: Day) -> None:
    day.desk.station_controls.estop(is_pressed=True)


def turn_on_single_block(day: Day) -> None:
    day.desk.toggle_switch("single_block")


@pytest.mark.parametrize(
    ("disturb", "end"),
    [
        (hold_feed, MachineState.IDLE),
        (turn_on_single_block, MachineState.IDLE),
        (press_estop, MachineState.ESTOP),
    ],
)
def test_stop_that_the_tour_did_not_cause_ends_it(
    tour: ShownTour, disturb: Callable[[Day], None], end: MachineState
) -> None:
    tour.run_to("TURNING")
    tour.run_until(lambda: tour.day.shot.state is MachineState.RUN)
    disturb(tour.day)
    start = tour.day.clock.now()
    tour.run_until(lambda: bool(tour.ends) or tour.day.clock.now() - start > MAX_STEP_S / 2)
    assert tour.ends == [True]
    assert tour.day.shot.state is end
    assert tour.day.shot.rpm_command == 0.0


def test_alarm_ends_the_tour(tour: ShownTour, monkeypatch: pytest.MonkeyPatch) -> None:
    tour.run_to("TURNING")
    alarm = Alarm(101, "axis", "AXIS DRIVE FAULT", "", "")
    shot = replace(tour.day.shot, state=MachineState.FAULT, alarms=(alarm,))
    monkeypatch.setattr(tour.day.desk, "read_snapshot", lambda: shot)
    tour.director.advance()
    assert tour.director.is_stopping


def test_tour_that_cannot_continue_ends(tour: ShownTour) -> None:
    (tour.day.desk.program_choice.program_folders.folders[0] / "tour.nc").unlink()
    start = tour.day.clock.now()
    tour.run_until(lambda: bool(tour.ends))
    assert tour.day.clock.now() - start > MAX_STEP_S
    assert tour.day.shot.begun == 0


# --- special function -----------------------------------------------------------------------------------


class StartedProcess:
    """Process of a tour that the test ends."""

    commands: ClassVar[list[list[str]]] = []

    def __init__(self, command: list[str], **_options: object) -> None:
        self.commands.append(command)
        self.status: int | None = None
        self.hangs = False

    def poll(self) -> int | None:
        return self.status

    def terminate(self) -> None:
        self.status = -15

    def wait(self, timeout: float | None = None) -> int:
        if self.hangs:
            assert timeout is not None
            raise subprocess.TimeoutExpired(self.commands[-1], timeout)
        return self.status or 0


@pytest.fixture
def function(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[tuple[Day, TourFunction]]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    monkeypatch.setattr(subprocess, "Popen", StartedProcess)
    monkeypatch.setattr(StartedProcess, "commands", [])
    with begun(qtbot) as day:
        day.key(Key.Key_F10)
        model = day.desk.page_registry.find_model(SpecialFunctionsModel)
        assert model is not None
        index = next(n for n, each in enumerate(model.functions) if isinstance(each, TourFunction))
        model.open_function(index)
        shown = model.shown_function
        assert isinstance(shown, TourFunction)
        yield day, shown


def test_special_function_starts_one_tour_in_its_own_process(function: tuple[Day, TourFunction]) -> None:
    day, shown = function
    day.key(Key.Key_Return)
    assert [command[-2:] for command in StartedProcess.commands] == [["tour", "--from-screen"]]
    assert shows(day.prompt, "tour.opens")
    day.key(Key.Key_F2)
    assert shows(day.prompt, "tour.running")
    assert len(StartedProcess.commands) == 1
    day.saved()
    assert day.store.settings.read_setting(SHOWN_SETTING) is True
    shown.close()
    day.key(Key.Key_F2)
    assert len(StartedProcess.commands) == 2


def test_tour_that_cannot_start_is_reported(
    function: tuple[Day, TourFunction], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_words: object, **_options: object) -> None:
        raise OSError(errno.ENOMEM, "Cannot allocate memory")

    day, shown = function
    monkeypatch.setattr(subprocess, "Popen", fail)
    day.key(Key.Key_F2)
    assert "Cannot allocate memory" in day.prompt  # the text of the system
    day.saved()
    assert day.store.settings.read_setting(SHOWN_SETTING) is None
    shown.close()


def test_screen_closes_although_the_tour_does_not_end(
    function: tuple[Day, TourFunction], monkeypatch: pytest.MonkeyPatch
) -> None:
    day, shown = function
    day.key(Key.Key_Return)
    assert isinstance(shown._process, StartedProcess)
    shown._process.hangs = True
    shown.close()
    assert shown._process.status == -15


def test_special_function_is_rejected_on_a_real_machine(function: tuple[Day, TourFunction]) -> None:
    day, _ = function
    real = load_machine(Path("resources/machines/gt75-canopen.toml"))
    model = day.desk.page_registry.find_model(SpecialFunctionsModel)
    assert model is not None
    ((shown, _preceding),) = EXTRA.list_special_functions(day.desk, real, Persistence(), model.worker)
    assert isinstance(shown, TourFunction)
    assert shows(shown.make_table(day.shot).notes[0], "tour.simulated-only")
    shown.start_tour()
    assert shows(day.prompt, "tour.simulated-only")
    assert StartedProcess.commands == []


def test_special_function_is_rejected_in_kiosk_mode(function: tuple[Day, TourFunction]) -> None:
    day, _ = function
    day.desk.window_state.is_kiosk = True
    day.key(Key.Key_Return)
    assert shows(day.prompt, "tour.kiosk")
    assert StartedProcess.commands == []


def test_special_function_is_rejected_while_a_program_is_in_feed_hold(
    function: tuple[Day, TourFunction], monkeypatch: pytest.MonkeyPatch
) -> None:
    day, shown = function
    held = replace(day.shot, state=MachineState.HOLD)
    monkeypatch.setattr(shown.desk, "read_snapshot", lambda: held)
    assert shows(shown.find_refusal(), "tour.program-active")
