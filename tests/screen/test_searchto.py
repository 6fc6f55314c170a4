"""SEARCHTO by keys alone: from an E-stop in the middle of a part to the finished part."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtTest import QTest

from app.desk.status.prompt_line import HOLD_HINT
from app.screen import page_table
from app.screen.panel import Panel
from app.screen.window_layout import FINGERTIP_PX
from app.searchto.searchto_model import RestartModel, RestartStage
from app.searchto.searchto_view import RestartPage
from core.executor.snapshot import MachineState, StartAction
from tests.attached import attached
from tests.screen.lathe import Key, Operator
from tests.screen.yes import twist_out
from tests.texts import begins, pattern, text


def model_of(operator: Operator) -> RestartModel:
    return attached(operator.stage.desk, RestartModel)


def page_of(operator: Operator) -> RestartPage:
    operator.window.refresh()
    page = operator.frame.current_page
    assert isinstance(page, RestartPage)
    return page


def loaded(operator: Operator) -> None:
    """The sample program on the desk, proved; drives on."""
    desk = operator.stage.desk
    desk.program_choice.load_by_name("bushing")
    desk.program_loader.wait_until_loaded(30.0)
    operator.drives_on()


def estop_and_recover(operator: Operator) -> None:
    operator.key(Key.Key_E)
    operator.reaches(MachineState.ESTOP)
    twist_out(operator.window)
    operator.reaches(MachineState.DISABLED)
    operator.key(Key.Key_D)
    operator.reaches(MachineState.IDLE)


def found(operator: Operator) -> RestartPage:
    """Enter, and wait for the worker."""
    operator.key(Key.Key_Return)
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    operator.pause(0.05)
    return page_of(operator)


def confirmed(operator: Operator) -> None:
    operator.key(Key.Key_F10)
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    operator.pause(0.05)
    assert model_of(operator).stage is RestartStage.READY


def test_part_is_finished_from_interrupted_line_after_estop(operator: Operator) -> None:
    operator.stage.start()
    operator.until(lambda: operator.shot.line == 18, 120.0)
    operator.pause(0.2)
    estop_and_recover(operator)
    operator.key(Key.Key_F6)
    assert operator.frame.title_line.page_title == page_table.SEARCHTO_PAGE
    assert begins(operator.prompt(), "search.broke-off", line=18)
    page = found(operator)
    assert page.state_panel.content.title == text("search.state-at-line", line=18)
    assert page.functions_panel.functions_to_start == ("SPINDLE FORWARD G97 1800 RPM", "COOLANT")
    assert [leg.label for leg in page.path_view.drawn_legs] == ["", "1 X", "2 Z", "3 Z", "4 X", "5 Z"]
    assert [leg.is_rapid for leg in page.path_view.drawn_legs[1:]] == [False, False, True, True, True]
    assert operator.shot.rpm_command == 0.0
    assert "coolant" not in operator.shot.outputs  # nothing starts before it is confirmed and started
    confirmed(operator)
    assert begins(operator.prompt(), "search.start-restart", start=pattern("screen.both-palms"))
    operator.palms()
    operator.window.refresh()
    assert operator.frame.current_page is operator.frame.automatic_page
    assert operator.shot.state in {MachineState.RUN, MachineState.WAIT}
    operator.pause(0.1)
    assert operator.prompt() == HOLD_HINT  # nothing was refused on the way
    operator.until(lambda: operator.shot.line == 26, 60.0)
    assert operator.shot.modal.diameter
    assert operator.shot.modal.secondary == 1
    operator.until(lambda: operator.shot.parts == 1, 240.0)


def test_restart_page_marks_every_state_that_must_change(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    page = found(operator)
    rows = {row.label: row for row in page.state_panel.content.state_rows}
    assert (rows["X VALUES"].required_value, rows["X VALUES"].current_value) == ("G72 Ø", "G73 R")
    assert (rows["SPINDLE"].required_value, rows["SPINDLE"].current_value) == ("M03", "M05")
    assert (rows[text("search.first-feed")].required_value, rows["FEED"].required_value) == (
        "300.00",
        "0.00600 in/rev",
    )
    assert rows["COOLANT"].must_change
    assert not rows["UNITS"].must_change
    assert page.state_panel.grab().width() > 0


def test_line_is_found_by_its_text_and_list_scrolls_to_it(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("(FINISH")
    operator.key(Key.Key_Return)
    assert model_of(operator).line_cursor.selected_line == 22
    operator.key(Key.Key_Escape)
    operator.type("x.5")
    operator.key(Key.Key_F2)
    assert model_of(operator).line_cursor.selected_line == 37
    operator.key(Key.Key_F3)
    assert model_of(operator).line_cursor.selected_line == 22
    operator.key(Key.Key_Escape)
    operator.type("QQ")
    operator.key(Key.Key_Return)
    assert operator.prompt() == text("search.in-no-line", what="QQ")


def press(panel: Panel, box: QRectF) -> None:
    QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=box.center().toPoint())


def test_line_is_marked_or_its_number_typed_by_touch(operator: Operator) -> None:
    """The lines were no target, and nothing brought figures: a finger had F8 and F9 alone."""
    loaded(operator)
    operator.window.resize(1024, 600)
    operator.key(Key.Key_F6)
    page = page_of(operator)
    page.program_listing.grab()
    assert all(box.height() >= FINGERTIP_PX for box, *_ in page.program_listing._places)
    press(page.program_listing, page.program_listing._places[3][0])
    assert model_of(operator).line_cursor.selected_line == page.program_listing.first_row + 4
    page.entry_panel.grab()
    entry, *_ = page.entry_panel._places[0]
    assert entry.height() >= FINGERTIP_PX
    press(page.entry_panel, entry)
    assert page.number_pad.isVisible()
    operator.window.refresh()
    page.number_pad.grab()
    keys = dict(zip("789/456*123-0.(+", page.number_pad._places, strict=False))
    for figure in "12":
        box, *_ = keys[figure]
        assert min(box.width(), box.height()) >= FINGERTIP_PX
        press(page.number_pad, box)
    press(page.number_pad, page.number_pad._places[-1][0])  # RETURN
    assert model_of(operator).line_cursor.selected_line == 12
    assert page.number_pad.isHidden()
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    page_of(operator)
    page.program_listing.grab()
    place = 12 - page.program_listing.first_row - 1
    press(page.program_listing, page.program_listing._places[place][0])  # on the marked one: its state again
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    page_of(operator)
    assert model_of(operator).restart_refusal is not None or model_of(operator).restart_plan is not None


def test_line_without_valid_restart_offers_neighboring_lines(operator: Operator) -> None:
    desk = operator.stage.desk
    desk.program_choice.load_by_name("pin")
    desk.program_loader.wait_until_loaded(30.0)
    operator.drives_on()
    operator.key(Key.Key_F6)
    operator.type("8P9")
    page = found(operator)
    assert page.state_panel.content.refusal_reason == text("search.no-such-pass", line=8, count=5, wanted=9)
    before, after = page.state_panel.content.nearest_valid_lines
    assert (before.key_name, after.key_name) == ("F8", "F9")
    operator.key(Key.Key_F10)
    assert operator.prompt() == text("search.good-line-first")
    operator.key(Key.Key_F9)
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    assert page_of(operator).state_panel.content.title == text("search.state-at-line", line=after.line_number)


def test_palm_buttons_start_nothing_before_confirmation(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.palms()
    assert begins(operator.prompt(), "screen.search-first")
    operator.type("7")
    found(operator)
    operator.palms()
    assert operator.shot.state is MachineState.IDLE
    assert operator.shot.starts is StartAction.RESTART


def test_leaving_page_cancels_ready_restart(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    confirmed(operator)
    operator.key(Key.Key_F1, Key.Key_F2)
    operator.pause(0.05)
    assert operator.shot.starts is StartAction.PROGRAM
    assert operator.shot.prepared_job_digest == ""


def test_coolant_and_approach_are_selected_by_operator(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("38")
    page = found(operator)
    assert page.functions_panel.functions_to_start[-1] == "COOLANT"
    assert page.functions_panel.option_texts == (text("search.with-coolant"),)
    operator.key(Key.Key_F5)
    page = page_of(operator)
    assert page.functions_panel.functions_to_start == ("SPINDLE FORWARD G97 2200 RPM",)
    assert page.functions_panel.option_texts == (text("search.without-coolant"),)
    assert page.functions_panel.error_text == ""
    confirmed(operator)
    operator.key(Key.Key_F5)  # another start is not the one that was proved
    assert model_of(operator).stage is RestartStage.PLAN_SHOWN
    assert operator.shot.prepared_job_digest != ""
    operator.pause(0.05)
    assert operator.shot.prepared_job_digest == ""


def test_collet_must_match_state_at_line(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F1, Key.Key_F4)
    operator.pause(0.05)
    operator.run("M13")
    operator.key(Key.Key_F2, Key.Key_F6)
    operator.type("7")
    page = found(operator)
    assert begins(page.functions_panel.error_text, "search.collet-open")
    operator.key(Key.Key_F10)
    assert begins(operator.prompt(), "search.collet-open")
    assert model_of(operator).stage is RestartStage.PLAN_SHOWN


def test_searchto_does_not_open_without_a_program_nor_while_one_runs(operator: Operator) -> None:
    operator.key(Key.Key_F6)
    assert operator.frame.current_page is operator.frame.automatic_page
    assert operator.prompt() == text("screen.choose-program")
    operator.stage.start()
    operator.key(Key.Key_F6)
    assert begins(operator.prompt(), "screen.program-runs-no-search")


def test_restart_cannot_be_confirmed_with_drives_off(operator: Operator) -> None:
    desk = operator.stage.desk
    desk.program_choice.load_by_name("bushing")
    desk.program_loader.wait_until_loaded(30.0)
    operator.until(lambda: operator.shot.state is MachineState.DISABLED)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    operator.key(Key.Key_F10)
    assert operator.prompt() == text("screen.drives-off-for-search")


def test_reloaded_program_is_searched_again(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    confirmed(operator)
    desk = operator.stage.desk
    path = desk.program_loader.loaded_program.path
    assert path is not None
    desk.program_loader.start_loading(path)
    desk.program_loader.wait_until_loaded(30.0)
    operator.pause(0.1)
    page_of(operator)
    assert model_of(operator).stage is RestartStage.CHOOSING
    operator.palms()
    assert operator.shot.state is MachineState.IDLE


def test_search_field_accepts_every_letter(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("eh x")
    assert page_of(operator).entry_panel.entry_text == "eh x"
    assert operator.shot.state is MachineState.IDLE


def test_esc_goes_back_one_step_at_a_time(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    operator.key(Key.Key_Escape)
    assert model_of(operator).stage is RestartStage.CHOOSING
    operator.key(Key.Key_Escape)
    assert operator.frame.current_page is operator.frame.automatic_page


def test_retract_uses_path_of_active_tool_and_skipped_lines_are_listed(
    operator: Operator,
) -> None:
    operator.stage.start()
    operator.until(lambda: operator.shot.line == 18, 120.0)
    operator.pause(0.2)
    estop_and_recover(operator)
    operator.key(Key.Key_F6)
    operator.type("41")
    page = found(operator)
    assert begins(page.functions_panel.error_text, "search.left-out", first=18, last=39)
    assert page.path_view.drawn_legs[1].label == "1 X"  # T1 stands on the outside
    assert model_of(operator).restart_plan is not None


def test_loop_pass_is_selected_by_keys_and_by_touch(operator: Operator) -> None:
    desk = operator.stage.desk
    desk.program_choice.load_by_name("pin")
    desk.program_loader.wait_until_loaded(30.0)
    operator.drives_on()
    operator.key(Key.Key_F6)
    operator.key(Key.Key_Right)
    assert begins(operator.prompt(), "search.enter-first")
    operator.type("8P3")
    page = found(operator)
    assert (
        page.state_panel.content.title
        == f"{text('search.state-at-line', line=8)}, {text('search.pass', number=3, count=5)}"
    )
    loop = page.state_panel.content.state_rows[0]
    assert loop.label == text("search.pass-of-lines", first=6, last=12)
    assert (loop.required_value, loop.current_value) == ("3 OF 5", "—")
    rows = {row.label: row.required_value for row in page.state_panel.content.state_rows}
    assert rows["X Ø"] == "0.37500"  # .54 and .055 in, .02 out and .02 in again, in each pass
    operator.key(Key.Key_Right)
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    assert page_of(operator).state_panel.content.pass_text == text("search.pass", number=4, count=5)
    page.state_panel.grab()  # draws, so that a finger finds its place
    assert page.state_panel.press_target_at(
        QPointF(page.state_panel.width() * 0.1, page.state_panel.height() - 25)
    )
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    assert page_of(operator).state_panel.content.pass_text == text("search.pass", number=3, count=5)
    operator.key(Key.Key_Left, Key.Key_Left)
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    operator.key(Key.Key_Left, Key.Key_Left)
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    assert page_of(operator).state_panel.content.pass_text == text("search.pass", number=1, count=5)


def test_retract_alone_runs_after_confirmation_and_page_stays_open(operator: Operator) -> None:
    operator.stage.start()
    operator.until(lambda: operator.shot.line == 18, 120.0)
    operator.pause(0.2)
    estop_and_recover(operator)
    operator.key(Key.Key_F6, Key.Key_F4)
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    page = page_of(operator)
    assert operator.prompt() == text("search.look-at-way-out")
    assert [leg.label for leg in page.path_view.drawn_legs] == ["", "1 X", "2 Z", "3 Z"]
    assert page.functions_panel.functions_to_start == (text("search.only-slides"),)
    assert page.functions_panel.option_texts[0] == text("search.leaves-part", feed="20.00 in/min")
    operator.palms()
    assert operator.shot.state is MachineState.IDLE  # not before it is confirmed
    confirmed(operator)
    assert begins(operator.prompt(), "search.start-way-out", start=pattern("screen.both-palms"))
    operator.palms()
    assert operator.shot.state is MachineState.RUN
    assert operator.frame.title_line.page_title == page_table.SEARCHTO_PAGE
    operator.key(Key.Key_H)
    operator.reaches(MachineState.HOLD)
    operator.pause(0.4)
    assert begins(operator.prompt(), "screen.to-go-on", start=pattern("screen.both-palms"))
    operator.palms()
    operator.stage.tick(lambda: operator.shot.state is MachineState.IDLE, 60.0)
    operator.key(Key.Key_F4)  # before the screen has shown that it is out
    operator.pause(0.1)
    assert operator.shot.rpm_command == 0.0
    assert operator.shot.starts is StartAction.RESTART
    assert operator.shot.interrupted_line == 18
    model_of(operator).restart_finder.worker.wait_for_results(60.0)
    assert operator.prompt() == text("search.tool-is-clear", tool=1)


def test_interrupted_bore_is_finished_along_z(operator: Operator) -> None:
    operator.stage.start()
    operator.until(
        lambda: operator.shot.state is MachineState.PROGRAM_STOP or operator.shot.line == 38, 240.0
    )
    operator.pause(0.3)
    estop_and_recover(operator)
    operator.key(Key.Key_F6)
    page = found(operator)
    assert page.state_panel.content.title == text("search.state-at-line", line=38)
    # The bar stands on X.5 already: out along Z, and in again; within the bore at a feed.
    assert [leg.label for leg in page.path_view.drawn_legs] == ["", "1 Z", "2 Z", "3 Z"]
    assert [leg.is_rapid for leg in page.path_view.drawn_legs[1:]] == [False, True, True]
    confirmed(operator)
    x = operator.shot.demand[0]
    operator.palms()
    operator.until(lambda: operator.shot.line == 38 and operator.shot.rpm_actual > 2000, 30.0)
    assert operator.shot.demand[0] == pytest.approx(x, abs=0.01)
    operator.until(lambda: operator.shot.parts == 1, 240.0)


def test_stock_is_shown_as_it_is_at_selected_line(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    page = page_of(operator)
    player = page.path_view.part_player
    assert player is not None
    page.path_view.show_part()
    operator.type("9")
    found(operator)
    plan = model_of(operator).restart_plan
    assert plan is not None
    page_of(operator)
    player.wait_for_result(60.0)
    page_of(operator)
    player.wait_for_result(60.0)
    assert player.latest_result is not None
    assert player.latest_result.part_instant.block_count == plan.restart_point.checkpoint.blocks
    picture = operator.stage.desk.program_loader.loaded_program.picture
    assert picture is not None
    assert 0 < plan.restart_point.checkpoint.blocks < len(picture.line)
