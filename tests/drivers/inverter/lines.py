"""A pty with an inverter at its end: a pymodbus server, or the scripted Huanyang; in a thread of its own."""

from __future__ import annotations

import asyncio
import os
import select
import threading
import tty
from collections.abc import Callable
from types import TracebackType

from pymodbus.constants import ExcCodes
from pymodbus.server import ModbusSerialServer
from pymodbus.simulator import DataType, SimData, SimDevice

from drivers.wakeups import RealClock
from tests.drivers.inverter.inverter_simulators import (
    HitachiMemory,
    HuanyangSlave,
    Inverter,
    Memory,
    MyDriveMemory,
    MyDriveSlave,
    RefusedByDeviceError,
)
from tests.drivers.ptys import open_pty
from tests.late_computer import told_late

WAIT = 60.0  # s for what must happen at once on a computer that is not busy
IN_VAIN = 10.0  # s behind a stall of it, which an inverter has taken for silence


class Pair:
    """Two ends of a line: ``near`` for the driver, ``far`` for the peer; bytes go over by a thread.

    ``cut`` pulls the cable: the driver's end fails as a USB adapter does that is pulled out.
    """

    def __init__(self) -> None:
        self._masters: list[int] = []
        self._slaves: list[int] = []
        names = []
        for _ in range(2):
            master, slave = open_pty()
            tty.setraw(master)
            tty.setraw(slave)
            self._masters.append(master)
            self._slaves.append(slave)
            names.append(os.ttyname(slave))
        self.near, self.far = names
        self.silent = False
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._carry, name="cable")

    def __enter__(self) -> Pair:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
        self._thread.join(WAIT)
        for handle in (*self._masters, *self._slaves):
            try:
                os.close(handle)
            except OSError:
                continue  # cut

    def cut(self) -> None:
        """Pull the cable out of the driver's adapter."""
        self._ended.set()
        self._thread.join(WAIT)
        os.close(self._masters[0])
        os.close(self._slaves[0])

    def _carry(self) -> None:
        one, other = self._masters
        while not self._ended.is_set():
            ready, _, _ = select.select((one, other), (), (), 0.05)
            for handle in ready:
                data = os.read(handle, 4096)
                if not self.silent:
                    os.write(other if handle == one else one, data)


class ModbusServer:
    """pymodbus on one end of a line; its registers are an inverter's memory."""

    def __init__(self, port: str, memory: Memory) -> None:
        self._port, self._memory = port, memory
        self._loop = asyncio.new_event_loop()
        self._up = threading.Event()
        self._thread = threading.Thread(target=self._run, name="pymodbus")
        self._server: ModbusSerialServer | None = None

    def __enter__(self) -> ModbusServer:
        self._thread.start()
        assert self._up.wait(WAIT)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._server is not None
        asyncio.run_coroutine_threadsafe(self._shut(self._server), self._loop)
        self._thread.join(WAIT)
        self._loop.close()

    def _run(self) -> None:
        self._loop.run_until_complete(self._serve())

    async def _shut(self, server: ModbusSerialServer) -> None:
        await server.shutdown()  # type: ignore[no-untyped-call]  # pymodbus has types elsewhere

    async def _serve(self) -> None:
        self._server = ModbusSerialServer(self._device(), port=self._port, baudrate=9600)
        await self._server.serve_forever(background=True)
        self._up.set()
        await self._server.serving

    def _device(self) -> SimDevice:
        words = [SimData(0, values=0, count=0x3000, datatype=DataType.REGISTERS)]
        bits = [SimData(0, values=False, count=64, datatype=DataType.BITS)]
        if isinstance(self._memory, HitachiMemory):
            return SimDevice(1, simdata=(bits, bits, words, words), action=self._act)
        return SimDevice(1, simdata=words, action=self._act)

    async def _act(
        self,
        function_code: int,
        start_address: int,
        address: int,
        count: int,
        current_registers: list[int],
        set_values: list[int] | list[bool] | None,
    ) -> ExcCodes | None:
        """Reads show the memory, writes go there; a write's answer is read from what it has left."""
        if isinstance(self._memory, MyDriveMemory) and function_code not in MyDriveSlave.functions:
            return ExcCodes.ILLEGAL_FUNCTION
        try:
            if set_values is not None:
                for n, value in enumerate(set_values):
                    if function_code in (5, 15):
                        self._memory.set_coil(address + n, bool(value))
                    else:
                        self._memory.set_word(address + n, int(value))
            elif function_code in (3, 4):
                for n in range(address, address + count):
                    current_registers[n - start_address] = self._memory.word(n)
            elif function_code in (1, 2):
                for n in range(address // 16, address // 16 + count):
                    bits = sum(1 << bit for bit in range(16) if self._memory.coil(16 * n + bit))
                    current_registers[n - start_address] = bits
        except RefusedByDeviceError as refused:
            return ExcCodes(int(str(refused)))
        return None


class HuanyangEnd:
    """Answers each frame at the end of a line; a frame is whole when its length says so."""

    def __init__(self, port: str, slave: HuanyangSlave) -> None:
        self._slave = slave
        self._handle = os.open(port, os.O_RDWR | os.O_NOCTTY)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="huanyang")

    def __enter__(self) -> HuanyangEnd:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
        self._thread.join(WAIT)
        os.close(self._handle)

    def _run(self) -> None:
        come = b""
        while not self._ended.is_set():
            ready, _, _ = select.select((self._handle,), (), (), 0.05)
            if not ready:
                come = b""
                continue
            come += os.read(self._handle, 256)
            if len(come) >= 3 and len(come) >= come[2] + 5:
                os.write(self._handle, self._slave.answer(come[: come[2] + 5]))
                come = b""


def until(ready: Callable[[], bool], what: str) -> None:
    """Wait for it, within the deadline."""
    tick, clock = threading.Event(), RealClock()
    while not ready():
        assert clock.now() < (IN_VAIN if told_late() else WAIT), f"not within {WAIT} s: {what}"
        tick.wait(0.01)


def inverter() -> Inverter:
    """One on real time."""
    return Inverter(RealClock())
