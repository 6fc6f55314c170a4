"""A tool is touched off at the tool setter by a key that is held, and buttons beside the slides jog."""

from __future__ import annotations

import pytest

from core.executor.snapshot import MachineState
from core.store.store_rows import OffsetKind, ToolOffsetRow
from drivers.simulators.plant_controls import PlantControls
from tests.screen.jog.bench import INCH, SHIFT, JogBench, Key
from tests.texts import Pattern, begins, shows, text

ABOVE = (1.0, -0.6)  # in: machine X and Z from which X- finds it
BESIDE = (0.65, -0.2)  # and from which Z- does
TIP = (0.15, -1.6)


def hands(bench: JogBench) -> PlantControls:
    assert isinstance(bench.desk.station_controls.station, PlantControls)
    return bench.desk.station_controls.station


def put(bench: JogBench, place: tuple[float, float]) -> None:
    """The slides stand there: somebody has pushed them while the drives were off."""
    hands(bench)._plant.set_drive_power(False)
    for axis, inches in zip("XZ", place, strict=True):
        here = bench.shot.actual["XZ".index(axis)]
        hands(bench).push(axis, inches * INCH - here)
    hands(bench)._plant.set_drive_power(True)
    bench.run(0.1)


def given(bench: JogBench, number: int, row: ToolOffsetRow) -> None:
    """The table has this tool already."""
    values = row._asdict()
    values.pop("master")
    bench.desk.offset_book.change_fields(OffsetKind.TOOL, number, values, "typed")
    bench.saved()


def choose(bench: JogBench, number: int) -> None:
    bench.key(Key.Key_T)
    bench.enter(str(number))
    bench.run(0.05)


def hold(bench: JogBench, key: Key, seconds: float = 20.0) -> None:
    """Until it is back, or nothing comes of it."""
    bench.down(key)
    bench.run(0.1)
    bench.until(lambda: bench.shot.state is MachineState.IDLE, seconds)
    bench.up(key)
    bench.run(0.1)


def test_new_tool_is_set_by_two_setter_touches_and_return(setter: JogBench) -> None:
    choose(setter, 3)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    assert shows(setter.prompt, "jog.at-setter", number=3, keys=Pattern(r"↑ \(X−\).*"))
    hold(setter, Key.Key_Up)
    assert shows(setter.prompt, "jog.return-keeps-found")
    words = setter.page.entry_panel.entry_texts
    assert "not set  →  +0.1" in words.change_description
    assert begins(words.text, "jog.reason-setter", way="X−")
    setter.key(Key.Key_Return)
    put(setter, BESIDE)
    setter.key(Key.Key_P)
    hold(setter, Key.Key_Left)
    setter.key(Key.Key_Return)
    setter.saved()
    row = setter.desk.offset_book.tool_offsets[3]
    assert (row.x, row.z) == pytest.approx((TIP[0] * INCH, TIP[1] * INCH), abs=0.002)
    assert shows(setter.desk.offset_book.read_history(OffsetKind.TOOL)[0].why, "jog.reason-setter", way="Z−")


def test_setter_shows_difference_and_asks_once_if_it_is_large(setter: JogBench) -> None:
    given(setter, 2, ToolOffsetRow(x=0.14 * INCH, z=-1.6 * INCH, quadrant=3))
    choose(setter, 2)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    hold(setter, Key.Key_Up)
    words = setter.page.entry_panel.entry_texts
    assert "DIFFERENCE +0.0" in words.change_description
    assert not setter.desk.confirmation_key
    setter.key(Key.Key_Escape)
    setter.saved()
    assert setter.desk.offset_book.tool_offsets[2].x == pytest.approx(0.14 * INCH)  # nothing was kept
    given(setter, 2, ToolOffsetRow(x=0.11 * INCH, z=-1.6 * INCH, quadrant=3))
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    hold(setter, Key.Key_Up)
    assert shows(setter.prompt, "offsets.suspicious", changes=Pattern(r"T2 X R \+0\.11000 → \+0\.1[45].*"))
    assert not setter.page.model.is_entry_open  # Return is no second question
    setter.key(Key.Key_Return)
    setter.saved()
    assert setter.desk.offset_book.tool_offsets[2].x == pytest.approx(0.11 * INCH)
    setter.confirm()
    assert setter.desk.offset_book.tool_offsets[2].x == pytest.approx(TIP[0] * INCH, abs=0.002)


def test_typed_value_does_not_change_measured_values(setter: JogBench) -> None:
    given(setter, 2, ToolOffsetRow(x=0.14 * INCH, z=-1.6 * INCH, quadrant=3))
    choose(setter, 2)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    hold(setter, Key.Key_Up)
    before = setter.page.entry_panel.entry_texts.change_description
    setter.type("12")
    setter.run(0.05)
    assert setter.page.entry_panel.entry_texts.change_description == before


def test_early_release_measures_nothing_and_next_press_starts_over(setter: JogBench) -> None:
    choose(setter, 3)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    setter.down(Key.Key_Up)
    setter.run(0.3)
    setter.up(Key.Key_Up)
    setter.until(lambda: setter.shot.state is MachineState.IDLE)
    assert shows(setter.prompt, "jog.not-touched-off")
    assert setter.page.model.tool_setting.question_name == ""
    hold(setter, Key.Key_Up)
    assert shows(setter.prompt, "jog.return-keeps-found")


def test_another_key_or_page_ends_setter_touch(setter: JogBench) -> None:
    choose(setter, 3)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    setter.down(Key.Key_Up)
    setter.run(0.3)
    setter.key(Key.Key_F3)
    setter.until(lambda: setter.shot.state is MachineState.IDLE)
    assert setter.page.model.tool_setting.question_name == ""
    setter.up(Key.Key_Up)
    assert setter.page.model.tool_setter_touch_off.is_armed
    setter.key(Key.Key_F8)
    setter.run(0.05)
    setter.key(Key.Key_F1)
    setter.key(Key.Key_F5)
    setter.run(0.05)
    assert not setter.page.model.tool_setter_touch_off.is_armed


# --- which way ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("quadrant", "ways"),
    [(1, "X+ Z+"), (2, "X+ Z−"), (3, "X− Z−"), (4, "X− Z+"), (5, "Z+"), (6, "X+"), (7, "Z−"), (8, "X−")],
)
def test_tip_quadrant_sets_allowed_touch_directions(setter: JogBench, quadrant: int, ways: str) -> None:
    given(setter, 2, ToolOffsetRow(x=1.0, z=1.0, quadrant=quadrant))
    choose(setter, 2)
    keys = {"X−": Key.Key_Up, "X+": Key.Key_Down, "Z−": Key.Key_Left, "Z+": Key.Key_Right}
    for way, key in keys.items():
        setter.key(Key.Key_P)
        setter.run(0.02)
        setter.down(key)
        setter.run(0.05)
        moves = setter.shot.state is MachineState.JOG
        setter.up(key)
        setter.until(lambda: setter.shot.state is MachineState.IDLE)
        assert moves == (way in ways.split()), way
        setter.key(Key.Key_Escape)


def test_round_tip_is_set_to_nose_center(setter: JogBench) -> None:
    """Quadrant 9: the centre stands a nose radius, here .03 in, before the face."""
    given(setter, 2, ToolOffsetRow(x=0.1 * INCH, z=1.0, quadrant=9, nose_radius=0.03 * INCH))
    choose(setter, 2)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    hold(setter, Key.Key_Up)
    setter.confirm()
    # The contact is at .15; the centre of the nose is .03 further out.
    assert setter.desk.offset_book.tool_offsets[2].x == pytest.approx((0.15 - 0.03) * INCH, abs=0.002)


def test_setter_touch_is_rejected_before_any_motion(setter: JogBench) -> None:
    setter.key(Key.Key_P)
    assert shows(setter.prompt, "jog.which-tool")
    given(setter, 2, ToolOffsetRow(x=1.0, z=1.0))
    choose(setter, 2)
    setter.key(Key.Key_P)
    assert shows(setter.prompt, "jog.no-tip", number=2)
    choose(setter, 3)
    setter.key(Key.Key_P)
    setter.down(Key.Key_Up, SHIFT)
    setter.run(0.05)
    assert shows(setter.prompt, "jog.touch-off-no-rapid")
    setter.up(Key.Key_Up, SHIFT)
    hands(setter).set_input("probe", True)
    setter.run(0.05)
    setter.down(Key.Key_Up)
    setter.run(0.1)
    assert setter.shot.state is MachineState.IDLE
    assert text("jog.input-on-already").upper() in setter.prompt.upper()


def test_lathe_without_setter_shows_message(jog: JogBench) -> None:
    jog.key(Key.Key_P)
    assert shows(jog.prompt, "jog.no-setter")


# --- buttons beside the slides ------------------------------------------------------------------------------


def test_jog_button_jogs_while_pressed(setter: JogBench) -> None:
    hands(setter).set_input("jog_z_plus", True)
    setter.run(0.5)
    assert setter.shot.state is MachineState.JOG
    assert setter.shot.demand[1] > 0.5
    assert setter.shot.demand[0] == 0.0
    hands(setter).set_input("jog_z_plus", False)
    setter.run(0.02)
    setter.until(lambda: setter.shot.state is MachineState.IDLE, 0.5)


def test_button_release_stops_jog_while_screen_is_frozen(setter: JogBench) -> None:
    """The executor sees the button come up by itself: within ticks, not within the lease."""
    hands(setter).set_input("jog_z_plus", True)
    setter.run(0.5)
    hands(setter).set_input("jog_z_plus", False)
    setter.run(0.08, screen=False)
    assert setter.shot.velocity == pytest.approx(0.0, abs=0.05)


def test_button_pressed_before_page_opens_does_not_jog(setter: JogBench) -> None:
    setter.key(Key.Key_F8)
    setter.run(0.1)
    hands(setter).set_input("jog_z_plus", True)
    setter.run(0.5)
    setter.key(Key.Key_F1)
    setter.key(Key.Key_F5)
    setter.run(0.5)
    assert setter.shot.state is MachineState.IDLE
    hands(setter).set_input("jog_z_plus", False)
    setter.run(0.05)
    hands(setter).set_input("jog_z_plus", True)
    setter.run(0.1)
    assert setter.shot.state is MachineState.JOG


def test_two_buttons_or_button_with_key_do_not_jog(setter: JogBench) -> None:
    hands(setter).set_input("jog_z_plus", True)
    setter.run(0.2)
    hands(setter).set_input("jog_x_minus", True)
    setter.run(0.05)
    assert shows(setter.prompt, "jog.two-at-once")
    setter.until(lambda: setter.shot.state is MachineState.IDLE, 0.5)
    setter.run(0.5)
    assert setter.shot.state is MachineState.IDLE
    for name in ("jog_z_plus", "jog_x_minus"):
        hands(setter).set_input(name, False)
    setter.run(0.05)
    hands(setter).set_input("jog_z_plus", True)
    setter.run(0.2)
    setter.down(Key.Key_Left)
    setter.run(0.05)
    setter.until(lambda: setter.shot.state is MachineState.IDLE, 0.5)


def test_jog_button_with_rapid_button_moves_at_rapid(setter: JogBench) -> None:
    hands(setter).set_input("jog_rapid", True)
    setter.run(0.05)
    hands(setter).set_input("jog_z_plus", True)
    setter.run(0.5)
    assert setter.shot.velocity == pytest.approx(100 * INCH / 60, rel=0.02)
    hands(setter).set_input("jog_rapid", False)
    setter.run(0.3)
    assert setter.shot.state is MachineState.IDLE  # it does not go on slowly


def test_jog_button_touches_off_like_a_key(setter: JogBench) -> None:
    choose(setter, 3)
    put(setter, ABOVE)
    setter.key(Key.Key_P)
    hands(setter).set_input("jog_x_minus", True)
    setter.run(0.1)
    setter.until(lambda: setter.shot.state is MachineState.IDLE)
    assert shows(setter.prompt, "jog.return-keeps-found")
    hands(setter).set_input("jog_x_minus", False)
    setter.run(0.1)
    assert shows(setter.prompt, "jog.return-keeps-found")
