"""R parameters of the operator: kept, what programs begin with; an unset one is 0, with a warning."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import create_setup_with_offsets, read_store_offsets, read_stored_offsets
from app.offsets.active_offsets import R_PARAMETERS_SETTING, parse_r_parameters
from app.special.operator_settings import RParametersFunction
from app.special.special_functions import SpecialFunctionsModel
from core.executor.job import make_job
from core.language.diagnostics import Severity
from core.store.store import Store
from drivers.wakeups import ManualClock
from tests.sinumerik.lathe import MODULO, good, run, setup, source

WAY = "G0 X=R1 Z5"


def test_program_starts_with_r_parameters_set_by_operator() -> None:
    """X40 as a diameter: radius 20."""
    (move,) = good(WAY, replace(setup(), r={1: 40.0}))
    assert move.x == 20.0
    assert [b.x for b in good("R1=30\nG0 X=R1 Z5", replace(setup(), r={1: 40.0}))] == [15.0]


def test_unset_r_parameter_is_zero_and_reported_once() -> None:
    passed = run("G0 X=R7 Z5\nG0 Z=R7+1\nIF R8==0 GOTOF DONE\nG0 Z9\nDONE: G0 X=R7+2")
    assert [(each.line, each.code, each.severity) for each in passed.found] == [
        (1, "r-unset", Severity.WARNING),
        (3, "r-unset", Severity.WARNING),
    ]
    assert [(b.x, b.z) for b in passed.moves] == [(0.0, 5.0), (0.0, 1.0), (1.0, 1.0)]


@pytest.mark.parametrize(
    ("text", "code"), [("G0 Z=1/R7", "arithmetic"), ("G0 Z=LENGTH", "12550"), ("G0 Z=R300", "12080")]
)
def test_other_undefined_values_are_still_rejected(text: str, code: str) -> None:
    assert [each.code for each in run(text).errors] == [code]


def test_different_r_parameters_give_different_job_digests() -> None:
    jobs = [make_job(source(WAY), replace(setup(), r=r)).digest for r in ({}, {1: 40.0}, {1: 41.0})]
    assert len(set(jobs)) == 3


def test_store_saves_r_parameters(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.settings.save_setting(R_PARAMETERS_SETTING, {"1": 40.0, "299": -2.5}).result()
    with Store.open(tmp_path) as store:
        assert read_store_offsets(store).r_parameters == {1: 40.0, 299: -2.5}
        assert create_setup_with_offsets(MODULO, read_store_offsets(store)).r[1] == 40.0


@pytest.mark.parametrize("kept", [None, 3, [1], {"R1": 3.0}, {"300": 1.0}, {"1": "x"}, {"-1": 2.0}])
def test_invalid_stored_parameters_are_left_out(kept: object) -> None:
    assert parse_r_parameters(kept) == {}


# --- their page ------------------------------------------------------------------------------------------


@pytest.fixture
def page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[RParametersFunction]:
    file = tmp_path / "own.toml"
    file.write_text(MODULO.text)
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    clock, journal = ManualClock(), Journal.open_default()
    desk, executor = create_desk_and_executor(str(file), read_stored_offsets, clock, journal)
    executor.run_tick()
    functions = desk.page_registry.find_model(SpecialFunctionsModel)
    assert functions is not None
    (found,) = [each for each in functions.functions if isinstance(each, RParametersFunction)]
    yield found
    desk.close()
    journal.close()


def types(page: RParametersFunction, keys: str) -> None:
    for key in (*keys, "Enter"):
        page.handle_key(key)


def row(page: RParametersFunction, number: int) -> tuple[str, ...]:
    return page.make_table(page.desk.read_snapshot()).rows[number].cells


def test_typed_value_is_saved_for_every_program(page: RParametersFunction) -> None:
    page.handle_key("Down")
    types(page, "2*20.5")
    assert row(page, 1) == ("R1", "41")
    page._worker.wait_for_results(60.0)
    assert read_stored_offsets().r_parameters == {1: 41.0}


def test_value_is_deleted(page: RParametersFunction) -> None:
    types(page, "5")
    assert page.parameter_values == {0: 5.0}
    page.make_function_keys()["F4"].action()
    page._worker.wait_for_results(60.0)
    assert read_stored_offsets().r_parameters == {}
    assert (page.parameter_values, row(page, 0)) == ({}, ("R0", "–"))


@pytest.mark.parametrize("typed", ["1..2", "1/0", "99999999999", "--", "("])
def test_invalid_number_is_rejected(page: RParametersFunction, typed: str) -> None:
    types(page, typed)
    assert page.parameter_values == {}


def test_mark_stays_within_the_300_parameters(page: RParametersFunction) -> None:
    for _ in range(40):
        page.handle_key("Page down")
    assert page.marked == 299
