"""The key watcher alone, on a real X server without a window manager: keys go to what the pointer is on."""

from __future__ import annotations

import ctypes
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from app.desk.stop_keys.key_watcher_client import KeyWatcherClient
from app.desk.stop_keys.stop_records import (
    MAX_RECORD_BYTES,
    FocusRecord,
    StopArea,
    StopKeyPress,
    StopKind,
    make_press_number,
)
from tests.killed.bench import until
from tests.stories.x11 import Server, another_client, missing

LIMIT = 20.0  # s
INSIDE, OUTSIDE = (200, 200), (700, 600)


@dataclass
class Bench:
    server: Server
    window: int
    screen: socket.socket
    control: socket.socket

    def show(self, focus: FocusRecord) -> None:
        """Tell the watcher which window is whose."""
        self.screen.send(focus.to_bytes())

    def stop(self) -> StopKeyPress:
        return StopKeyPress.from_bytes(self.control.recv(MAX_RECORD_BYTES))


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    """A window, a watcher, and both ends to which it sends."""
    if why := missing():
        pytest.skip(f"the key watcher needs an X server: {why}")
    server = Server(tmp_path / "x")
    line, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    theirs, screen = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with another_client(server, "window"), control, screen:
        files = (line.fileno(), theirs.fileno())
        words = [sys.executable, "-m", "app.compose.control.key_watcher_process", *map(str, files)]
        watcher = subprocess.Popen(words, pass_fds=files, env=server.environment)
        line.close()
        theirs.close()
        control.settimeout(LIMIT)
        yield Bench(server, _under(server, INSIDE), screen, control)
        screen.close()
        assert watcher.wait(LIMIT) == 0  # it ends with the screen
    server.close()


def _under(server: Server, at: tuple[int, int]) -> int:
    """The window there."""
    server.point(*at)
    root, child, mask = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.c_uint()
    places = [ctypes.c_int() for _ in range(4)]
    answers = [ctypes.byref(each) for each in (root, child, *places, mask)]
    x = server._x
    x.XDefaultRootWindow.restype = ctypes.c_ulong
    x.XQueryPointer(server._display, ctypes.c_ulong(x.XDefaultRootWindow(server._display)), *answers)
    assert child.value
    return child.value


def press_until_sent(bench: Bench, key: str) -> StopKeyPress:
    """Press until the watcher has begun to watch."""
    bench.control.settimeout(0.5)
    for _ in range(40):
        bench.server.down(key)
        bench.server.up(key)
        try:
            return bench.stop()
        except TimeoutError:
            continue
    raise AssertionError(f"{key} was not sent")


def test_a_stop_key_is_sent_while_the_pointer_is_on_the_window(bench: Bench) -> None:
    bench.show(FocusRecord(frozenset({bench.window}), is_esc_stop_key=False))
    sent = press_until_sent(bench, "Pause")
    assert sent.stop_kind is StopKind.HOLD
    assert StopKeyPress.from_bytes(bench.screen.recv(MAX_RECORD_BYTES)) == sent


def test_nothing_is_sent_for_pointer_elsewhere_or_for_other_keys(bench: Bench) -> None:
    bench.show(FocusRecord(frozenset({bench.window}), is_esc_stop_key=False))
    press_until_sent(bench, "Pause")
    for key in ("Escape", "space", "h"):
        bench.server.down(key)
        bench.server.up(key)
    bench.server.point(*OUTSIDE)
    bench.server.down("Pause")
    bench.server.up("Pause")
    bench.control.settimeout(0.5)
    with pytest.raises(TimeoutError):
        bench.stop()
    bench.server.point(*INSIDE)
    assert press_until_sent(bench, "Scroll_Lock").stop_kind is StopKind.ESTOP


@pytest.fixture
def client(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Bench, KeyWatcherClient]]:
    """A window, and the screen's end of a watcher, which can be restarted."""
    if why := missing():
        pytest.skip(f"the key watcher needs an X server: {why}")
    server = Server(tmp_path / "x")
    for name in ("DISPLAY", "XAUTHORITY"):
        if name in server.environment:
            monkeypatch.setenv(name, server.environment[name])
    line, control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with another_client(server, "window"), line, control:
        made = KeyWatcherClient(line.dup(), line.dup, lambda *_: None)
        bench = Bench(server, _under(server, INSIDE), made._screen, control)
        made.send_focus(FocusRecord(frozenset({bench.window}), is_esc_stop_key=False))
        press_until_sent(bench, "Pause")
        yield bench, made
        made.close()
    server.close()


def test_killed_watcher_is_replaced_by_another_that_sends_stop_keys(
    client: tuple[Bench, KeyWatcherClient],
) -> None:
    bench, made = client
    killed = made._process
    killed.kill()
    killed.wait()
    made.check_process()
    assert made._process.pid != killed.pid
    made.send_focus(FocusRecord(frozenset({bench.window}), is_esc_stop_key=False))  # for the new one
    assert press_until_sent(bench, "Scroll_Lock").stop_kind is StopKind.ESTOP


def test_suspended_watcher_sends_the_press_with_its_number_when_it_runs_again(
    client: tuple[Bench, KeyWatcherClient],
) -> None:
    bench, made = client
    made._process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, made._process.pid, os.WSTOPPED | os.WNOWAIT)
    bench.server.down("Pause")
    bench.server.up("Pause")
    bench.control.settimeout(0.3)
    with pytest.raises(TimeoutError):
        bench.stop()
    made.check_process()  # it has not ended, so the screen alone acts
    made.read_sent_stops()
    made._process.send_signal(signal.SIGCONT)
    bench.control.settimeout(LIMIT)
    late = bench.stop()
    assert late.stop_kind is StopKind.HOLD
    assert late.press_number != 0
    until(lambda: made.was_press_sent(late.press_number), lambda: "the screen learns its number")


def test_stop_key_held_down_is_sent_once(bench: Bench) -> None:
    bench.server.repeats(100, 20)
    bench.show(FocusRecord(frozenset({bench.window}), is_esc_stop_key=True))
    press_until_sent(bench, "Escape")
    bench.control.settimeout(LIMIT)
    bench.server.down("Pause")
    assert bench.stop().stop_kind is StopKind.HOLD
    bench.control.settimeout(0.5)
    with pytest.raises(TimeoutError):
        bench.stop()
    bench.server.up("Pause")


def test_click_on_stop_area_is_sent_at_its_place_in_the_window_only(bench: Bench) -> None:
    # The window is 400 x 300 pixels, with its corner at 100, 100: the area is on the screen from 200, 200 on.
    areas = (StopArea(bench.window, 100, 100, 50, 50, StopKind.ESTOP),)
    bench.show(FocusRecord(frozenset({bench.window}), is_esc_stop_key=False, stop_areas=areas))
    press_until_sent(bench, "Pause")
    assert click(bench, (201, 201)) is StopKind.ESTOP
    assert click(bench, (249, 249)) is StopKind.ESTOP
    assert click(bench, (198, 201)) is None
    assert click(bench, (252, 201)) is None
    assert click(bench, (201, 201), "wheel down") is None
    with another_client(bench.server, "window"):
        assert click(bench, (201, 201)) is None
    bench.server.run("xdotool", "windowmove", str(bench.window), "300", "200")
    assert click(bench, (201, 201)) is None
    assert click(bench, (401, 301)) is StopKind.ESTOP
    bench.server.run("xdotool", "windowunmap", str(bench.window))
    assert click(bench, (401, 301)) is None


def click(bench: Bench, at: tuple[int, int], button: str = "left") -> StopKind | None:
    """Click there; the stop that the control gets."""
    bench.server.point(*at)
    for down in (True, False):
        bench.server.button(button, down=down)
    bench.control.settimeout(1.0)
    try:
        return bench.stop().stop_kind
    except TimeoutError:
        return None


H_CODE, J_CODE, E_CODE, SPACE_CODE = 43, 44, 26, 65  # on a keyboard with the US layout
LATER = 10**8  # ms


@pytest.mark.parametrize(
    ("layout", "stops"),
    [
        ("us", {H_CODE: StopKind.HOLD, E_CODE: StopKind.ESTOP, SPACE_CODE: StopKind.HOLD, J_CODE: None}),
        # Dvorak has D, H and the full stop on these keys.
        ("us dvorak", {H_CODE: None, J_CODE: StopKind.HOLD, E_CODE: None, SPACE_CODE: StopKind.HOLD}),
        # A layout without Latin letters: by the position on a PC keyboard.
        ("ru", {H_CODE: StopKind.HOLD, E_CODE: StopKind.ESTOP, SPACE_CODE: StopKind.HOLD, J_CODE: None}),
    ],
)
def test_letters_follow_the_keyboard_layout(
    bench: Bench, layout: str, stops: dict[int, StopKind | None]
) -> None:
    record = FocusRecord(frozenset({bench.window}), is_esc_stop_key=False)
    bench.show(record)
    sent = press_until_sent(bench, "Pause")
    later = make_press_number(1, (sent.press_number & 0xFFFFFFFF) + LATER)
    bench.show(record._replace(are_letters_stop_keys=True, handled_press=later))
    bench.server.layout(layout)
    bench.server.down("F2")
    bench.server.up("F2")
    assert {code: press(bench, code) for code in stops} == stops
    bench.server.down("Alt_L")
    assert press(bench, SPACE_CODE) is None  # A window manager may use this key.


def press(bench: Bench, code: int) -> StopKind | None:
    """Press a key; the stop that the control gets."""
    bench.server.down(code)
    bench.server.up(code)
    bench.control.settimeout(1.0)
    try:
        return bench.stop().stop_kind
    except TimeoutError:
        return None
