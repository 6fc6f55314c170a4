"""Calculators and templates in SINUMERIK: figures by closed formulas, lines that the proof finds good."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.extras.shapes.shapes_model import ShapesModel
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from core.language.source import Dialect
from tests.extras.shapes.test_sinumerik_shapes import NEAR, metal, strike
from tests.texts import begins

SHOP = ShopData(max_acceleration_mm_s2=3048.0, chuck_codes=(69, 68))
HEAD = "G54 G18 G90 G95 G710 DIAMON\n"


def written(keys: str, text: str = "", name: str = "x.mpf", shop: ShopData = SHOP) -> tuple[str, str]:
    """The text with what one calculator or template writes before its end; and what is told instead."""
    shapes = ShapesModel(lambda: shop, ProgramSettings(metric=True), shop_data=shop)
    assert shapes.open_program_text(name, text, max(1, len(text.splitlines())), lists_helpers=True) == ""
    shapes.worker.wait_for_results(60.0)
    strike(shapes, keys)
    said = "" if shapes.form is None else shapes.prompt_text()
    shapes.close()
    return shapes.text, said


def lines_of(keys: str, text: str = HEAD) -> list[str]:
    """What one of them writes behind a head."""
    found, said = written(keys, text)
    assert not said
    return found.removeprefix(text).removesuffix("M30\n").splitlines()


def test_taper_is_written_as_sinumerik_points() -> None:
    assert lines_of("t10⏎20⏎12§") == ["X10 Z0", "X20 Z-12"]


def test_feed_and_speed_are_written_on_one_line() -> None:
    """150 m/min at 30 mm are 1591 rpm; .1 a turn."""
    assert lines_of("f30⏎150⏎⏎.1§") == ["G95 S1591 M3 F0.1"]


def test_thread_passes_are_written_as_a_cycle() -> None:
    """M10 6g: major from 9.732 to 9.968, pitch 8.928 in the middle, root H/6 before the sharp V: 7.846."""
    (line,) = lines_of("r↑m⏎10⏎⏎⏎⏎⏎⏎20⏎9§")
    words = [float(word or 0) for word in line.removeprefix("CYCLE97(").removesuffix(")").split(", ")]
    lead, _, begin, end, first, last, run_up, out, deep, _, angle, _, passes, _, kind, starts = words
    assert (lead, begin, end, out, angle, passes, kind, starts) == (1.5, 0, -20, 0, 29, 9, 3, 1)
    assert first == last == pytest.approx(9.85, abs=0.002)
    root = 8.928 - 1.5 * math.sqrt(3) / 2 * (1 - 1 / 3)
    assert deep == pytest.approx((9.85 - root) / 2, abs=0.003)
    assert run_up == 3 * 1.5 + 2.5


def program(*keys: str, name: str = "x.mpf") -> list[str]:
    text = ""
    for each in keys:
        text, said = written(each, text.replace("M30\n", ""), name)
        assert not said
    return text.splitlines()


def test_roughing_template_removes_the_same_stock_as_in_omniturn() -> None:
    keys = ("n§", "c⏎⏎30§", "g30§")
    ours, theirs = program(*keys), program(*keys, name="x.nc")
    assert 'CYCLE95("CONTOUR_1:CONTOUR_1_END", 0.5, , , 0.25, 0.102, 0.102, , 1)' in ours
    assert theirs[1:3] == ["M08", "T1"]  # no way of a tool that is not there yet
    mine, said = metal(ours, Dialect.SINUMERIK)
    there, _ = metal(theirs, Dialect.OMNITURN)
    assert not said
    finished = there.copy()
    finished[0] -= 0.25 * ((there[0] > 7.0) & (there[0] < 14.0))  # the contour itself, which G75 leaves
    assert np.quantile(np.abs(mine - finished), 0.9) <= NEAR


def test_thread_template_proves_without_errors() -> None:
    text = program("n§", "c⏎⏎30§", "d⏎⏎30§")
    assert "CYCLE97(1.5, , 0, -12, 30, 30, 7, 0, 0.9201, 0, 29, 0, 8, 0, 3, 1)" in text  # .6134 x 1.5
    _, said = metal(text, Dialect.SINUMERIK)
    assert not said


def test_tool_change_position_is_the_same_in_mm_and_inches() -> None:
    """Without the comment of a head nobody has said where."""
    assert "G00Z25" in program("n§", "c⏎⏎30§", "c⏎⏎30§", name="x.nc")
    assert "G0 Z25" in program("n§", "c⏎⏎30§", "c⏎⏎30§")


def test_bar_loop_uses_the_chuck_codes() -> None:
    text = program("n§", "b5⏎3⏎22§")
    assert text[text.index("T3 D1") - 1] == "BAR_1:"
    assert [line for line in text if line in {"M69", "M68", "REPEAT BAR_1 BAR_1_END P=4"}] == [
        "M69",
        "M68",
        "REPEAT BAR_1 BAR_1_END P=4",
    ]
    assert text[-2:] == ["%_N_PART_1_SPF", "M17"]


def test_bar_loop_without_chuck_codes_is_rejected() -> None:
    _, said = written("b5⏎3⏎22§", HEAD, shop=replace(SHOP, chuck_codes=None))
    assert begins(said, "shapes.no-chuck-codes")
