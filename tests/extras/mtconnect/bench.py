"""An adapter with agents at its port, on a clock that the test moves; a lathe's items, values by hand."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime, timedelta

from app.extras.mtconnect.driver.agent_links import ActiveCondition, ItemValue, MachineReport
from app.extras.mtconnect.driver.mtconnect_adapter import MtconnectAdapter, make_devices_xml
from app.extras.mtconnect.driver.mtconnect_items import Component, MachineLayout, make_machine_items
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from drivers.wakeups import ManualClock
from tests.extras.mtconnect.agent import FakeAgent

BEGIN = datetime(2026, 1, 31, 23, 59, 58, 500_000, tzinfo=UTC)
HEARTBEAT = 10.0
_TURNS = 60_000  # of a millisecond, or less


def lathe(name: str = "GT75") -> Component:
    """A gang-tool lathe whose spindle is C."""
    return make_machine_items(
        MachineLayout(("X", "Z"), (), "C", is_spindle_positionable=True, has_chuck=True), name
    )


class Bench:
    """``values`` and ``conditions`` are what the machine says at the next look."""

    def __init__(self, heartbeat: float = HEARTBEAT) -> None:
        self.clock = ManualClock()
        self.values: dict[str, ItemValue] = {"avail": "AVAILABLE", "execution": "READY", "Xabs": 1.0}
        self.conditions: dict[str, tuple[ActiveCondition, ...]] = {"system": (), "Xservo": ()}
        self.model = make_devices_xml(lathe(), "bench", BEGIN)
        self.agents: list[FakeAgent] = []
        self.adapter = MtconnectAdapter(
            MtconnectTable(port=0, heartbeat=heartbeat),
            tuple(lathe().iterate_items()),
            lambda: MachineReport(dict(self.values), dict(self.conditions)),
            self.clock,
            lambda: BEGIN + timedelta(seconds=self.clock.now()),
        )
        self.adapter.open()

    def agent(self, receive: int = 0) -> FakeAgent:
        """One more at the door, and served."""
        agent = FakeAgent(self.model, self.clock, receive)
        self.agents.append(agent)
        agent.connect(self.adapter.address)
        self.until(lambda: agent.interval is not None and agent.values["avail"] == "AVAILABLE")
        return agent

    def until(self, reached: Callable[[], bool]) -> None:
        """Adapter and agents take turns, the clock stands."""
        for _ in range(_TURNS):
            self._both()
            if reached():
                return
        raise AssertionError("it was never reached")

    def look(self) -> None:
        """One look of the adapter at the machine, and every agent has read what came of it."""
        self.clock.advance(0.1)
        mark = f"mark {self.clock.now():.3f}"
        self.values["program"] = mark
        self.until(lambda: all(a.wire is None or a.values["program"] == mark for a in self.agents))

    def silent_look(self) -> None:
        """A look at a machine on which nothing has changed."""
        self.clock.advance(0.1)
        self._both()

    def _both(self) -> None:
        self.adapter.run_once(0.001)
        for agent in self.agents:
            agent.read()

    def close(self) -> None:
        """Adapter, then agents."""
        self.adapter.close()
        for agent in self.agents:
            agent.hang_up()
