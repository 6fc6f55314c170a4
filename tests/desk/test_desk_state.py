"""The objects that the desk shares: what they report before anybody has connected them, and after."""

from __future__ import annotations

import pytest

from app.desk.late_presses import LatePressFilter
from app.desk.page_description import ProgramKey
from app.desk.pages.page_registry import PageRegistry
from app.desk.state.desk_machine import DeskMachine
from app.desk.state.storage_state import StorageState
from app.desk.state.window_state import WindowState
from core.executor.snapshot import Snapshot


class Model:
    def __init__(self, why: str = "") -> None:
        self.is_open, self._why = False, why

    def barred(self) -> str:
        return self._why

    def close(self) -> None:
        """Nothing is open."""


class Other(Model):
    """Another class of model."""


def test_model_is_found_only_by_its_class() -> None:
    pages, model = PageRegistry(), Model()
    pages.attach_model(model)
    assert pages.find_model(Model) is model
    assert pages.find_model(Other) is None
    assert [step.name for step in pages.make_closing_steps()] == ["Model"]


def test_lazy_model_is_created_once_on_first_lookup() -> None:
    pages, made = PageRegistry(), list[Other]()

    def make() -> Other:
        made.append(Other())
        return made[-1]

    pages.attach_lazy_model(f"{Other.__module__}.Other", make)
    assert pages.find_model(Model) is None
    assert (made, pages.make_closing_steps()) == ([], [])
    assert pages.find_model(Other) is pages.find_model(Other)
    assert len(made) == 1


def test_open_page_with_a_start_receives_the_start_buttons() -> None:
    pages, first, second = PageRegistry(), Model("first"), Model("second")
    for each in (first, second):
        pages.add_start_handler(each)
    assert pages.active_start_handler is None
    second.is_open = True
    assert pages.active_start_handler is second


def test_program_key_is_offered_only_if_a_feature_adds_it() -> None:
    pages = PageRegistry()
    assert pages.find_notice(Snapshot()) is None
    assert dict(pages.program_keys) == {}
    key = ProgramKey("JOB", "JOBS", lambda _path: None)
    pages.add_program_key("F10", key)
    assert dict(pages.program_keys) == {"F10": key}


def test_missing_window_bars_nothing_and_page_may_bar_start() -> None:
    window = WindowState(LatePressFilter(Snapshot, float))
    assert (window.can_start_here, window.is_keyboard_lost, window.is_stop_key_held()) == (True, False, False)
    assert (window.has_text_field(), window.find_press_age_s()) == (False, 0.0)
    woken: list[bool] = []
    window.connect_window(lambda: woken.append(True), lambda: True, lambda: 0.25)
    window.set_page_properties(can_start=False, has_field=lambda: True)
    window.set_keyboard_lost(True)
    window.wake_window()
    assert (window.can_start_here, window.is_keyboard_lost, window.is_stop_key_held()) == (False, True, True)
    assert (window.has_text_field(), window.find_press_age_s(), woken) == (True, 0.25, [True])


@pytest.mark.parametrize("problem", ["", "the disk is full"])
def test_storage_state_follows_its_store(problem: str) -> None:
    storage, checked = StorageState(), list[bool]()
    assert (
        storage.read_storage_problem(),
        storage.read_unsaved_text(),
        storage.describe_file_difference(),
    ) == (
        "",
        "",
        "",
    )
    storage.set_store_readers(lambda: problem, lambda: "20 parts")
    storage.set_file_readers(lambda: "DIFFERENT", lambda: checked.append(True))
    storage.recheck_file()
    assert (
        storage.read_storage_problem(),
        storage.read_unsaved_text(),
        storage.describe_file_difference(),
    ) == (
        problem,
        "20 parts",
        "DIFFERENT",
    )
    assert checked == [True]


def test_starts_are_barred_from_begin_to_end_of_a_restore() -> None:
    storage = StorageState()
    assert not storage.is_restoring
    storage.begin_restore()
    assert storage.is_restoring
    storage.end_restore()
    assert not storage.is_restoring


def test_a_machine_without_a_file_is_an_omniturn_lathe() -> None:
    machine = DeskMachine()
    assert (machine.program_language, machine.third_axis_name, machine.is_table_rotary) == (
        "omniturn",
        "C",
        True,
    )
