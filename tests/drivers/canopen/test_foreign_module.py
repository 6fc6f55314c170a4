"""Our terminals on an I/O module that is not ours, of the sizes that are sold: a byte of each, no pots."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator

import pytest

from core.faults import get_fault_code
from core.ports import DriverError
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import CanopenConfig, OutputConfig, PotConfig
from drivers.canopen.canopen_nodes import CanNode
from drivers.canopen.canopen_nodes import CanTerminal as Terminal
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.canopen_terminals import CanopenIO
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.canopen.foreign import NODE, ForeignModule

TICK = 0.01
_channels = itertools.count()
COOLANT, COLLET = Terminal("io", 0x6200, 1, 0), Terminal("io", 0x6200, 1, 1)
GUARD, ESTOP = Terminal("io", 0x6000, 1, 3), Terminal("io", 0x6000, 1, 0, is_active_low=True)


class Bench:
    """Both ends of the bus; the machine has a guard, E-stop, coolant, collet, and a pot where asked for."""

    def __init__(self, inputs: int, outputs: int, words: int, *, pot: int = 0) -> None:
        bus = CanopenTable(interface="virtual", channel=f"foreign-{next(_channels)}", mode="pvt")
        self.module = ForeignModule(bus.channel, inputs, outputs, words)
        self.clock = ManualClock()
        self.bus = CanBus(bus, self.clock, self.module.pump)
        self.io = CanopenIO(
            CanopenConfig(
                bus_settings=bus,
                axes=(),
                io_modules=(CanNode("io", NODE, 401),),
                inputs={"guard": GUARD, "estop": ESTOP} if inputs else {},
                outputs={"coolant": OutputConfig(COOLANT), "collet": OutputConfig(COLLET, None)}
                if outputs
                else {},
                pots={"feed_pot": PotConfig(Terminal("io", 0x6401, pot), 0.0, 1.5)} if pot else {},
            ),
            self.bus,
            {},
        )

    def start(self) -> None:
        self.io.connect()
        self.io.start_nodes()
        self.run(0.05)

    def run(self, seconds: float) -> str:
        """Time on both ends; what is wrong at last."""
        trouble = ""
        for _ in range(round(seconds / TICK)):
            self.clock.advance(TICK)
            for module in self.io.modules.values():
                module.record_sync()
            self.bus.send_sync()
            self.module.pump(TICK)
            self.bus.process_frames()
            trouble = self.io.run_cycle(self.clock.now())
            self.module.pump()
        return trouble

    def close(self) -> None:
        self.bus.close()
        self.module.close()


MakeBench = Callable[..., Bench]


@pytest.fixture
def make() -> Iterator[MakeBench]:
    made: list[Bench] = []

    def bench(inputs: int = 1, outputs: int = 1, words: int = 0, *, pot: int = 0) -> Bench:
        made.append(Bench(inputs, outputs, words, pot=pot))
        return made[-1]

    yield bench
    for each in made:
        each.close()


def test_outputs_are_sent_and_start_in_the_off_state(make: MakeBench) -> None:
    bench = make()
    bench.start()
    bench.io.write("coolant", is_on=True)
    assert bench.run(0.05) == ""
    assert bench.module.objects.read(0x6200, 1) == 0b01
    bench.io.write("collet", is_on=True)
    bench.io.switch_to_safe_state()
    bench.run(0.05)
    assert bench.module.objects.read(0x6200, 1) == 0b10  # coolant is off, the collet keeps its state


def test_inputs_are_read_with_the_next_sync(make: MakeBench) -> None:
    bench = make()
    bench.start()
    assert bench.io.inputs() == {"guard": False, "estop": True}  # no voltage on the wire: pressed
    bench.module.objects.write(0x6000, 1, 0b1001)
    bench.run(0.05)
    assert bench.io.inputs() == {"guard": True, "estop": False}


def test_safe_states_and_heartbeat_monitoring_are_written_to_the_module(make: MakeBench) -> None:
    bench = make()
    bench.start()
    read = bench.module.objects.read
    assert read(0x6206, 1) == 0b11111101  # the collet's bit keeps its state
    assert read(0x6207, 1) == 0
    assert read(0x1016, 1) == 127 << 16 | 300
    assert read(0x1017, 0) == 100


def test_override_pot_is_read_from_an_analog_input(make: MakeBench) -> None:
    bench = make(words=2, pot=2)
    bench.module.objects.write(0x6401, 2, 32767)
    bench.start()
    assert bench.module.objects.read(0x6423, 0) == 1
    assert bench.io.read_state().feed_pot == pytest.approx(1.5)


@pytest.mark.parametrize(("word", "fraction"), [(32767, 1.5), (0, 0.0), (-200, 0.0), (16384, 0.75)])
def test_pot_position_is_read_before_its_first_pdo(make: MakeBench, word: int, fraction: float) -> None:
    bench = make(words=2, pot=2)
    bench.module.objects.write(0x6401, 2, word)
    bench.io.connect()
    assert bench.io.read_state().feed_pot == pytest.approx(fraction, abs=1e-4)


@pytest.mark.parametrize(("inputs", "outputs", "words"), [(1, 0, 0), (0, 1, 0), (0, 1, 1), (8, 8, 4)])
def test_modules_with_any_number_of_terminals_run_without_faults(
    make: MakeBench, inputs: int, outputs: int, words: int
) -> None:
    bench = make(inputs, outputs, words)
    bench.start()
    assert bench.run(1.0) == ""
    assert bench.io.read_state().age < 0.2


def test_terminal_that_the_module_does_not_have_is_rejected(make: MakeBench) -> None:
    bench = make(words=1, pot=2)
    with raises_code(DriverError, "driver", "io: ", "6401.2"):
        bench.start()


def test_restarted_module_is_reported(make: MakeBench) -> None:
    bench = make()
    bench.start()
    bench.module.node.nmt.reset()
    fault = bench.run(0.05)
    assert get_fault_code(fault, "driver") == "io-silent"
    assert fault.startswith("io: ")


@pytest.mark.parametrize(("inputs", "why"), [(1, "SYNC"), (0, "heartbeat")])
def test_silent_module_is_reported(make: MakeBench, inputs: int, why: str) -> None:
    bench = make(inputs)
    bench.start()
    bench.module.objects.write(0x1017, 0, 0)  # no heartbeat
    bench.module.node.tpdo[0].enable = False
    assert why in bench.run(0.5)
    with raises_code(DriverError, "output", "coolant", "io: "):
        bench.io.write("coolant", is_on=True)


def test_fixed_pdo_mapping_is_accepted_if_it_is_the_right_one(make: MakeBench) -> None:
    bench = make()
    bench.module.fix_mapping()
    bench.start()
    bench.module.objects.write(0x6000, 1, 0b1000)
    bench.run(0.05)
    assert bench.io.inputs()["guard"]


def test_fixed_pdo_mapping_that_differs_is_rejected(make: MakeBench) -> None:
    bench = make(inputs=2)
    bench.module.fix_mapping()
    with raises_code(DriverError, "drive-setup", "io: node 10, object 1A00:0: "):
        bench.start()
