"""A start whose first move would cross the part is refused and not offered, and the path out leads to it."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.mdi.mdi_view import MdiPage
from app.screen.window.station_dock import StationDock
from app.searchto.searchto_model import RestartModel, RestartStage
from core.executor.commands import FIRST_MOVE_CROSSES
from core.executor.snapshot import MachineState, StartAction
from tests.attached import attached
from tests.screen.lathe import Key, Operator
from tests.screen.yes import twist_out
from tests.texts import shows

# T3 drills, T2 bores; line 3 goes to the outside, so that the straight path out of the bore crosses its wall.
BORE = (
    "G90G94F300G73\nT1\nX.9Z-.3\nX.9Z.2\nT3\nX0Z.2\nM03S900\nG95F.02Z-1\nG94F300Z.2\n"
    "T2\nX.3Z.2\nG95F.01Z-.8\nX.28\nG94F300Z.2\nX.4\nG95F.003Z-.8\nX.38\nG94F300Z.2\nT1\nX1Z1\nM30\n"
)
DEEP = 16  # the line that bores


@pytest.fixture
def in_the_bore(operator: Operator, tmp_path: Path) -> Operator:
    """After an E-stop with the boring bar in its bore: drives on, Automatic page."""
    path = tmp_path / "bore.nc"
    path.write_text(BORE)
    stage = operator.stage
    stage.make_ready(str(path))
    stage.press_start()
    operator.until(lambda: operator.shot.line == DEEP and depth(operator) < -0.4 * 25.4, 240.0)
    operator.key(Key.Key_E)
    operator.reaches(MachineState.ESTOP)
    twist_out(operator.window)
    operator.reaches(MachineState.DISABLED)
    operator.key(Key.Key_D)
    operator.reaches(MachineState.IDLE)
    stage.checks_start()
    return operator


def depth(operator: Operator) -> float:
    """Z of the tip in the part, mm."""
    return operator.shot.actual[1] - operator.shot.modal.offset_z


def offered(operator: Operator) -> list[str]:
    operator.window.refresh()
    return [key for row in operator.frame.notice_rows.notice_rows for key, _ in row.keys]


def dock(operator: Operator) -> StationDock:
    assert operator.frame.station_dock is not None
    return operator.frame.station_dock


def take_way_out(operator: Operator) -> None:
    """F6, F4, F10 and both palms; then back to the Automatic page."""
    model = attached(operator.stage.desk, RestartModel)
    operator.key(Key.Key_F6, Key.Key_F4)
    model.restart_finder.worker.wait_for_results(60.0)
    operator.window.refresh()
    operator.key(Key.Key_F10)
    model.restart_finder.worker.wait_for_results(60.0)
    assert model.stage is RestartStage.READY
    operator.palms()
    operator.reaches(MachineState.IDLE)
    operator.key(Key.Key_Escape, Key.Key_Escape)
    operator.stage.checks_start()


def test_start_from_bore_is_not_offered_and_retract_is_named(in_the_bore: Operator) -> None:
    operator = in_the_bore
    assert shows(operator.prompt(), "screen.first-move-crosses", tool="T2")
    assert shows(operator.prompt(), "screen.jog-until-clear", direction="Z+")
    assert offered(operator) == ["F6"]
    assert dock(operator).is_start_disabled
    assert len(operator.frame.automatic_page.path_view.drawn_legs) == 2  # the line that is refused is drawn


def test_y_and_palm_buttons_do_not_start_from_bore(in_the_bore: Operator) -> None:
    operator = in_the_bore
    at = operator.shot.actual
    operator.key(Key.Key_Y)
    assert shows(operator.frame.prompt_line.message_text, "screen.first-move-crosses")
    assert not operator.shot.confirmed
    operator.palms()
    assert (operator.shot.state, operator.shot.actual) == (MachineState.IDLE, at)
    assert operator.shot.start_code == FIRST_MOVE_CROSSES


def test_mdi_line_runs_out_of_bore_but_not_through_wall(
    in_the_bore: Operator,
) -> None:
    operator = in_the_bore
    operator.key(Key.Key_F1, Key.Key_F4)
    operator.pause(0.1)
    operator.line("G90G94F300X.9")
    assert [each.code for each in operator.mdi.prepared_line.blocking_errors] == [FIRST_MOVE_CROSSES]
    operator.palms()
    assert operator.shot.state is MachineState.IDLE
    operator.key(Key.Key_Escape, Key.Key_Escape)
    operator.run("G90G94F300Z.5")
    assert depth(operator) > 0.0


def test_program_starts_after_retract_from_bore(in_the_bore: Operator) -> None:
    operator = in_the_bore
    take_way_out(operator)
    assert operator.shot.starts is StartAction.PROGRAM
    assert depth(operator) > 0.0
    assert operator.stage.desk.find_first_move_refusal(operator.shot) == ""
    assert offered(operator) == ["F6", "Y"]
    assert not dock(operator).is_start_disabled
    operator.key(Key.Key_Y)
    operator.palms()
    operator.until(lambda: operator.shot.state is MachineState.RUN, 5.0)


def test_mdi_line_is_drawn_before_start(operator: Operator) -> None:
    operator.drives_on()
    operator.key(Key.Key_F1, Key.Key_F4)
    operator.pause(0.05)
    operator.line("G90G94F50X.5")
    page = operator.frame.current_page
    operator.window.refresh()
    assert isinstance(page, MdiPage)
    assert [(leg.x, leg.is_rapid) for leg in page.path_view.drawn_legs] == [(0.0, True), (12.7, False)]
    assert page.path_view.isVisible()
    operator.palms()
    operator.reaches(MachineState.IDLE)
    operator.window.refresh()
    assert not page.path_view.isVisible()


def test_start_from_home_is_offered_without_interruption(operator: Operator) -> None:
    operator.stage.make_ready()
    operator.window.refresh()
    assert not shows(operator.prompt(), "screen.first-move-crosses")
    assert not dock(operator).is_start_disabled
    assert len(operator.frame.automatic_page.path_view.drawn_legs) == 2
    operator.palms()
    assert operator.shot.state in {MachineState.RUN, MachineState.WAIT}
