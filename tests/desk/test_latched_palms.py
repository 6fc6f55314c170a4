"""Latched palms: where everything is simulated, one finger or the mouse starts a cycle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import cast

from app.desk.station_controls import LATCH_TIME_S, StationControls, StationPanel


class Station:
    """Notes every button by its name."""

    def __init__(self, note: Callable[[str], None]) -> None:
        self._note = note

    def __getattr__(self, name: str) -> Callable[[], None]:
        return lambda: self._note(name)


@dataclass
class Bench:
    """Hands on a station that notes what is pressed, and a clock that is moved by hand."""

    now: float = 100.0
    barred: str = ""
    said: list[str] = field(default_factory=list)
    pressed: list[str] = field(default_factory=list)

    def hands(self) -> StationControls:
        station = cast("StationPanel", Station(self.pressed.append))
        return StationControls(
            station, lambda: self.now, self.said.append, lambda: None, lambda: None, lambda: self.barred
        )


def test_latching_second_palm_presses_and_releases_both() -> None:
    bench = Bench()
    hands = bench.hands()
    hands.latch("left")
    hands.release_palm_buttons()
    assert (bench.pressed, hands.update_latched_side()) == ([], "left")
    bench.now += LATCH_TIME_S - 0.1
    hands.latch("right")
    assert bench.pressed == ["press_left", "press_right"]
    hands.release_palm_buttons()
    assert bench.pressed[2:] == ["release_left", "release_right"]
    assert not hands.update_latched_side()


def test_latched_palm_times_out_and_second_tap_releases_it() -> None:
    bench = Bench()
    hands = bench.hands()
    hands.latch("left")
    bench.now += LATCH_TIME_S + 0.1
    hands.latch("right")
    assert (bench.pressed, hands.update_latched_side()) == ([], "right")
    hands.latch("right")
    assert (bench.pressed, hands.update_latched_side()) == ([], "")


def test_latched_palms_do_nothing_while_barred_or_after_release_all() -> None:
    bench = Bench(barred="NO START: THE PROGRAM IS BEING READ ANEW")
    hands = bench.hands()
    hands.latch("left")
    assert (hands.update_latched_side(), bench.said) == ("", [bench.barred])
    bench.barred = ""
    hands.latch("left")
    hands.hold(is_down=True)  # whoever holds the feed does not want a start
    hands.latch("right")
    assert bench.pressed == ["press_hold"]
    hands.release_all_buttons()
    assert not hands.update_latched_side()
