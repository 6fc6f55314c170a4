"""SEARCHTO by keys alone: from an E-stop in the middle of a part to the finished part."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtTest import QTest

from app.desk.status.prompt_line import HOW_TO_HOLD
from app.screen import page_table
from app.screen.panel import Panel
from app.screen.window_layout import FINGER
from app.searchto.searchto_model import SearchtoModel, SearchtoStage
from app.searchto.searchto_view import SearchtoPage
from core.executor.snapshot import Starts, State
from tests.attached import attached
from tests.screen.lathe import Key, Operator
from tests.screen.yes import twist_out
from tests.texts import begins, pattern, text


def model_of(operator: Operator) -> SearchtoModel:
    return attached(operator.stage.desk, SearchtoModel)


def page_of(operator: Operator) -> SearchtoPage:
    operator.window.refresh()
    page = operator.frame.page
    assert isinstance(page, SearchtoPage)
    return page


def loaded(operator: Operator) -> None:
    """The sample program on the desk, proved; drives on."""
    desk = operator.stage.desk
    desk.programs.choose("bushing")
    desk.session.settled(30.0)
    operator.drives_on()


def estop_and_recover(operator: Operator) -> None:
    operator.key(Key.Key_E)
    operator.reaches(State.ESTOP)
    twist_out(operator.window)
    operator.reaches(State.DISABLED)
    operator.key(Key.Key_D)
    operator.reaches(State.IDLE)


def found(operator: Operator) -> SearchtoPage:
    """Enter, and wait for the worker."""
    operator.key(Key.Key_Return)
    model_of(operator).finder.worker.settle(60.0)
    operator.pause(0.05)
    return page_of(operator)


def confirmed(operator: Operator) -> None:
    operator.key(Key.Key_F10)
    model_of(operator).finder.worker.settle(60.0)
    operator.pause(0.05)
    assert model_of(operator).stage is SearchtoStage.READY


def test_after_an_estop_the_part_is_finished_from_the_line_that_was_running(operator: Operator) -> None:
    operator.stage.start()
    operator.until(lambda: operator.shot.line == 18, 120.0)
    operator.pause(0.2)
    estop_and_recover(operator)
    operator.key(Key.Key_F6)
    assert operator.frame.title.page == page_table.SEARCHTO
    assert begins(operator.prompt(), "search.broke-off", line=18)
    page = found(operator)
    assert page.state.shown.title == text("search.state-at-line", line=18)
    assert page.starts.starts == ("SPINDLE FORWARD G97 1800 RPM", "COOLANT")
    assert [leg.label for leg in page.path.legs] == ["", "1 X", "2 Z", "3 Z", "4 X", "5 Z"]
    assert [leg.rapid for leg in page.path.legs[1:]] == [False, False, True, True, True]
    assert operator.shot.rpm_command == 0.0
    assert "coolant" not in operator.shot.outputs  # nothing starts before it is confirmed and started
    confirmed(operator)
    assert begins(operator.prompt(), "search.start-restart", start=pattern("screen.both-palms"))
    operator.palms()
    operator.window.refresh()
    assert operator.frame.page is operator.frame.automatic
    assert operator.shot.state in {State.RUN, State.WAIT}
    operator.pause(0.1)
    assert operator.prompt() == HOW_TO_HOLD  # nothing was refused on the way
    operator.until(lambda: operator.shot.line == 26, 60.0)
    assert operator.shot.modal.diameter
    assert operator.shot.modal.secondary == 1
    operator.until(lambda: operator.shot.parts == 1, 240.0)


def test_every_difference_is_marked_by_its_sign(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    page = found(operator)
    rows = {row.label: row for row in page.state.shown.rows}
    assert (rows["X VALUES"].wanted, rows["X VALUES"].now) == ("G72 Ø", "G73 R")
    assert (rows["SPINDLE"].wanted, rows["SPINDLE"].now) == ("M03", "M05")
    assert (rows[text("search.first-feed")].wanted, rows["FEED"].wanted) == ("300.00", "0.00600 in/rev")
    assert rows["COOLANT"].differs
    assert not rows["UNITS"].differs
    assert page.state.grab().width() > 0


def test_a_line_is_found_by_its_text_and_the_list_follows(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("(FINISH")
    operator.key(Key.Key_Return)
    assert model_of(operator).cursor.line == 22
    operator.key(Key.Key_Escape)
    operator.type("x.5")
    operator.key(Key.Key_F2)
    assert model_of(operator).cursor.line == 37
    operator.key(Key.Key_F3)
    assert model_of(operator).cursor.line == 22
    operator.key(Key.Key_Escape)
    operator.type("QQ")
    operator.key(Key.Key_Return)
    assert operator.prompt() == text("search.in-no-line", what="QQ")


def press(panel: Panel, box: QRectF) -> None:
    QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=box.center().toPoint())


def test_a_finger_marks_a_line_or_types_its_number(operator: Operator) -> None:
    """The lines were no target, and nothing brought figures: a finger had F8 and F9 alone."""
    loaded(operator)
    operator.window.resize(1024, 600)
    operator.key(Key.Key_F6)
    page = page_of(operator)
    page.listing.grab()
    assert all(box.height() >= FINGER for box, *_ in page.listing._places)
    press(page.listing, page.listing._places[3][0])
    assert model_of(operator).cursor.line == page.listing.top + 4
    page.asked.grab()
    entry, *_ = page.asked._places[0]
    assert entry.height() >= FINGER
    press(page.asked, entry)
    assert page.pad.isVisible()
    page.pad.grab()
    keys = dict(zip("789/456*123-0.(+", page.pad._places, strict=False))
    for figure in "12":
        box, *_ = keys[figure]
        assert min(box.width(), box.height()) >= FINGER
        press(page.pad, box)
    press(page.pad, page.pad._places[-1][0])  # RETURN
    assert model_of(operator).cursor.line == 12
    assert page.pad.isHidden()
    model_of(operator).finder.worker.settle(60.0)
    page_of(operator)
    page.listing.grab()
    place = 12 - page.listing.top - 1
    press(page.listing, page.listing._places[place][0])  # on the marked one: its state again
    model_of(operator).finder.worker.settle(60.0)
    page_of(operator)
    assert model_of(operator).answer is not None or model_of(operator).plan is not None


def test_a_line_that_is_not_good_offers_its_neighbours(operator: Operator) -> None:
    desk = operator.stage.desk
    desk.programs.choose("pin")
    desk.session.settled(30.0)
    operator.drives_on()
    operator.key(Key.Key_F6)
    operator.type("8P9")
    page = found(operator)
    assert page.state.shown.why == text("search.no-such-pass", line=8, count=5, wanted=9)
    before, after = page.state.shown.near
    assert (before.key, after.key) == ("F8", "F9")
    operator.key(Key.Key_F10)
    assert operator.prompt() == text("search.good-line-first")
    operator.key(Key.Key_F9)
    model_of(operator).finder.worker.settle(60.0)
    assert page_of(operator).state.shown.title == text("search.state-at-line", line=after.line)


def test_the_palms_start_nothing_before_it_is_confirmed(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.palms()
    assert begins(operator.prompt(), "screen.search-first")
    operator.type("7")
    found(operator)
    operator.palms()
    assert operator.shot.state is State.IDLE
    assert operator.shot.starts is Starts.RESTART


def test_leaving_the_page_takes_a_ready_restart_back(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    confirmed(operator)
    operator.key(Key.Key_F1, Key.Key_F2)
    operator.pause(0.05)
    assert operator.shot.starts is Starts.PROGRAM
    assert operator.shot.prepared == ""


def test_coolant_and_the_way_are_the_operators_choice(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("38")
    page = found(operator)
    assert page.starts.starts[-1] == "COOLANT"
    assert page.starts.choices == (text("search.with-coolant"),)
    operator.key(Key.Key_F5)
    page = page_of(operator)
    assert page.starts.starts == ("SPINDLE FORWARD G97 2200 RPM",)
    assert page.starts.choices == (text("search.without-coolant"),)
    assert page.starts.trouble == ""
    confirmed(operator)
    operator.key(Key.Key_F5)  # another start is not the one that was proved
    assert model_of(operator).stage is SearchtoStage.SHOWN
    assert operator.shot.prepared != ""
    operator.pause(0.05)
    assert operator.shot.prepared == ""


def test_the_collet_must_be_as_the_line_has_it(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F1, Key.Key_F4)
    operator.pause(0.05)
    operator.run("M13")
    operator.key(Key.Key_F2, Key.Key_F6)
    operator.type("7")
    page = found(operator)
    assert begins(page.starts.trouble, "search.collet-open")
    operator.key(Key.Key_F10)
    assert begins(operator.prompt(), "search.collet-open")
    assert model_of(operator).stage is SearchtoStage.SHOWN


def test_searchto_does_not_open_without_a_program_nor_while_one_runs(operator: Operator) -> None:
    operator.key(Key.Key_F6)
    assert operator.frame.page is operator.frame.automatic
    assert operator.prompt() == text("screen.choose-program")
    operator.stage.start()
    operator.key(Key.Key_F6)
    assert begins(operator.prompt(), "screen.program-runs-no-search")


def test_with_the_drives_off_nothing_is_confirmed(operator: Operator) -> None:
    desk = operator.stage.desk
    desk.programs.choose("bushing")
    desk.session.settled(30.0)
    operator.until(lambda: operator.shot.state is State.DISABLED)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    operator.key(Key.Key_F10)
    assert operator.prompt() == text("screen.drives-off-for-search")


def test_a_program_that_is_read_anew_is_searched_anew(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    confirmed(operator)
    desk = operator.stage.desk
    path = desk.session.now.path
    assert path is not None
    desk.session.load(path)
    desk.session.settled(30.0)
    operator.pause(0.1)
    page_of(operator)
    assert model_of(operator).stage is SearchtoStage.CHOOSE
    operator.palms()
    assert operator.shot.state is State.IDLE


def test_the_question_has_every_letter(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("eh x")
    assert page_of(operator).asked.text == "eh x"
    assert operator.shot.state is State.IDLE


def test_escape_goes_back_step_by_step(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    operator.type("7")
    found(operator)
    operator.key(Key.Key_Escape)
    assert model_of(operator).stage is SearchtoStage.CHOOSE
    operator.key(Key.Key_Escape)
    assert operator.frame.page is operator.frame.automatic


def test_another_tool_at_the_part_leaves_it_by_its_own_way_and_what_is_left_out_is_told(
    operator: Operator,
) -> None:
    operator.stage.start()
    operator.until(lambda: operator.shot.line == 18, 120.0)
    operator.pause(0.2)
    estop_and_recover(operator)
    operator.key(Key.Key_F6)
    operator.type("41")
    page = found(operator)
    assert begins(page.starts.trouble, "search.left-out", first=18, last=39)
    assert page.path.legs[1].label == "1 X"  # T1 stands on the outside
    assert model_of(operator).plan is not None


def test_the_pass_of_a_loop_is_chosen_by_keys_and_by_fingers(operator: Operator) -> None:
    desk = operator.stage.desk
    desk.programs.choose("pin")
    desk.session.settled(30.0)
    operator.drives_on()
    operator.key(Key.Key_F6)
    operator.key(Key.Key_Right)
    assert begins(operator.prompt(), "search.enter-first")
    operator.type("8P3")
    page = found(operator)
    assert (
        page.state.shown.title
        == f"{text('search.state-at-line', line=8)}, {text('search.pass', number=3, count=5)}"
    )
    loop = page.state.shown.rows[0]
    assert loop.label == text("search.pass-of-lines", first=6, last=12)
    assert (loop.wanted, loop.now) == ("3 OF 5", "—")
    rows = {row.label: row.wanted for row in page.state.shown.rows}
    assert rows["X Ø"] == "0.37500"  # .54 and .055 in, .02 out and .02 in again, in each pass
    operator.key(Key.Key_Right)
    model_of(operator).finder.worker.settle(60.0)
    assert page_of(operator).state.shown.passes == text("search.pass", number=4, count=5)
    page.state.grab()  # draws, so that a finger finds its place
    assert page.state.touch(QPointF(page.state.width() * 0.1, page.state.height() - 25))
    model_of(operator).finder.worker.settle(60.0)
    assert page_of(operator).state.shown.passes == text("search.pass", number=3, count=5)
    operator.key(Key.Key_Left, Key.Key_Left)
    model_of(operator).finder.worker.settle(60.0)
    operator.key(Key.Key_Left, Key.Key_Left)
    model_of(operator).finder.worker.settle(60.0)
    assert page_of(operator).state.shown.passes == text("search.pass", number=1, count=5)


def test_only_the_way_out_is_taken_and_the_page_stays(operator: Operator) -> None:
    operator.stage.start()
    operator.until(lambda: operator.shot.line == 18, 120.0)
    operator.pause(0.2)
    estop_and_recover(operator)
    operator.key(Key.Key_F6, Key.Key_F4)
    model_of(operator).finder.worker.settle(60.0)
    page = page_of(operator)
    assert operator.prompt() == text("search.look-at-way-out")
    assert [leg.label for leg in page.path.legs] == ["", "1 X", "2 Z", "3 Z"]
    assert page.starts.starts == (text("search.only-slides"),)
    assert page.starts.choices[0] == text("search.leaves-part", feed="20.00 in/min")
    operator.palms()
    assert operator.shot.state is State.IDLE  # not before it is confirmed
    confirmed(operator)
    assert begins(operator.prompt(), "search.start-way-out", start=pattern("screen.both-palms"))
    operator.palms()
    assert operator.shot.state is State.RUN
    assert operator.frame.title.page == page_table.SEARCHTO
    operator.key(Key.Key_H)
    operator.reaches(State.HOLD)
    operator.pause(0.4)
    assert begins(operator.prompt(), "screen.to-go-on", start=pattern("screen.both-palms"))
    operator.palms()
    operator.stage.tick(lambda: operator.shot.state is State.IDLE, 60.0)
    operator.key(Key.Key_F4)  # before the screen has shown that it is out
    operator.pause(0.1)
    assert operator.shot.rpm_command == 0.0
    assert operator.shot.starts is Starts.RESTART
    assert operator.shot.interrupted_line == 18
    model_of(operator).finder.worker.settle(60.0)
    assert operator.prompt() == text("search.tool-is-clear", tool=1)


def test_a_bore_that_broke_off_is_finished_along_z(operator: Operator) -> None:
    operator.stage.start()
    operator.until(lambda: operator.shot.state is State.PROGRAM_STOP or operator.shot.line == 38, 240.0)
    operator.pause(0.3)
    estop_and_recover(operator)
    operator.key(Key.Key_F6)
    page = found(operator)
    assert page.state.shown.title == text("search.state-at-line", line=38)
    # The bar stands on X.5 already: out along Z, and in again; within the bore at a feed.
    assert [leg.label for leg in page.path.legs] == ["", "1 Z", "2 Z", "3 Z"]
    assert [leg.rapid for leg in page.path.legs[1:]] == [False, True, True]
    confirmed(operator)
    x = operator.shot.demand[0]
    operator.palms()
    operator.until(lambda: operator.shot.line == 38 and operator.shot.rpm_actual > 2000, 30.0)
    assert operator.shot.demand[0] == pytest.approx(x, abs=0.01)
    operator.until(lambda: operator.shot.parts == 1, 240.0)


def test_the_stock_is_shown_as_the_line_finds_it(operator: Operator) -> None:
    loaded(operator)
    operator.key(Key.Key_F6)
    page = page_of(operator)
    player = page.path.player
    assert player is not None
    page.path.show_part()
    operator.type("9")
    found(operator)
    plan = model_of(operator).plan
    assert plan is not None
    page_of(operator)
    player.settle(60.0)
    page_of(operator)
    player.settle(60.0)
    assert player.played is not None
    assert player.played.instant.block == plan.found.checkpoint.blocks
    picture = operator.stage.desk.session.now.picture
    assert picture is not None
    assert 0 < plan.found.checkpoint.blocks < len(picture.line)
