"""Pages ahead of their first opening: what is loaded and made, when, and when not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.desk.desk import Desk
from app.desk.page_description import PageDescription
from app.desk.programs.program_loading import LoadingPhase
from app.scope.scope_view import ScopePage
from app.screen import page_table
from app.screen.page_base import Page
from app.screen.page_table import MIN_SLICE_INTERVAL_S, PagePreloader
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands

SLICES = 1000  # more than there can be


class Clock:
    """Time that passes when it is told to."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def idle() -> Iterator[Desk]:
    """A desk without a window, and time that stands."""
    found = desk_on(FakeMachine())
    found.clock.read_seconds = Clock()
    yield found
    found.close()


class Asked:
    """Stands for the frame: which pages were made, and a page that has three slices to make."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.slices = 3

    def __call__(self, name: str) -> Page:
        self.names.append(name)
        return self  # type: ignore[return-value]  # all that is asked of it is ``ahead``

    def continue_preparation(self) -> bool:
        """As a page."""
        self.slices -= 1
        return self.slices > 0


def steps(ahead: PagePreloader, idle: Desk) -> int:
    """As many slices as there are, each at its time; how many looks it took."""
    assert isinstance(idle.clock.read_seconds, Clock)
    for count in range(SLICES):
        if ahead.is_done:
            return count
        idle.clock.read_seconds.now += 2 * MIN_SLICE_INTERVAL_S
        ahead.continue_loading()
        ahead._worker.wait_for_results(60.0)
    raise AssertionError("it never ends")


ONE = (
    PageDescription("ONE", "app.scope.scope_view.ScopePage", deferred_modules=("app.screen.chart.Chart",)),
)
PLAIN = (PageDescription("PLAIN", "app.scope.scope_view.ScopePage"),)
NO_FILE = (
    PageDescription("GONE", "app.scope.no_such_file.Page", deferred_modules=("app.screen.chart.Chart",)),
)


def entries(monkeypatch: pytest.MonkeyPatch, found: tuple[PageDescription, ...]) -> None:
    monkeypatch.setattr(page_table, "list_pages", lambda _language: found)


def test_page_with_charts_is_created_in_slices(idle: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    entries(monkeypatch, ONE)
    asked = Asked()
    ahead = PagePreloader(idle, asked)
    steps(ahead, idle)
    assert asked.names == ["ONE"]
    assert asked.slices == 0
    ahead.close()


def test_other_pages_are_only_imported(idle: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    entries(monkeypatch, PLAIN)
    asked = Asked()
    ahead = PagePreloader(idle, asked)
    steps(ahead, idle)
    assert not asked.names
    ahead.close()


def test_nothing_is_preloaded_while_program_is_loading(idle: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    entries(monkeypatch, ONE)
    asked = Asked()
    ahead = PagePreloader(idle, asked)
    before = idle.program_loader.loaded_program
    idle.program_loader.replace_loaded_program(replace(before, phase=LoadingPhase.PROVING))
    with pytest.raises(AssertionError, match="never ends"):
        steps(ahead, idle)
    assert not asked.names
    idle.program_loader.replace_loaded_program(before)
    steps(ahead, idle)
    assert asked.names
    ahead.close()


def test_slices_wait_for_minimum_interval(idle: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    entries(monkeypatch, ONE)
    asked = Asked()
    ahead = PagePreloader(idle, asked)
    idle.clock.read_seconds.now += 2 * MIN_SLICE_INTERVAL_S  # type: ignore[attr-defined]
    for _ in range(SLICES):
        ahead.continue_loading()
        ahead._worker.wait_for_results(60.0)
    assert asked.slices == 3, "at one instant there is one slice: the modules were asked for"
    ahead.close()


def test_unloadable_page_is_skipped_without_message(idle: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    entries(monkeypatch, NO_FILE + PLAIN)
    asked = Asked()
    ahead = PagePreloader(idle, asked)
    steps(ahead, idle)
    assert not asked.names
    assert not idle.prompt_notice
    ahead.close()


def test_page_without_model_is_not_created(idle: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    entries(monkeypatch, (replace(ONE[0], model_class="core.executor.scope_recorder.ScopeRecorder"),))
    asked = Asked()
    ahead = PagePreloader(idle, asked)
    steps(ahead, idle)
    assert not asked.names
    ahead.close()


def test_closed_preloader_starts_nothing(idle: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    entries(monkeypatch, ONE)
    asked = Asked()
    ahead = PagePreloader(idle, asked)
    ahead.close()
    assert steps(ahead, idle) == 0
    assert not asked.names


@pytest.mark.parametrize("language", ["omniturn", "klartext", "sinumerik"])
def test_every_page_class_can_be_imported(language: str) -> None:
    for entry in page_table.list_pages(language):
        page_table.import_page_classes(entry)


def test_scope_opens_with_preloaded_chart(hands: Hands) -> None:
    hands.sees(lambda: hands.window.page_preloader is not None and hands.window.page_preloader.is_done)
    assert hands.frame.current_page is hands.page, "nothing is opened by it"
    QTest.keyClick(hands.window, Qt.Key.Key_F10, Qt.KeyboardModifier.ShiftModifier)
    page = hands.frame.current_page
    assert isinstance(page, ScopePage)
    assert page.curve_area.chart is not None
    assert len(page.curve_area.chart._spare) == 4
