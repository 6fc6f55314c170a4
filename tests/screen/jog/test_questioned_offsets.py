"""Offsets of the Jog page that are asked before they change: undo, suspicious touches, the master."""

from __future__ import annotations

import pytest

from core.store.store_rows import ToolOffsetRow
from tests.screen.jog.bench import INCH, JogBench, Key
from tests.texts import Pattern, shows, text


def given(jog: JogBench) -> None:
    """T1 and T2 are set, T2 was changed last, and T1 is chosen."""
    jog.store.offsets.tool_offsets.change_row(1, "set", {"x": -0.6 * INCH, "z": -50.0})
    jog.store.offsets.tool_offsets.change_row(1, "moved", {"x": -0.601 * INCH})
    jog.store.offsets.tool_offsets.change_row(2, "set", {"x": 3.0, "z": -40.0}).result(60)
    jog.desk.offset_book.read_store()
    jog.type("t")
    jog.enter("1")


@pytest.mark.parametrize("key", [Key.Key_N, Key.Key_Escape])
def test_undo_applies_to_selected_tool_and_no_leaves_its_offset(jog: JogBench, key: Key) -> None:
    given(jog)
    before = jog.store.offsets.tool_offsets.read_rows()
    jog.key(Key.Key_F4)
    jog.saved()
    change = "X −0.60100 → −0.60000"
    assert jog.prompt == text("offsets.undo", row="T1", change=change)
    assert jog.store.offsets.tool_offsets.read_rows() == before
    jog.key(key)
    jog.saved()
    assert jog.store.offsets.tool_offsets.read_rows() == before
    assert not jog.desk.confirmation_key
    assert jog.page.model.tool_setting.question_name == ""  # N did not open the nose radius
    jog.key(Key.Key_F4)
    jog.confirm()
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.6 * INCH)
    assert jog.store.offsets.tool_offsets.read_rows()[2] == before[2]


def test_f10_changes_no_offset(jog: JogBench) -> None:
    given(jog)
    before = jog.store.offsets.tool_offsets.read_rows()
    for _ in range(4):
        jog.key(Key.Key_F10)
        jog.saved()
    assert jog.store.offsets.tool_offsets.read_rows() == before
    assert not jog.desk.confirmation_key


def test_a_diameter_with_the_wrong_sign_is_questioned(jog: JogBench) -> None:
    given(jog)
    jog.type("x")
    jog.enter("-1.2")
    jog.saved()
    # The slide is at 0: the tip would be at Ø −1.2, so part zero at +.6; it was at −.601.
    change = f"T1 X R −0.60100 → +0.60000 ({text('offsets.doubt-side')})"
    assert jog.prompt == text("offsets.suspicious", changes=change)
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.601 * INCH)
    jog.key(Key.Key_N)
    jog.saved()
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.601 * INCH)


def test_a_touch_near_the_offset_in_use_is_saved_without_a_question(jog: JogBench) -> None:
    given(jog)
    jog.type("x")
    jog.enter("1.205")
    jog.saved()
    assert not jog.desk.confirmation_key
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.6025 * INCH)


def test_a_new_tool_that_touches_at_x_negative_is_questioned(jog: JogBench) -> None:
    jog.type("t")
    jog.enter("5")
    jog.type("x")
    jog.enter("-.5")
    jog.saved()
    change = f"T5 X R not set → +0.25000 ({text('offsets.doubt-side')})"
    assert jog.prompt == text("offsets.suspicious", changes=change)
    jog.confirm()
    assert jog.prompt == text("jog.touched-one-of-two", number=5, axis="Z")
    jog.type("z")
    jog.enter("0")
    jog.saved()
    assert not jog.desk.confirmation_key  # X was confirmed already
    assert jog.store.offsets.tool_offsets.read_rows()[5].x == pytest.approx(0.25 * INCH)


@pytest.mark.parametrize("key", [Key.Key_N, Key.Key_Escape])
def test_no_discards_only_the_suspicious_axis_of_a_new_tool(jog: JogBench, key: Key) -> None:
    jog.type("t")
    jog.enter("5")
    jog.type("x")
    jog.enter(".5")
    jog.type("z")
    jog.enter("40")  # part zero at Z -40 in, and the travel ends at -6 in
    jog.saved()
    assert shows(jog.prompt, "offsets.doubt-travel")
    jog.key(key)
    jog.saved()
    assert jog.store.offsets.tool_offsets.read_rows() == {}
    jog.type("z")
    jog.enter("0")
    jog.saved()
    assert jog.store.offsets.tool_offsets.read_rows()[5].x == pytest.approx(-0.25 * INCH)
    assert jog.store.offsets.tool_offsets.read_rows()[5].z == pytest.approx(0.0)


def test_a_touch_beyond_the_travel_is_questioned(jog: JogBench) -> None:
    given(jog)
    jog.type("z")
    jog.enter("40")
    jog.saved()
    assert shows(jog.prompt, "offsets.doubt-travel")
    assert jog.store.offsets.tool_offsets.read_rows()[1].z == -50.0


def test_change_of_master_asks_and_names_its_followers(jog: JogBench) -> None:
    given(jog)
    jog.store.offsets.tool_offsets.change_row(7, "set", {"x": 1.0, "z": 1.0}).result(60)
    jog.desk.offset_book.read_store()
    jog.type("m")
    jog.saved()
    assert jog.prompt == text(
        "offsets.master", before="none", tool="T1", others="T2, T7", limit="0.02", unit="IN"
    )
    assert not jog.store.offsets.tool_offsets.read_rows()[1].master
    jog.key(Key.Key_N)
    jog.saved()
    assert not jog.store.offsets.tool_offsets.read_rows()[1].master
    jog.type("m")
    jog.confirm()
    assert jog.store.offsets.tool_offsets.read_rows()[1].master


def test_n_at_large_master_touch_changes_no_offset(jog: JogBench) -> None:
    given(jog)
    jog.store.offsets.tool_offsets.set_master_tool(1, "master").result(60)
    jog.desk.offset_book.read_store()
    before = jog.store.offsets.tool_offsets.read_rows()
    jog.type("x")
    jog.enter("1.3")
    jog.saved()
    change = f"T1 X R −0.60100 → −0.65000 ({text('offsets.doubt-large')})"
    assert jog.prompt == text("offsets.suspicious-master", changes=change, others="T2")
    jog.key(Key.Key_N)
    jog.saved()
    assert jog.store.offsets.tool_offsets.read_rows() == before
    jog.type("x")
    jog.enter("1.3")
    jog.confirm()
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.65 * INCH)
    assert jog.store.offsets.tool_offsets.read_rows()[2].x == pytest.approx(3.0 - 0.049 * INCH)


def test_a_follower_that_would_leave_the_travel_is_named(jog: JogBench) -> None:
    given(jog)
    jog.store.offsets.tool_offsets.change_row(2, "set", {"x": -3.99 * INCH})
    jog.store.offsets.tool_offsets.set_master_tool(1, "master").result(60)
    jog.desk.offset_book.read_store()
    jog.type("x")
    jog.enter("1.23")
    jog.saved()
    change = f"T2 X R −3.99000 → −4.00400 ({text('offsets.doubt-travel')})"
    assert jog.prompt == text("offsets.suspicious-master", changes=change, others="T2")


def test_second_undo_names_older_change_of_same_tool(jog: JogBench) -> None:
    given(jog)
    jog.key(Key.Key_F4)
    jog.confirm()
    jog.key(Key.Key_F4)
    jog.saved()
    assert begins_with_undo(jog, "T1")
    jog.key(Key.Key_Escape)
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.6 * INCH)
    assert 2 in jog.store.offsets.tool_offsets.read_rows()


def begins_with_undo(jog: JogBench, tool: str) -> bool:
    """Return whether the undo of this tool is asked."""
    return shows(jog.prompt, "offsets.undo", row=tool, change=Pattern(".*"))


def test_answer_about_offset_changed_meanwhile_does_nothing(jog: JogBench) -> None:
    given(jog)
    jog.type("x")
    jog.enter("-1.2")
    jog.saved()
    jog.store.offsets.tool_offsets.change_row(1, "elsewhere", {"x": -10.0}).result(60)
    jog.desk.offset_book.read_store()
    jog.confirm()
    assert jog.prompt == text("offsets.changed-meanwhile")
    assert jog.store.offsets.tool_offsets.read_rows()[1] == ToolOffsetRow(-10.0, -50.0)
