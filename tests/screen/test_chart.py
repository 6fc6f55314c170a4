"""Charts: they draw, in colours and font of the desk, and take nothing that a hand does."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.screen.chart import Chart, find_curve_color, make_line_pen, set_curve_points
from app.screen.color_palettes import CURVE_COLORS, DARK_PALETTE, LIGHT_PALETTE
from app.screen.screen_theme import ScreenTheme


@pytest.fixture
def parent(qtbot: QtBot) -> QWidget:
    widget = QWidget()
    widget.resize(640, 400)
    qtbot.addWidget(widget)
    return widget


def chart_of(parent: QWidget, look: ScreenTheme | None = None) -> Chart:
    chart = Chart(look or ScreenTheme(DARK_PALETTE), parent)
    chart.resize(parent.size())
    return chart


def test_pyqtgraph_is_not_imported_at_the_start() -> None:
    code = (
        "import sys; import app.screen.screen_startup, app.compose.screen_desk, "
        "app.screen.window.main_window;"
        "from app.screen.page_table import ALL_PAGES; sys.exit('pyqtgraph' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_curve_is_drawn_in_its_color(parent: QWidget) -> None:
    chart = chart_of(parent)
    plot = chart.add_plot()
    plot.vb.setXRange(0.0, 10.0, padding=0)
    plot.vb.setYRange(-1.0, 1.0, padding=0)
    curve = plot.add_curve(make_line_pen(find_curve_color(chart.theme, 1)))
    set_curve_points(curve, np.array([0.0, 10.0]), np.array([0.43, 0.43]))
    parent.show()
    image = chart.grab().toImage()
    room = plot.find_curve_area()
    x, y = round(room.center().x()), round(room.y() + 0.285 * room.height())
    column = {image.pixelColor(x, y + d).name() for d in range(-2, 3)}
    assert CURVE_COLORS["dark"][1] in column
    assert CURVE_COLORS["dark"][0] not in column


def test_position_is_converted_to_axis_units(parent: QWidget) -> None:
    chart = chart_of(parent)
    plot = chart.add_plot()
    plot.vb.setXRange(2.0, 6.0, padding=0)
    plot.vb.setYRange(-10.0, 10.0, padding=0)
    parent.show()
    chart.grab()
    room = plot.find_curve_area()
    x, y = plot.map_to_axis_values(QPointF(room.x() + 0.75 * room.width(), room.y() + 0.25 * room.height()))
    assert x == pytest.approx(5.0)
    assert y == pytest.approx(5.0)


def test_chart_colors_follow_theme(parent: QWidget) -> None:
    look = ScreenTheme(DARK_PALETTE)
    chart = chart_of(parent, look)
    chart.add_plot()
    look.set_palette(LIGHT_PALETTE)
    chart.apply_theme()
    parent.show()
    assert chart.grab().toImage().pixelColor(1, 1) == QColor(LIGHT_PALETTE.panel)


def test_wheel_and_touch_events_pass_through_chart(parent: QWidget) -> None:
    chart = chart_of(parent)
    plot = chart.add_plot()
    parent.show()
    before = plot.vb.viewRange()
    assert parent.childAt(200, 200) is None
    QTest.mouseClick(parent, Qt.MouseButton.RightButton, pos=parent.rect().center())
    assert plot.vb.viewRange() == before
    assert chart.focusPolicy() is Qt.FocusPolicy.NoFocus


@pytest.mark.parametrize(
    ("value", "spacing", "text"), [(-0.002, 0.001, "−0.002"), (0.0, 0.5, "0.0"), (-1e-17, 1.0, "0")]
)
def test_axis_tick_labels_are_formatted(parent: QWidget, value: float, spacing: float, text: str) -> None:
    axis = chart_of(parent).add_plot().find_axis("left")
    assert axis.tickStrings([value], 1.0, spacing) == [text]


def test_reused_plot_is_reset(parent: QWidget) -> None:
    chart = chart_of(parent)
    plot = chart.add_plot()
    set_curve_points(plot.add_curve(make_line_pen(QColor("red"))), np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    plot.vb.invertY(True)
    plot.find_axis("left").setLabel("parts")
    plot.find_axis("bottom").hide()
    chart.remove_plots()
    assert chart.plots == []
    again = chart.add_plot()
    assert again is plot
    assert again.vb.addedItems == []
    assert not again.vb.yInverted()
    assert again.find_axis("left").labelText == ""
    assert again.find_axis("bottom").isVisible()


def test_one_plot_is_created_per_call(parent: QWidget) -> None:
    chart = chart_of(parent)
    assert [chart.prepare_plots(2) for _ in range(3)] == [False, False, True]
    chart.add_plot()
    chart.add_plot()
    assert chart.prepare_plots(2)
    assert not chart.prepare_plots(3)
