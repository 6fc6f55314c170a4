"""The page ANALYSES by keys."""

from __future__ import annotations

from app.extras.analyses.analyses_view import AnalysesPage
from app.screen import page_table
from tests.screen.hands import Hands, Key
from tests.screen.test_scope import desk, frozen, played
from tests.texts import shows, text

__all__ = ["desk", "played"]


def test_the_analyses_stand_behind_f8(hands: Hands) -> None:
    frozen(hands)
    hands.key(Key.Key_F8)
    page = hands.frame.page
    assert isinstance(page, AnalysesPage)
    hands.sees(lambda: page.drawing.chart is not None and bool(page.drawing.chart.drawing.curves))
    found = page.analyses.found
    assert found is not None
    assert found.worst
    before = page.analyses.magnified
    hands.key(Key.Key_Z)
    assert page.analyses.magnified > before
    hands.key(Key.Key_F3)
    hands.sees(lambda: shows(page.above.words, "scope.passes-by-angle"))
    hands.sees(lambda: page.drawing.chart is not None and len(page.drawing.chart.plots) == 2)
    hands.key(Key.Key_F4)
    hands.sees(lambda: text("scope.no-arc") in page.above.words)
    hands.sees(lambda: page.drawing.chart is not None and not page.drawing.chart.drawing.curves)
    hands.key(Key.Key_F8)
    assert hands.frame.page.NAME == page_table.SCOPE
