"""Agents that come, go, stay away, talk nonsense or do not read: none of them holds up the others."""

from __future__ import annotations

import re
import socket
from functools import partial

import pytest

from app.extras.mtconnect.driver.agent_links import (
    MAX_UNSENT_BYTES,
    READ_BYTES,
    ActiveCondition,
    AgentLink,
    MachineReport,
)
from app.extras.mtconnect.driver.mtconnect_adapter import MAX_AGENTS, MtconnectAdapter
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from core.ports import DriverError
from drivers.wakeups import ManualClock
from tests.extras.mtconnect.bench import HEARTBEAT, Bench
from tests.texts import shows


def test_agent_gets_the_complete_state_and_then_the_changes(bench: Bench) -> None:
    agent = bench.agent()
    assert (agent.values["execution"], agent.values["Xabs"]) == ("READY", "1.0000")
    assert agent.values["Zabs"] == "UNAVAILABLE"
    assert (agent.active["system"], agent.active["comms"]) == ({}, None)
    before = len(agent.lines)
    bench.values["execution"] = "ACTIVE"
    bench.look()
    assert agent.lines[before:] == ["2026-01-31T23:59:58.600Z|execution|ACTIVE|program|mark 0.100"]
    assert (agent.unknown, agent.bad) == ([], [])


def test_unchanged_state_sends_nothing(bench: Bench) -> None:
    agent = bench.agent()
    before = len(agent.lines)
    for _ in range(50):
        bench.silent_look()
    assert agent.lines[before:] == []


def test_ping_replies_keep_the_agent_of_an_idle_machine_connected(bench: Bench) -> None:
    agent = bench.agent()
    assert agent.interval == HEARTBEAT
    for _ in range(600):  # a minute: the agent hangs up after twice ten seconds of silence
        bench.silent_look()
        bench.until(lambda: True)
    assert agent.wire is not None
    assert 6 <= agent.lines.count("* PONG 10000") <= 7


def test_conditions_are_set_and_cleared_individually(bench: Bench) -> None:
    agent = bench.agent()
    one, other = ActiveCondition("FAULT", "101", "X: over current"), ActiveCondition("FAULT", "102", "X lags")
    bench.conditions["Xservo"] = (one, other)
    bench.look()
    assert agent.active["Xservo"] == {
        "101": ("FAULT", one.condition_text),
        "102": ("FAULT", other.condition_text),
    }
    bench.conditions["Xservo"] = (other,)
    bench.look()
    assert agent.active["Xservo"] == {"102": ("FAULT", other.condition_text)}
    late = bench.agent()  # one that comes now
    assert late.active["Xservo"] == agent.active["Xservo"]
    bench.conditions["Xservo"] = ()
    bench.look()
    assert agent.active["Xservo"] == late.active["Xservo"] == {}


def test_reconnected_agent_gets_the_complete_state_again(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    agent = bench.agent()
    bench.values["execution"] = "ACTIVE"
    bench.look()
    agent.hang_up()
    assert agent.values["execution"] == "UNAVAILABLE"
    bench.until(lambda: bench.adapter.agent_count == 0)
    agent.connect(bench.adapter.address)
    bench.until(lambda: agent.values["execution"] == "ACTIVE")
    assert bench.adapter.counts.accepted_count == 2
    assert caplog.records == []  # agents come and go: nothing to write down


def test_two_agents_receive_the_same_data(bench: Bench) -> None:
    agents = bench.agent(), bench.agent()
    bench.values["Xabs"] = -12.34567
    bench.look()
    assert [agent.values["Xabs"] for agent in agents] == ["-12.3457"] * 2


@pytest.mark.parametrize(
    "said",
    [
        b"* STOP\n",
        b"execution|STOPPED\n",
        b"\x00\xff\xfe\x80\n",
        b"GET /current HTTP/1.1\r\nHost: lathe\r\n\r\n",
        b"* PINGPING\n* PONG 5\n",
        b"\n\n\r\n \n",
    ],
)
def test_lines_other_than_pings_are_counted_and_ignored(bench: Bench, said: bytes) -> None:
    agent, other = bench.agent(), bench.agent()
    before = dict(agent.values), len(agent.lines)
    agent.send(said)
    agent.send(b"* PING\r\n")
    bench.until(lambda: len(agent.lines) > before[1])
    assert agent.lines[before[1] :] == ["* PONG 10000"]
    assert (agent.values, other.values) == (before[0], before[0])
    agent.hang_up()
    bench.until(lambda: bench.adapter.agent_count == 1)
    assert bench.adapter.counts.ignored_line_count == len(
        [line for line in said.split(b"\n") if line.strip()]
    )


def test_ping_may_arrive_in_pieces(bench: Bench) -> None:
    agent = bench.agent()
    before = len(agent.lines)
    for piece in (b"* P", b"IN", b"G\r"):
        agent.send(piece)
        bench.silent_look()
    assert len(agent.lines) == before
    agent.send(b"\n")
    bench.until(lambda: len(agent.lines) > before)
    assert agent.lines[-1] == "* PONG 10000"


def test_flood_of_lines_does_not_delay_other_agents(bench: Bench) -> None:
    flooding, other = bench.agent(), bench.agent()
    flooding.send(b"nonsense\n" * 5000)  # 45 kB
    bench.values["execution"] = "ACTIVE"
    bench.look()
    assert other.values["execution"] == "ACTIVE"
    flooding.send(b"* PING\n")
    before = flooding.lines.count("* PONG 10000")
    bench.until(lambda: flooding.lines.count("* PONG 10000") > before)  # all of it was taken, bit by bit
    assert bench.adapter.agent_count == 2


def test_at_most_one_kilobyte_is_read_from_an_agent_at_a_time() -> None:
    near, far = socket.socketpair()
    with near, far:
        near.setblocking(False)
        far.sendall(b"x\n" * 2000)
        link = AgentLink(near, HEARTBEAT)
        link.read_data(0.0)
        assert link.ignored_line_count == READ_BYTES // 2
        for _ in range(10):
            link.read_data(0.0)
        assert link.ignored_line_count == 2000


def test_agent_that_sends_no_line_ends_is_disconnected(bench: Bench) -> None:
    flooding, other = bench.agent(), bench.agent()
    flooding.send(b"x" * 8192)
    bench.until(lambda: flooding.wire is None)
    bench.look()
    assert other.wire is not None
    assert (bench.adapter.agent_count, bench.adapter.counts.lost_count) == (1, 1)


def test_agent_that_does_not_read_is_dropped_and_the_other_gets_all(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    slow, other = bench.agent(receive=4096), bench.agent()
    bench.agents.remove(slow)  # connected, and never reads again
    looks = 0
    while bench.adapter.agent_count == 2:
        bench.values["block"] = f"N{looks} " + "X" * 240
        if looks % 50 == 0:
            slow.send(b"* PING\n")  # it is there, and it is not its silence that ends it
        bench.look()
        looks += 1
        assert looks < 40 * MAX_UNSENT_BYTES // 240
    assert shows(caplog.text, "drivers.agent-does-not-read")
    assert other.values["block"].startswith(f"N{looks - 1} ")
    slow.hang_up()


def test_vanished_computer_is_detected_by_missing_pings(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    gone, other = bench.agent(), bench.agent()
    bench.agents.remove(gone)  # no FIN, no RST: its plug was pulled
    for _ in range(205):
        bench.silent_look()
    assert bench.adapter.agent_count == 2
    for _ in range(10):  # past two heartbeats and one second
        bench.silent_look()
    assert bench.adapter.agent_count == 1
    assert re.search("PING .*21 s", caplog.text)
    assert other.wire is not None
    gone.hang_up()


def test_terminal_client_need_not_ping(bench: Bench) -> None:
    with socket.create_connection(bench.adapter.address, 60.0) as wire:
        bench.until(lambda: bench.adapter.agent_count == 1)
        for _ in range(1000):
            bench.silent_look()
        assert bench.adapter.agent_count == 1
        assert b"|execution|READY|" in wire.recv(65536)


def test_connection_closed_before_accept_is_harmless(bench: Bench) -> None:
    for _ in range(20):
        wire = socket.create_connection(bench.adapter.address, 60.0)
        wire.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\x01\x00\x00\x00\x00\x00\x00\x00")
        wire.close()  # a reset instead of an end
        bench.silent_look()
    bench.until(lambda: bench.adapter.agent_count == 0)
    assert bench.agent().values["execution"] == "READY"


def test_number_of_agents_is_limited(bench: Bench) -> None:
    for _ in range(MAX_AGENTS):
        bench.agent()
    with socket.create_connection(bench.adapter.address, 60.0) as wire:
        wire.sendall(b"* PING\n")
        bench.until(lambda: bench.adapter.counts.rejected_count == 1)
        assert b"|" not in wire.recv(100)  # nothing of the machine
    bench.agents[0].hang_up()
    bench.until(lambda: bench.adapter.agent_count == MAX_AGENTS - 1)
    bench.agent()


def _serves(bench: Bench, count: int) -> bool:
    return bench.adapter.agent_count == count


def test_pinging_agent_replaces_a_client_that_never_pinged(bench: Bench) -> None:
    """Half-open connections and port scanners must not lock the agents out."""
    silent = []
    for taken in range(1, MAX_AGENTS + 1):
        silent.append(socket.create_connection(bench.adapter.address, 60.0))
        bench.until(partial(_serves, bench, taken))
    agents = [bench.agent() for _ in range(MAX_AGENTS)]
    assert all(agent.values["execution"] == "READY" for agent in agents)
    assert bench.adapter.agent_count == MAX_AGENTS
    assert bench.adapter.counts.lost_count == MAX_AGENTS
    for wire in silent:
        wire.close()


def test_waiting_client_that_never_pings_is_disconnected(bench: Bench) -> None:
    for _ in range(MAX_AGENTS):
        bench.agent()
    with socket.create_connection(bench.adapter.address, 60.0) as wire:
        bench.until(lambda: len(bench.adapter._links) == MAX_AGENTS + 1)
        for _ in range(51):
            bench.silent_look()
        assert wire.recv(100) == b""
    assert bench.adapter.agent_count == MAX_AGENTS


def test_close_disconnects_all_agents() -> None:
    bench = Bench()
    agents = bench.agent(), bench.agent()
    address = bench.adapter.address
    bench.close()
    assert [agent.wire for agent in agents] == [None, None]
    with pytest.raises(ConnectionError):
        socket.create_connection(address, 60.0)


def refusing(bind: str, port: int) -> str:
    adapter = MtconnectAdapter(
        MtconnectTable(bind=bind, port=port), (), lambda: MachineReport({}, {}), ManualClock()
    )
    with pytest.raises(DriverError) as caught:
        adapter.open()
    adapter.close()
    return str(caught.value)


def test_port_in_use_is_reported_with_a_remedy(bench: Bench) -> None:
    _, port = bench.adapter.address
    told = refusing("127.0.0.1", port)
    for value in ("[mtconnect]", "127.0.0.1", str(port)):
        assert value in told


@pytest.mark.parametrize("bind", ["192.0.2.1", "no such host", "300.1.1.1"])
def test_bind_address_not_on_this_computer_is_reported(bind: str) -> None:
    assert bind in refusing(bind, 0)
