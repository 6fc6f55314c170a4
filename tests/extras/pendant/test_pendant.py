"""What a pendant's events do to buttons and counts, and everything that must not count."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import pytest

from app.extras.pendant.driver.input_devices import AxisRange, EventPacket, InputEvent, PacketParser
from app.extras.pendant.driver.pendant_station import (
    LOST_EVENTS_MESSAGE,
    PendantButtons,
    PendantIO,
    PendantReader,
    PendantStation,
)
from app.extras.pendant.driver.pendant_table import STOP_INPUTS, parse_wheel_name
from core.ports import DriverError, StationState
from tests.coded import raises_code
from tests.extras.pendant.made import (
    ABS,
    ABS_HAT0X,
    BOUND,
    BTN_0,
    BTN_A,
    BTN_B,
    DROPPED,
    EVENT,
    HAT,
    KEY,
    REL,
    REL_DIAL,
    SYN,
    WHEEL,
    Peer,
)

ABS_WHEEL = 8  # of the kernel's header


class Bench:
    """A pendant and its device; time is moved by hand."""

    def __init__(self, *, place: bool = False, pressed: tuple[int, ...] = ()) -> None:
        self.t = 100.0
        self.peer: Peer | None = None
        self.plug(*pressed)
        self.rung = 0
        self.pendant = PendantReader(
            BOUND,
            frozenset(STOP_INPUTS),
            WHEEL,
            self._find,
            lambda: self.t,
            has_absolute_wheel=place,
            report_change=self._ring,
        )
        self.look()

    def _ring(self) -> None:
        self.rung += 1

    def plug(self, *pressed: int) -> Peer:
        self.peer = Peer(HAT)
        self.peer.now = self.t
        self.peer.pressed |= set(pressed)
        return self.peer

    def _find(self) -> list[Peer]:
        if self.peer is None:
            raise DriverError("the pendant Knob is not plugged in")
        return [self.peer]

    def go(self, seconds: float) -> None:
        self.t += seconds
        if self.peer is not None:
            self.peer.now = self.t

    def look(self) -> None:
        self.pendant.process_events(0.0)

    @property
    def device(self) -> Peer:
        assert self.peer is not None
        return self.peer

    @property
    def held(self) -> set[str]:
        return {name for name, on in self.pendant.get_state().input_states.items() if on}

    @property
    def counts(self) -> int:
        return self.pendant.get_state().wheel_counts


def test_input_event_struct_matches_the_kernel() -> None:
    """Of 64 bits: 16 bytes of time, 2 of type, 2 of code, 4 of value."""
    data = bytes.fromhex(
        "0a00000000000000 20a1070000000000 0200 0700 ffffffff 0b00000000000000 0000000000000000"
    )
    data += bytes.fromhex("0000 0000 00000000")
    if EVENT.size != 24:
        pytest.skip("a long has four bytes here")
    (packet,) = PacketParser().parse(data)
    (event,) = packet.events
    assert event == (10.5, REL, REL_DIAL, -1)


def test_packet_in_pieces_counts_once_it_is_complete() -> None:
    packets = PacketParser()
    data = EVENT.pack(1, 0, REL, REL_DIAL, 3) + EVENT.pack(1, 0, SYN, 0, 0)
    assert [packet for i in range(len(data) - 1) for packet in packets.parse(data[i : i + 1])] == []
    (packet,) = packets.parse(data[-1:])
    assert packet.events[0].value == 3


def test_button_is_pressed_until_it_is_released() -> None:
    bench = Bench()
    bench.device.key(BTN_A, True)
    bench.look()
    assert bench.held == {"jog_x_plus"}
    bench.device.send((KEY, BTN_A, 2))  # it repeats by itself
    bench.look()
    assert bench.held == {"jog_x_plus"}
    bench.device.key(BTN_A, False)
    bench.look()
    assert bench.held == set()


def test_hat_acts_as_two_buttons() -> None:
    bench = Bench()
    for value, names in ((1, {"jog_z_plus"}), (-1, {"jog_z_minus"}), (0, set())):
        bench.device.send((ABS, ABS_HAT0X, value))
        bench.look()
        assert bench.held == names


def test_wheel_clicks_are_counted() -> None:
    bench = Bench()
    for counts in (1, 1, -3, 2):
        bench.device.turn(counts)
    bench.look()
    assert bench.counts == 1


def test_high_resolution_duplicate_of_a_wheel_event_is_ignored() -> None:
    bench = Bench()
    bench.device.send((REL, REL_DIAL, 1), (REL, 12, 120))
    bench.look()
    assert bench.counts == 1


def test_repeated_dial_position_counts_nothing() -> None:
    """A Shuttle tells the place of its dial with every button, and never 0."""
    bench = Bench(place=True)
    for place in (200, 200, 201, 201):
        bench.device.turn(place)
    bench.look()
    assert bench.counts == 1
    for place in (254, 255, 1, 2):  # 53 on, and round: 255, 0 untold, 1
        bench.device.turn(place)
    bench.look()
    assert bench.counts == 1 + (254 - 201) + 1 + 2 + 1
    bench.device.turn(254)
    bench.look()
    assert bench.counts == 1 + (254 - 201)


# --- what does not count --------------------------------------------------------------------------------


def test_button_pressed_at_plug_in_counts_from_the_next_press() -> None:
    bench = Bench(pressed=(BTN_A,))
    assert bench.held == set()
    bench.device.send((KEY, BTN_A, 2))
    bench.device.send((KEY, BTN_A, 1))
    bench.look()
    assert bench.held == set()
    bench.device.key(BTN_A, False)
    bench.device.key(BTN_A, True)
    bench.look()
    assert bench.held == {"jog_x_plus"}


def test_stop_pressed_at_plug_in_stops() -> None:
    assert Bench(pressed=(BTN_B,)).held == {"hold"}


def test_late_press_is_ignored_but_late_release_and_stop_count() -> None:
    bench = Bench()
    bench.device.key(BTN_A, True, ago=0.11)
    bench.look()
    assert bench.held == set()
    bench.device.key(BTN_A, False)
    bench.device.key(BTN_A, True, ago=0.09)
    bench.look()
    assert bench.held == {"jog_x_plus"}
    bench.device.key(BTN_A, False, ago=5.0)
    bench.device.key(BTN_B, True, ago=5.0)
    bench.look()
    assert bench.held == {"hold"}


def test_late_wheel_counts_are_dropped() -> None:
    bench = Bench()
    bench.device.turn(5, ago=0.2)
    bench.device.turn(1)
    bench.look()
    assert bench.counts == 1


def test_late_dial_position_is_only_the_new_reference() -> None:
    bench = Bench(place=True)
    bench.device.turn(10)
    bench.device.turn(40, ago=0.2)
    bench.device.turn(41)
    bench.look()
    assert bench.counts == 1


def test_dropped_events_release_all_buttons_and_deselect_the_wheel() -> None:
    bench = Bench()
    bench.device.key(BTN_A, True)
    bench.look()
    bench.device.send((REL, REL_DIAL, 7), (SYN, DROPPED, 0), (REL, REL_DIAL, 9))
    bench.look()
    assert bench.held == set()  # though it is still down: it must be let go first
    assert bench.counts == 0
    station = PendantStation(Inner(), bench.pendant, has_stops=True, has_wheel=True)
    assert station.read_state().wheel_trouble == LOST_EVENTS_MESSAGE
    assert station.read_state().trouble == ""
    bench.go(0.31)
    bench.look()
    assert station.read_state().wheel_trouble == ""
    bench.device.key(BTN_A, False)
    bench.device.key(BTN_A, True)
    bench.look()
    assert bench.held == {"jog_x_plus"}


def test_key_released_in_dropped_events_is_released() -> None:
    bench = Bench()
    bench.device.key(BTN_B, True)
    bench.look()
    bench.device.pressed.clear()
    bench.device.send((SYN, DROPPED, 0))
    bench.look()
    assert bench.held == set()


# --- unplugged ------------------------------------------------------------------------------------------


class Inner:
    """The machine's own station and terminals."""

    state = StationState(handwheel=4)

    def read_state(self) -> StationState:
        return self.state

    def inputs(self) -> dict[str, bool]:
        return {"estop": False, "start": False}

    def get_outputs(self) -> dict[str, bool]:
        return {"coolant": True}

    def write(self, name: str, is_on: bool) -> None:
        raise DriverError(f"{name} {is_on}")

    def switch_to_safe_state(self) -> None:
        raise DriverError("safe")


def test_unplugging_releases_everything_and_is_reported() -> None:
    bench = Bench()
    bench.device.key(BTN_A, True)
    bench.device.key(BTN_0, True)
    bench.look()
    assert bench.held == {"jog_x_plus", "wheel_x"}
    bench.device.pull()
    bench.peer = None
    bench.look()
    assert bench.held == set()
    assert "unplugged" in bench.pendant.get_state().missing_reason
    station = PendantStation(Inner(), bench.pendant, has_stops=True, has_wheel=True)
    bench.go(10.0)
    bench.look()
    assert "not plugged in" in station.read_state().trouble  # as long as its stop is away
    assert "not plugged in" in station.read_state().wheel_trouble


def test_pendant_without_stop_buttons_holds_once_when_unplugged() -> None:
    bench = Bench()
    station = PendantStation(Inner(), bench.pendant, has_stops=False, has_wheel=True)
    bench.device.pull()
    bench.peer = None
    bench.look()
    assert "unplugged" in station.read_state().trouble
    bench.go(0.4)
    bench.look()
    assert station.read_state().trouble == ""
    assert "not plugged in" in station.read_state().wheel_trouble


def test_replugged_pendant_works_again_and_moves_nothing() -> None:
    bench = Bench()
    bench.device.turn(3)
    bench.look()
    bench.device.pull()
    bench.look()
    bench.plug(BTN_A)
    bench.look()
    assert bench.pendant.get_state().missing_reason == ""
    assert bench.held == set()
    assert bench.counts == 3
    bench.device.turn(1)
    bench.look()
    assert bench.counts == 4


def test_stopped_reader_releases_all_buttons() -> None:
    bench = Bench()
    bench.device.key(BTN_A, True)
    bench.look()
    bench.go(0.31)  # and nobody looks
    assert bench.held == set()
    assert "has stopped" in bench.pendant.get_state().missing_reason


def test_pendant_extends_the_station_and_cannot_start_a_cycle() -> None:
    bench = Bench()
    bench.device.turn(2)
    bench.device.key(BTN_B, True)
    bench.look()
    state = PendantStation(Inner(), bench.pendant, has_stops=True, has_wheel=True).read_state()
    assert state == dataclasses.replace(Inner.state, handwheel=6, hold=True)
    io = PendantIO(Inner(), bench.pendant)
    assert io.inputs()["hold"]
    assert not io.inputs()["start"]
    assert io.get_outputs() == {"coolant": True}
    with raises_code(DriverError, "driver", "coolant False"):
        io.write("coolant", False)
    with raises_code(DriverError, "driver", "safe"):
        io.switch_to_safe_state()


def test_reader_thread_reads_and_ends() -> None:
    bench = Bench()
    bench.pendant.start()
    bench.pendant.close()
    assert bench.device.closed
    assert bench.held == set()


def test_press_turn_or_unplug_wakes_the_control_at_rest() -> None:
    bench = Bench()
    acts: tuple[Callable[[], None], ...] = (
        lambda: bench.device.key(BTN_A, True),
        lambda: bench.device.turn(1),
        bench.device.pull,
    )
    for act in acts:
        before = bench.rung
        bench.look()
        assert bench.rung == before  # nothing has happened
        act()
        bench.look()
        assert bench.rung > before
    before = bench.rung
    bench.plug()
    bench.look()
    assert bench.rung > before


# --- wheels and sticks that tell a place --------------------------------------------------------------------


class Said:
    """Buttons without a device: what is told goes straight in."""

    def __init__(self, wheel: str, ranges: dict[int, AxisRange], keys: tuple[int, ...] = ()) -> None:
        self.buttons = PendantButtons(BOUND, frozenset(STOP_INPUTS), parse_wheel_name(wheel))
        self.buttons.set_initial_state(keys, ranges)

    def tell(self, kind: int, code: int, value: int, ago: float = 0.0) -> None:
        self.buttons.apply_packet(EventPacket((InputEvent(10.0 - ago, kind, code, value),)), 10.0)


def test_absolute_wheel_counts_from_its_position_and_wraps_around() -> None:
    """0 to 255: from 250 to 5 are eleven on, back to 255 six the other way; a late one moves its place."""
    said = Said("ABS_WHEEL", {ABS_WHEEL: AxisRange(0, 255, 250)})
    counts = []
    for value, ago in ((5, 0.0), (255, 0.0), (200, 5.0), (201, 0.0)):
        said.tell(ABS, ABS_WHEEL, value, ago)
        counts.append(said.buttons.wheel_counts)
    assert counts == [11, 5, 5, 6]


def test_an_absolute_wheel_without_a_range_counts_nothing() -> None:
    said = Said("ABS_WHEEL", {ABS_WHEEL: AxisRange(3, 3, 3)})
    for value in (4, 9, 3):
        said.tell(ABS, ABS_WHEEL, value)
    assert said.buttons.wheel_counts == 0


@pytest.mark.parametrize("ranges", [{}, {ABS_HAT0X: AxisRange(0, 0, 0)}])
def test_stick_with_unknown_range_is_never_pressed(ranges: dict[int, AxisRange]) -> None:
    said = Said("REL_DIAL", ranges)
    for value in (1, 255, -32768):
        said.tell(ABS, ABS_HAT0X, value)
        assert said.buttons.pressed_button_names == set()


def test_stick_is_pressed_to_one_side_until_it_returns() -> None:
    said = Said("REL_DIAL", {ABS_HAT0X: AxisRange(0, 200, 100)})
    seen = []
    for value in (140, 190, 140, 105, 10):
        said.tell(ABS, ABS_HAT0X, value)
        seen.append(set(said.buttons.pressed_button_names))
    assert seen == [set(), {"jog_z_plus"}, {"jog_z_plus"}, set(), {"jog_z_minus"}]


def test_late_report_of_a_pressed_button_changes_nothing() -> None:
    said = Said("REL_DIAL", {})
    said.tell(KEY, BTN_A, 1)
    said.tell(KEY, BTN_A, 1, ago=5.0)
    assert said.buttons.pressed_button_names == {"jog_x_plus"}
    said.buttons.release_all_buttons()
    assert said.buttons.pressed_button_names == set()


# --- the reader ---------------------------------------------------------------------------------------------


class Pulled(Peer):
    """Found, and gone before it says what is pressed."""

    def read_pressed_keys(self) -> frozenset[int]:
        raise OSError(19, "No such device")


def test_pendant_unplugged_while_opening_is_released_and_searched_again() -> None:
    bench = Bench()
    bench.device.pull()
    bench.look()
    gone = Pulled()
    bench.peer = gone
    bench.look()
    assert gone.closed
    assert "unplugged" in bench.pendant.get_state().missing_reason
    bench.plug()
    bench.look()
    assert bench.pendant.get_state().missing_reason == ""


def test_pendant_that_was_never_started_is_released() -> None:
    bench = Bench()
    device = bench.device
    bench.pendant.close()
    assert device.closed
    assert bench.pendant.get_state().missing_reason == "TurnDesk has stopped reading the pendant"
