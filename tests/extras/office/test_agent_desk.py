"""Machines of any builder on the page for the office, as an MTConnect agent tells of them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from app.compose.machine.machine_files import parse_machine
from app.extras.office.other_machines import (
    make_current_state_address,
    parse_mtconnect_streams,
    read_agent_status,
)
from core.extras.office.shop_network_tables import StatusPageTable
from core.table_schema import MachineFileError
from resources import read_machine_file
from tests.texts import text

# As the standard has it (part 3, Streams); versions differ in the name space alone.
STREAMS = """<?xml version="1.0" encoding="UTF-8"?>
<MTConnectStreams xmlns="urn:mtconnect.org:MTConnectStreams:{version}">
 <Header creationTime="2026-11-28T18:00Z" sender="shop-pc" instanceId="1" version="2.5.0.11"
  nextSequence="120" firstSequence="1" lastSequence="119"/>
 <Streams><DeviceStream name="MILL4" uuid="mill-4">
  <ComponentStream component="Device" name="MILL4" componentId="d"><Events>
   <Availability dataItemId="avail" timestamp="2026-11-28T17:00Z" sequence="3">{available}</Availability>
  </Events></ComponentStream>
  <ComponentStream component="Controller" name="controller" componentId="c"><Events>
   <EmergencyStop dataItemId="estop" timestamp="2026-11-28T17:00Z" sequence="9">{estop}</EmergencyStop>
  </Events><Condition>{condition}</Condition></ComponentStream>
  <ComponentStream component="Path" name="path" componentId="p"><Events>
   <Execution dataItemId="exec" timestamp="2026-11-28T17:59Z" sequence="99">{execution}</Execution>
   <PartCount dataItemId="bad" subType="BAD" timestamp="2026-11-28T17:59Z" sequence="100">3</PartCount>
   <PartCount dataItemId="all" subType="ALL" timestamp="2026-11-28T17:59Z" sequence="101">{count}</PartCount>
   <Program dataItemId="pgm" timestamp="2026-11-28T17:59Z" sequence="102">O4711</Program>
   <LineNumber dataItemId="ln" subType="ABSOLUTE" timestamp="2026-11-28T17:59Z" sequence="103">88</LineNumber>
  </Events></ComponentStream>
 </DeviceStream></Streams>
</MTConnectStreams>
"""
FAULT = (
    '<Fault dataItemId="x" timestamp="2026-11-28T17:59Z" sequence="50" nativeCode="410" type="POSITION">'
    "{}</Fault>"
)
WELL = {
    "version": "1.3", "available": "AVAILABLE", "estop": "ARMED", "execution": "ACTIVE", "count": "57",
    "condition": '<Normal dataItemId="x" timestamp="2026-11-28T17:59Z" sequence="50" type="POSITION"/>',
}  # fmt: skip


def streams(**told: str) -> bytes:
    return STREAMS.format(**{**WELL, **told}).encode()


@pytest.mark.parametrize("version", ["1.3", "2.5"])
def test_running_machine_is_parsed(version: str) -> None:
    found, trouble = parse_mtconnect_streams(streams(version=version))
    assert found == {"machine": "MILL4", "state": "RUNNING", "program": "O4711", "line": 88, "made": 57}
    assert trouble == ""


@pytest.mark.parametrize(
    ("told", "state"),
    [
        ({"execution": "FEED_HOLD"}, "FEED HOLD"),
        ({"execution": "PROGRAM_COMPLETED"}, "READY"),
        ({"execution": "INTERRUPTED"}, "INTERRUPTED"),
        ({"execution": "UNAVAILABLE"}, "UNAVAILABLE"),
        ({"estop": "TRIGGERED", "execution": "ACTIVE"}, "E-STOP"),
        ({"condition": FAULT.format("")}, "ALARM"),
    ],
)
def test_machine_state_is_parsed(told: dict[str, str], state: str) -> None:
    found, _ = parse_mtconnect_streams(streams(**told))
    assert found is not None
    assert found["state"] == state


def test_alarm_text_is_parsed() -> None:
    found, trouble = parse_mtconnect_streams(
        streams(condition=FAULT.format("X servo\n  excess error &lt;x&gt;"))
    )
    assert found is not None
    assert (found["state"], trouble) == ("ALARM", "X servo excess error <x>")


def test_unavailable_machine_has_no_status() -> None:
    assert parse_mtconnect_streams(streams(available="UNAVAILABLE")) == (
        None,
        text("shopfloor.agent-hears-nothing"),
    )


@pytest.mark.parametrize("count", ["UNAVAILABLE", "-3", "1e9", "", "9" * 4000, "٣"])
def test_invalid_count_is_omitted(count: str) -> None:
    found, _ = parse_mtconnect_streams(streams(count=count))
    assert found is not None
    assert "made" not in found


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b'{"state": "READY"}',
        b"<html><body>no agent</body></html>",
        streams()[:-200],
        b'<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><x>&b;</x>',
        b"<a>" * 100_000,
    ],
)
def test_invalid_agent_response_raises_value_error(data: bytes) -> None:
    with pytest.raises(ValueError, match=r".*"):
        parse_mtconnect_streams(data)


# --- asked over the wire ----------------------------------------------------------------------------


@contextmanager
def agent(answer: Callable[[str], tuple[int, bytes]]) -> Iterator[str]:
    """What answers at an address; its answer goes by the path that was asked for."""

    class Answers(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            code, body = answer(self.path)
            self.send_response(code)
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_words: object) -> None:
            pass

    server = HTTPServer(("127.0.0.1", 0), Answers)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    thread.join()
    server.server_close()


def test_agent_is_queried_for_one_machine() -> None:
    def answer(path: str) -> tuple[int, bytes]:
        return (200, streams()) if path == "/MILL4/current" else (404, b"<MTConnectError/>")

    with agent(answer) as address:
        heard, unknown = read_agent_status(f"{address}/MILL4"), read_agent_status(f"{address}/MILL5/")
    assert heard.status_document is not None
    assert heard.status_document["made"] == 57
    assert unknown.status_document is None
    assert unknown.address == f"{address.removeprefix('http://')}/MILL5"
    assert unknown.error_text == text("shopfloor.answers", answer="404 Not Found")


def test_server_that_is_not_an_agent_is_reported() -> None:
    with agent(lambda _path: (200, b"<html>")) as address:
        assert read_agent_status(f"{address}/MILL4").error_text == text("shopfloor.no-desk")


def test_current_state_address_is_derived_from_the_machine_address() -> None:
    assert make_current_state_address("http://shop-pc:5000/MILL4/") == "http://shop-pc:5000/MILL4/current"


# --- in the machine file ----------------------------------------------------------------------------


def page_table(keys: str) -> StatusPageTable:
    table = parse_machine(
        f"{read_machine_file('gt75.toml')}[status_page]\n{keys}\n", "m.toml"
    ).hardware.find_driver_table(StatusPageTable)
    assert table is not None
    return table


def test_machine_file_lists_machines_by_agent_address() -> None:
    table = page_table('agents = ["http://shop-pc:5000/MILL4", "https://shop-pc/mtc/MILL5"]')
    assert table.agent_addresses == ("http://shop-pc:5000/MILL4", "https://shop-pc/mtc/MILL5")


@pytest.mark.parametrize("address", ["http://shop-pc:5000", "http://shop-pc:5000/", "shop-pc:5000/MILL4"])
def test_agent_address_without_a_machine_is_rejected(address: str) -> None:
    with pytest.raises(MachineFileError, match=r"status_page\.agents = "):
        page_table(f'agents = ["{address}"]')


@pytest.mark.parametrize(
    "keys",
    ['desks = ["http://[lathe2"]', 'desks = ["http://lathe2:port"]', 'desks = ["http://"]'],
)
def test_invalid_status_page_address_is_rejected(keys: str) -> None:
    """Else the desk ended with a traceback when it began to ask."""
    with pytest.raises(MachineFileError, match=r"status_page\.desks = "):
        page_table(keys)
