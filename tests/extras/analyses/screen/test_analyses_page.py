"""The page ANALYSES by keys."""

from __future__ import annotations

from app.extras.analyses.analyses_view import AnalysesPage
from app.screen import page_table
from tests.screen.hands import Hands, Key
from tests.screen.test_scope import desk, frozen, played
from tests.texts import shows, text

__all__ = ["desk", "played"]


def test_f8_opens_the_analyses_page(hands: Hands) -> None:
    frozen(hands)
    hands.key(Key.Key_F8)
    page = hands.frame.current_page
    assert isinstance(page, AnalysesPage)
    hands.sees(lambda: page.drawing.chart is not None and bool(page.drawing.chart.drawing.upper_curves))
    found = page.analyses.result
    assert found is not None
    assert found.worst_deviations
    before = page.analyses.magnification
    hands.key(Key.Key_Z)
    assert page.analyses.magnification > before
    hands.key(Key.Key_F3)
    hands.sees(lambda: shows(page.description.description_text, "scope.passes-by-angle"))
    hands.sees(lambda: page.drawing.chart is not None and len(page.drawing.chart.plots) == 2)
    hands.key(Key.Key_F4)
    hands.sees(lambda: text("scope.no-arc") in page.description.description_text)
    hands.sees(lambda: page.drawing.chart is not None and not page.drawing.chart.drawing.upper_curves)
    hands.key(Key.Key_F8)
    assert hands.frame.current_page.NAME == page_table.SCOPE
