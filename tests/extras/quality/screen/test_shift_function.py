"""The shift report in F10."""

from __future__ import annotations

import pytest

from app.compose.runs.journal import Journal
from app.desk.data_folder import find_data_folder
from app.desk.desk import Desk
from app.special.special_view import SpecialFunctionsPage
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key
from tests.texts import begins, shows
from tests.texts import text as wording


@pytest.fixture
def desk(machine: FakeMachine, journal: Journal) -> Desk:
    return desk_on(machine, keep=journal)


def cells(page: SpecialFunctionsPage, row: int) -> tuple[str, ...]:
    return page.table_panel.table.rows[row].cells


def test_shift_report_is_created_and_saved(hands: Hands) -> None:
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    page._enter([each.name for each in page.model.functions].index("SHIFT REPORT"))
    hands.sees(lambda: bool(page.table_panel.table.rows) and cells(page, 0) == ("Parts", "0"))
    hands.key(Key.Key_F3)
    assert hands.prompt() == wording("screen.no-later-shift")
    hands.key(Key.Key_F2)
    hands.sees(
        lambda: begins(
            page.model.shown_function.make_table(hands.desk.read_snapshot()).notes[-1], "screen.no-part-begun"
        )
    )
    hands.key(Key.Key_F6)
    hands.sees(lambda: bool(page.table_panel.table.rows) and cells(page, -1)[0] == "THIS CONTROL")
    hands.key(Key.Key_Up)
    for _ in page.table_panel.table.rows:
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    hands.sees(lambda: shows(hands.prompt(), "screen.file-is-whole"))
    (written,) = (find_data_folder() / "sheets").glob("shift-*.html")
    assert wording("screen.no-part-begun") in written.read_text()
