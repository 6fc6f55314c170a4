"""Once the spindle has been told to stop, no run command leaves until it is told to turn again."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from core.ports import Fault
from drivers.inverter.inverter_control import InverterThread
from tests.drivers.inverter.benches import Bench, bench

End = Callable[[Bench], None]


def is_run(frame: bytes) -> bool:
    """Whether a frame of one of the families makes its inverter turn."""
    function, data = frame[1], frame[2:-2]
    return {
        3: data[0] == 1 and bool(data[1] & 1) and len(data) == 2,  # Huanyang's control word
        5: data == b"\x00\x00\xff\x00",
        6: data[:2] == b"\x20\x00" and data[3] & 3 == 2,
        16: data[:2] == b"\x00\x01" and bool(data[-1] & 3),
    }.get(function, False)


def is_setpoint(frame: bytes) -> bool:
    """Whether a frame sets the frequency in one of the families."""
    huanyang = frame[1:3] == b"\x05\x02"
    return huanyang or frame[1:4] in (b"\x06\x20\x01", b"\x10\x00\x02", b"\x10\x00\x00")


def stop(one: Bench) -> None:
    one.spindle.set_speed(0.0)


def coast(one: Bench) -> None:
    one.spindle.start_coasting()


def estop(one: Bench) -> None:
    """The one who asks for the fault all the time sees an E-stop."""
    one.spindle._estop = lambda: True
    one.spindle.read_fault()


def trouble(one: Bench) -> None:
    one.attendant.failure = Fault("the encoder is lost", "driver")


def clear(one: Bench) -> None:
    one.spindle.clear_fault()


def ended(one: Bench) -> None:
    """The program ends; what is under way on the line ends by itself."""
    one.attendant.close = lambda: None  # type: ignore[method-assign]
    InverterThread(one.attendant).close()


ENDS = (stop, coast, estop, trouble, clear, ended)


class Interrupted:
    """Lets ``end`` come with the first frame for which ``when`` holds; ``after`` is what follows it."""

    def __init__(self, one: Bench, when: Callable[[bytes], bool], end: End) -> None:
        self._one, self._when, self._end = one, when, end
        self._send = one.wire.send
        self.come = False
        self.after: list[bytes] = []
        one.wire.send = self._heard  # type: ignore[method-assign]

    def _heard(self, data: bytes) -> None:
        if self.come:
            self.after.append(data)
        elif self._when(data):
            self.come = True
            self._end(self._one)
        self._send(data)

    @property
    def runs(self) -> int:
        """How many run commands have followed."""
        return sum(map(is_run, self.after))


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("rpm", [1200.0, -1200.0])
def test_stop_during_the_first_frequency_prevents_the_run_command(stand: Bench, end: End, rpm: float) -> None:
    seen = Interrupted(stand, is_setpoint, end)
    stand.spindle.set_speed(rpm)
    stand.run(2.0)
    assert (seen.come, bool(seen.after), seen.runs) == (True, True, 0)
    assert stand.rpm == 0.0


@pytest.mark.parametrize("end", ENDS)
def test_stop_in_the_pause_before_a_run_command_prevents_it(stand: Bench, end: End) -> None:
    """The line keeps its pace: between the answer to the frequency and the run command it is silent."""
    sleep, come = stand.clock.sleep_until, False

    def overslept(time_s: float) -> None:
        nonlocal come
        sleep(time_s)
        if not come and stand.inverter.hz and time_s == stand.clock.now() and not stand.wire.waits:
            come = True
            end(stand)

    stand.clock.sleep_until = overslept  # type: ignore[method-assign]
    seen = Interrupted(stand, is_setpoint, lambda _: None)
    stand.spindle.set_speed(1200.0)
    stand.run(2.0)
    assert (come, seen.come, seen.runs) == (True, True, 0)
    assert stand.rpm == 0.0


@pytest.mark.parametrize("end", ENDS)
def test_unanswered_run_command_is_not_repeated_after_a_stop(stand: Bench, end: End) -> None:
    def unanswered(one: Bench) -> None:
        one.wire.loses = 1
        end(one)

    seen = Interrupted(stand, is_run, unanswered)
    stand.spindle.set_speed(1200.0)
    stand.run(3.0)
    assert (seen.come, bool(seen.after), seen.runs) == (True, True, 0)
    assert stand.rpm == 0.0


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("number", range(8))
def test_no_run_command_follows_a_stop_during_any_frame(turning: Bench, end: End, number: int) -> None:
    count = iter(range(1000))
    seen = Interrupted(turning, lambda _: next(count) == number, end)
    turning.spindle.set_speed(900.0)
    while not seen.come:
        turning.attendant.run_exchange()
    turning.run(3.0)
    assert seen.runs == 0
    assert turning.rpm == 0.0


def test_prevented_start_is_followed_by_a_stop_and_can_be_repeated(stand: Bench) -> None:
    stops = stand.inverter.stops
    seen = Interrupted(stand, is_setpoint, stop)
    stand.spindle.set_speed(1200.0)
    stand.run(0.5)
    assert (seen.runs, stand.inverter.stops > stops, stand.spindle.read_fault()) == (0, True, "")
    stand.spindle.set_speed(-600.0)
    stand.run(2.0)
    assert seen.runs > 0
    assert stand.rpm == pytest.approx(-600.0, abs=1.0)
    assert stand.spindle.read_fault() == ""


def test_direction_that_may_have_been_received_is_sent_again() -> None:
    """A Delta is not told what it was told last; here nobody knows what that was."""
    one = bench("delta-vfdb")
    one.spindle.set_speed(1200.0)
    one.run(1.5)
    seen = Interrupted(one, is_run, lambda each: setattr(each.wire, "loses", 3))
    one.spindle.set_speed(-1200.0)
    one.attendant.run_exchange()
    assert (one.attendant.exchange_error != "", one.inverter.back) == (True, True)
    one.spindle.set_speed(1200.0)
    one.run(4.0)
    assert seen.runs == 3  # two repetitions, and the new direction
    assert one.rpm == pytest.approx(1200.0, abs=1.0)


# --- a stop that is followed by a start before the next frame -----------------------------------------------


def frames_of(one: Bench, seconds: float) -> list[bytes]:
    """The frames that are sent from now on."""
    seen = Interrupted(one, lambda _: False, lambda _: None)
    seen.come = True
    one.run(seconds)
    return seen.after


@pytest.mark.parametrize("rpm", [1200.0, 600.0, -1200.0])
def test_a_stop_before_a_start_is_sent_first(turning: Bench, rpm: float) -> None:
    stops = turning.inverter.stops
    turning.spindle.set_speed(0.0)
    turning.spindle.set_speed(rpm)
    runs = [is_run(frame) for frame in frames_of(turning, 3.0)]
    assert stops < turning.inverter.stops <= stops + 2  # a Hitachi needs two frames
    assert True in runs
    assert not runs[0]
    assert turning.rpm == pytest.approx(rpm, abs=1.0)
    assert turning.spindle.read_fault() == ""


@pytest.mark.parametrize("pairs", [2, 5])
def test_several_stops_before_a_frequency_are_sent_as_one(turning: Bench, pairs: int) -> None:
    stops = turning.inverter.stops
    for _ in range(pairs):
        turning.spindle.set_speed(0.0)
        turning.spindle.set_speed(1200.0)
    turning.run(3.0)
    assert stops < turning.inverter.stops <= stops + 2  # a Hitachi needs two frames
    assert turning.rpm == pytest.approx(1200.0, abs=1.0)


def test_unanswered_stop_is_sent_again_before_the_start(turning: Bench) -> None:
    turning.spindle.set_speed(0.0)
    turning.spindle.set_speed(1200.0)
    turning.wire.loses = 1
    stops = turning.inverter.stops
    runs = [is_run(frame) for frame in frames_of(turning, 3.0)]
    assert turning.inverter.stops > stops
    assert runs[:2] == [False, False]
    assert turning.rpm == pytest.approx(1200.0, abs=1.0)


def test_run_command_before_a_stop_is_prevented_despite_a_later_start(stand: Bench) -> None:
    def stop_and_reverse(one: Bench) -> None:
        one.spindle.set_speed(0.0)
        one.spindle.set_speed(-600.0)

    seen = Interrupted(stand, is_setpoint, stop_and_reverse)
    stops = stand.inverter.stops
    stand.spindle.set_speed(1200.0)
    stand.run(3.0)
    assert not is_run(seen.after[0])
    assert stand.inverter.stops > stops
    assert stand.rpm == pytest.approx(-600.0, abs=1.0)


def test_change_of_speed_sends_no_stop(turning: Bench) -> None:
    stops = turning.inverter.stops
    turning.spindle.set_speed(600.0)
    turning.run(2.0)
    assert turning.inverter.stops == stops
