"""Two masters on a serial port: the second one, whatever it wants there, is refused with one sentence."""

from __future__ import annotations

import os
import tty
from collections.abc import Callable, Iterator

import pytest

from app.compose.backends.serial_ports import open_serial_port as open_line
from core.ports import DriverError
from drivers.grblhal.grblhal_transport import open_transport as open_controller
from drivers.serial_line import LineSettings
from tests.coded import raises_code
from tests.drivers.ptys import open_pty

Opened = Callable[[], None]  # lets it go again
OWNERS: dict[str, Callable[[str], Opened]] = {
    "inverter": lambda port: open_line(LineSettings(port)).close,
    "programs": lambda port: (
        open_line(
            LineSettings(port, data_bits=7, parity="E", flow_control="xonxoff"), count_damaged=True
        ).close
    ),
    "grblhal": lambda port: open_controller(port, 115_200).close,
}


@pytest.fixture
def port() -> Iterator[str]:
    """A serial port of this computer."""
    handles = open_pty()
    tty.setraw(handles[1])
    yield os.ttyname(handles[1])
    for handle in handles:
        os.close(handle)


@pytest.mark.parametrize("second", OWNERS)
@pytest.mark.parametrize("first", OWNERS)
def test_second_owner_of_a_port_is_rejected_in_one_line(port: str, first: str, second: str) -> None:
    close = OWNERS[first](port)
    with raises_code(DriverError, "driver", port) as refused:
        OWNERS[second](port)
    assert refused.value.reason == "not-opened"
    assert "\n" not in str(refused.value)
    close()
    OWNERS[second](port)()
