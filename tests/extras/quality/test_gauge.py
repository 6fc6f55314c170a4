"""Readings of a gauge: lines of both kinds, garbage, silence, and a cable pulled out of a real pty."""

from __future__ import annotations

import os
import pty
import re
import threading
import tty
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pytest

from app.extras.quality.gauge_table import GaugeModel
from app.extras.quality.serial_gauge import (
    MAX_LINE_LENGTH,
    SILENCE_LIMIT_S,
    GaugeError,
    GaugeReading,
    LineSplitter,
    NoGauge,
    SerialGauge,
    parse_reading,
)
from tests.coded import raises_code
from tests.texts import pattern, text


@pytest.mark.parametrize(
    ("line", "value", "unit"),
    [
        ("01A+00012.345", 12.345, ""),
        ("01A-00000.0125", -0.0125, ""),
        ("12.345 mm", 12.345, "mm"),
        ("  0.50012in ", 0.50012, "in"),
        ('.50012"', 0.50012, "in"),
        ("+12,345", 12.345, ""),
        ("12 MM", 12.0, "mm"),
    ],
)
def test_line_is_parsed_as_a_reading(line: str, value: float, unit: str) -> None:
    assert parse_reading(line) == GaugeReading(value, unit)


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("911", "no-gauge"),
        ("912", "unreadable"),
        ("01B+00012.345", "not-a-reading"),
        ("01A+0001 2.345", "not-a-reading"),
        ("12.3.4", "not-a-reading"),
        ("12.345 cm", "not-a-reading"),
        ("nan", "not-a-reading"),
        ("\ufffd\ufffd", "not-a-reading"),
        ("+", "not-a-reading"),
    ],
)
def test_invalid_line_is_rejected(line: str, code: str) -> None:
    with raises_code(GaugeError, code):
        parse_reading(line)


def test_bytes_are_cut_into_lines() -> None:
    reader = LineSplitter()
    assert reader.split_lines(b"01A+000") == []
    assert reader.split_lines(b"12.345\r") == ["01A+00012.345"]
    assert reader.split_lines(b"\n1 mm\r\n2 mm\r\n\r\n3") == ["1 mm", "2 mm"]
    assert reader.split_lines(b" mm\r") == ["3 mm"]


def test_line_without_an_end_is_limited() -> None:
    reader = LineSplitter()
    assert reader.split_lines(b"x" * (MAX_LINE_LENGTH + 1)) == ["x" * (MAX_LINE_LENGTH + 1)]
    assert reader.split_lines(b"1 mm\r") == ["1 mm"]


@dataclass
class Bench:
    """A gauge on a pty: what is written to ``far`` comes out of its cable."""

    wire: SerialGauge
    far: int
    near: int
    now: list[float]

    def send(self, data: bytes) -> None:
        os.write(self.far, data)

    def hears(self, enough: Callable[[list[GaugeReading | str]], bool]) -> list[GaugeReading | str]:
        """Look until it is enough."""
        found: list[GaugeReading | str] = []
        for _ in range(6000):
            found += self.wire.fetch_readings()
            if enough(found):
                return found
            if self.wire._thread is not None:
                self.wire._thread.join(0.01)
        raise AssertionError(f"not within 60 s: {found}")


@pytest.fixture
def bench() -> Iterator[Bench]:
    far, near = pty.openpty()
    tty.setraw(near)
    now = [0.0]
    model = GaugeModel(os.ttyname(near), "micrometer", "in", 9600, 8, "N", 1)
    bench = Bench(SerialGauge(model, clock=lambda: now[0]), far, near, now)
    yield bench
    bench.wire.close()
    if bench.wire._thread is not None:
        bench.wire._thread.join(60.0)
        assert not bench.wire._thread.is_alive()
    for each in (bench.far, bench.near):
        if each >= 0:
            os.close(each)


def listening(bench: Bench) -> None:
    """It is on when the first line comes through: what was sent before it listened is not for it."""
    assert bench.wire.toggle_receiving() == ""
    found: list[GaugeReading | str] = []
    while not found:
        bench.send(b"1 mm\r\n")
        bench.wire._thread.join(0.05)  # type: ignore[union-attr]
        found = list(bench.wire.fetch_readings())
    bench.send(b"9999 mm\r\n")
    bench.hears(lambda found: GaugeReading(9999.0, "mm") in found)


def test_gauge_reads_both_line_formats_and_reports_garbage(bench: Bench) -> None:
    listening(bench)
    bench.send(b"01A+00000.5012\r")
    bench.send(b"\x00\xff#?\r\n12.345 mm\r\n")
    found = bench.hears(lambda found: len(found) >= 3)
    assert found[0] == GaugeReading(0.5012)
    assert re.fullmatch(pattern("quality.gauge-refused"), str(found[1]))
    assert "#?" in str(found[1])
    assert found[2] == GaugeReading(12.345, "mm")


def test_unplugged_cable_is_reported_and_f5_reconnects(bench: Bench) -> None:
    listening(bench)
    os.close(bench.far)
    os.close(bench.near)
    bench.far = bench.near = -1
    (why,) = bench.hears(bool)
    assert str(why).startswith("GAUGE: ")
    assert "F5: LISTEN AGAIN" in str(why)
    for _ in range(60_000):  # told first, then closed, by its own thread
        if not bench.wire.is_receiving:
            break
        threading.Event().wait(0.001)
    assert not bench.wire.is_receiving


def test_missing_serial_port_is_reported(bench: Bench) -> None:
    gone = SerialGauge(GaugeModel("/dev/ttyNONE", "g", "mm", 9600, 8, "N", 1))
    assert gone.toggle_receiving() == ""
    bench.wire = gone
    (why,) = bench.hears(bool)
    assert "this port does not exist" in str(why)


def test_silence_is_reported(bench: Bench) -> None:
    assert "Press F5 to start" in bench.wire.status_text
    listening(bench)
    assert re.fullmatch(pattern("quality.listening"), bench.wire.status_text)
    bench.now[0] += SILENCE_LIMIT_S + 60.0
    assert "No reading from the gauge for 6 min" in bench.wire.status_text
    bench.send(b"2 mm\r")
    bench.hears(bool)
    assert re.fullmatch(pattern("quality.listening"), bench.wire.status_text)


def test_receiving_can_be_stopped(bench: Bench) -> None:
    listening(bench)
    assert bench.wire.toggle_receiving() == ""
    assert not bench.wire.is_receiving


def test_machine_without_a_gauge_reports_none() -> None:
    none = NoGauge()
    assert none.toggle_receiving() == text("quality.no-gauge")
    assert list(none.fetch_readings()) == []
