"""A machine at work into whose wire somebody speaks: frames on the CAN bus, lines of the controller."""

from __future__ import annotations

import random
from collections.abc import Iterable

import can

from core.executor.snapshot import ACTIVE_STATES, MachineState
from core.ports import DriverError
from tests.drivers.canopen.bench import CanBench
from tests.drivers.grblhal.bench import GrblBench
from tests.drivers.machines import ramp
from tests.fuzz.fuzz_target import Target

_STANDS = 1e-9  # mm
_FRAME = 4  # bytes before those of a frame: identifier, how long, how many ticks later
_PROGRAM = "G90G94F300\nT1\nX.3Z.3\nG01X.4F60\nZ.2\nX.3Z.3\nM30\n"


# --- frames on the bus --------------------------------------------------------------------------------------


def _frames(data: bytes) -> Iterable[str]:
    """Whatever comes nothing is raised, and a fault stops all: the slides stand a second later."""
    bench = CanBench()
    try:
        axes = bench.machine.axes
        axes.enable(True)
        axes.splice(ramp(bench.clock.now() + 0.15, (0.0, 0.0, 0.0), 60.0, 0.3))
        bench.run(0.2)
        for cob, payload, ticks in _messages(data):
            assert bench.peers.network.bus is not None
            bench.peers.network.bus.send(
                can.Message(arbitration_id=cob & 0x7FF, data=payload, is_extended_id=False)
            )
            for _ in range(ticks):
                bench.tick()
        bench.run(1.0)
        sample = axes.sample()
        assert not (sample.fault and sample.enabled), f"enabled with {sample.fault}"
        before = bench.peers.machine.get_true_positions()
        bench.run(0.1)
        after = bench.peers.machine.get_true_positions()
        assert max(abs(a - b) for a, b in zip(before, after, strict=True)) < _STANDS, "a slide moves on"
        return [sample.fault] if sample.fault else []
    finally:
        bench.close()


def _messages(data: bytes) -> Iterable[tuple[int, bytes, int]]:
    while len(data) >= _FRAME:
        long = data[2] % 9
        yield int.from_bytes(data[:2], "big"), data[_FRAME : _FRAME + long], data[3] % 4
        data = data[_FRAME + long :]


_COBS = (
    0x000,
    0x080,
    0x081,
    0x082,
    0x083,
    0x181,
    0x182,
    0x281,
    0x282,
    0x381,
    0x581,
    0x582,
    0x583,
    0x701,
    0x702,
)


def _another_frame(data: bytes, chance: random.Random) -> bytes:
    cob, long = chance.choice(_COBS) + chance.randrange(2), chance.randrange(9)
    frame = bytes([cob >> 8, cob & 255, long, chance.randrange(4)]) + chance.randbytes(long)
    return (data + frame)[-20 * (_FRAME + 8) :]


CAN = Target(
    "CAN frames",
    lambda: (
        b"\x00\x81\x01\x01\x01",
        b"\x05\x81\x08\x01\x80\x40\x60\x00\x00\x00\x06\x04",
        b"\x07\x01\x00\x01",
    ),
    _frames,
    (),
    _another_frame,
)


# --- lines of a controller ----------------------------------------------------------------------------------


def _spoken_into(data: bytes) -> Iterable[str]:
    """A program runs; bytes come between those of the controller. Nothing is raised inside the executor."""
    bench = GrblBench()
    bench.ready()
    bench.start(_PROGRAM)
    for part in data.split(b"\0"):
        bench.wire.read = _once(bench, part)  # type: ignore[method-assign]
        bench.run(0.05)
    bench.run(2.0)
    wrong = [alarm for alarm in bench.shot.alarms if alarm.code == "internal"]
    assert not wrong, wrong[0]
    assert bench.state is not MachineState.FAULT or bench.shot.alarms, "an alarm without its sentence"
    assert bench.state in ACTIVE_STATES | {
        MachineState.IDLE,
        MachineState.FAULT,
        MachineState.HOLD,
        MachineState.DISABLED,
        MachineState.ESTOP,
    }
    return [alarm.cause for alarm in bench.shot.alarms]


def _once(bench: GrblBench, part: bytes):  # type: ignore[no-untyped-def]
    waiting = [part]

    def read() -> bytes:
        return (waiting.pop() if waiting else b"") + bench.peer.pop_output()

    return read


_WORDS = (
    b"ok\r\n", b"error:20\r\n", b"ALARM:1\r\n", b"<Idle|MPos:1.000,2.000|FS:0,0>\r\n", b"<Run|MPos:",
    b"[MSG:x]\r\n", b"\xff\xfe", b"\0", b"9" * 300, b"<Run|Ov:|H:1|Pn:E|MPos:0,0,0>\r\n",
    b"<Hold:0|MPos:0.000,0.000,0.000|Bf:99999,1>\r\n", b"GrblHAL 1.1f ['$' or '$HELP' for help]\r\n",
    b"<Alarm:11|MPos:nan,0,0>\r\n", b"<Idle|WPos:1,2,3>\r\n",
)  # fmt: skip


def _another_word(data: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(data) + 1)
    return (data[:at] + chance.choice(_WORDS) + data[at:])[:2000]


GRBLHAL = Target("grblHAL's wire", lambda: _WORDS, _spoken_into, (DriverError,), _another_word)
