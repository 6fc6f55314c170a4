"""Driver host process, and the class that starts this process.

The command is ``python -m app.compose.backends.driver_host_process FD ZERO BELL``, with the pickled machine
on stdin.
"""

from __future__ import annotations

import gc
import pickle
import socket
import subprocess
import sys
from dataclasses import replace

from app.compose.backends.backend_entry import NO_PRIORITY_TEXT, find_backend, has_inverter
from app.compose.backends.inverter_backend import add_inverter
from core.machine.machine_model import Machine
from core.message import Message as Text
from core.ports import Clock, DriverError
from core.process_environment import make_module_environment
from drivers.canopen.canopen_nodes import CYCLIC_MODES, MAX_SYNC_DELAY_FRACTION
from drivers.canopen.canopen_table import CanopenTable
from drivers.driver_host.host_connection import HostConnection, HostLink, SocketLink, clear_drive_faults
from drivers.driver_host.host_loop import (
    TRIAL_TIME_S,
    lock_host_memory,
    measure_wakeup_delay,
    request_real_time_scheduling,
    run_driver_host,
)
from drivers.driver_host.host_messages import (
    NO_NUMBERS,
    Message,
    encode_message,
    make_fault_entries,
    read_fault,
)
from drivers.driver_host.host_server import DriverBundle
from drivers.wakeups import ConnectionAttempt, ProcessWakeup, RealClock


def create_host_drivers(machine: Machine, clock: Clock) -> DriverBundle:
    """Return the drivers of a machine's backend and spindle for the driver host.

    Raises DriverError if the driver host does not support the backend, or if a device cannot be connected.
    """
    make = find_backend(machine).create_drivers
    if make is None:
        raise DriverError(f"{machine.source}: the driver host does not support backend {machine.backend}")
    inner = make(machine, clock)
    if not has_inverter(machine):
        return inner
    ports, close = add_inverter(machine, inner.ports, clock, inner.close)
    # The inverter's thread does not wake the control, so its values are polled at this interval.
    return replace(
        inner,
        ports=ports,
        close=close,
        get_idle_time=lambda asleep: min(inner.get_idle_time(asleep), _INVERTER),
    )


_INVERTER = 0.05  # s between two polls of the inverter's values while the control is idle
_START_TIMEOUT_S = (
    20.0  # s until the first response, because the process must start and configure every drive
)
_END_TIMEOUT_S = 15.0  # s, because the spindle brakes for up to 8 s before HAL is shut down


class DriverHostProcess:
    """A driver host in a separate process, with the connection to the process.

    The process does not close the file descriptor ``lock_descriptor`` before it ends.
    """

    def __init__(self, machine: Machine, clock: RealClock, lock_descriptor: int | None = None) -> None:
        self._machine, self._clock = machine, clock
        self._held = () if lock_descriptor is None else (lock_descriptor,)
        self._closed = False
        self._bell = ProcessWakeup()  # retained when the driver host is restarted
        try:
            link = self._start_process()
        except DriverError:
            self._bell.close()
            raise
        self.connection = HostConnection(link, clock, self._restart, self._bell)

    def _restart(self) -> ConnectionAttempt[HostLink]:
        """Start a new process after the old one has ended, because a bus must never have two masters."""

        def start_new_host() -> HostLink:
            self._end()
            if self._closed:
                raise DriverError("the control is shutting down", "feeder-gone")
            return clear_drive_faults(self._start_process())

        return ConnectionAttempt(start_new_host)

    def _start_process(self) -> HostLink:
        """Start the process and return its link.

        Raises DriverError if its drivers report an error, if the process ends or does not respond within 20
        s, or if this object was closed in the meantime.
        """
        machine, clock = self._machine, self._clock
        ours, theirs = socket.socketpair()
        with theirs:
            command = [
                sys.executable,
                "-m",
                "app.compose.backends.driver_host_process",
                str(theirs.fileno()),
                repr(clock.origin_s),
                str(self._bell.remote_socket.fileno()),
            ]
            # A separate session, so that Ctrl-C reaches only the control, which then ends the driver host
            # properly.
            self.process = subprocess.Popen(
                command,
                env=make_module_environment(),
                stdin=subprocess.PIPE,
                pass_fds=(theirs.fileno(), self._bell.remote_socket.fileno(), *self._held),
                start_new_session=True,
            )
        assert self.process.stdin is not None
        with self.process.stdin as pipe:
            pipe.write(pickle.dumps(machine))
        self._link = SocketLink(ours)
        ready = self._read_first_message()
        if self._closed:  # closed during a restart
            self._end()
            raise DriverError("the control is shutting down", "feeder-gone")
        if why := read_fault(ready.header, "error", "feeder-gone"):
            self._end()
            raise DriverError(why)
        return self._link

    def close(self) -> None:
        """Make the driver host stop the machine and end, even while it is being restarted."""
        self._closed = True
        self._end()
        self._bell.close()

    def _end(self) -> None:
        self._link.close()
        try:
            self.process.wait(_END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def _read_first_message(self) -> Message:
        """Return the first message of the driver host.

        The message reports either readiness or the reason for a failure.
        """
        try:
            return self._link.wait_for_message(_START_TIMEOUT_S)
        except TimeoutError:
            why = "the driver host does not start"
        except EOFError:
            why = "the driver host ended during start-up; see its message above"
        except OSError as error:  # closed during the start
            why = f"no response from the driver host ({error.strerror})"
        return Message({"error": why}, NO_NUMBERS)


def get_setpoint_interval_s(machine: Machine) -> float:
    """Return the time between setpoints in seconds, or 0 if the drives accept late setpoints."""
    can = machine.hardware.find_driver_table(CanopenTable)
    return can.sync if can is not None and can.mode in CYCLIC_MODES else 0.0


def make_priority_warning(period_s: float, delay_s: float) -> str:
    """Return the warning that the driver host does not have real-time priority.

    ``period_s`` is the time between setpoints, and ``delay_s`` is the largest delay in the test, both in
    seconds.
    """
    template = (
        (
            "{cause}, a SYNC every {period} ms is not reliable, even though the SYNC arrived in "
            "time in a {seconds} s test (at most {late} ms late). If setpoints are late, the "
            "path waits, and a delay of 10 ms causes an alarm. Give the driver host real-time "
            'priority (docs/integrator/computer.md), or use mode = "pvt"'
        )
        if delay_s <= MAX_SYNC_DELAY_FRACTION * period_s
        else (
            "{cause}, a SYNC every {period} ms is not reliable: in a {seconds} s test, the SYNC "
            "did not arrive in time (up to {late} ms late). If setpoints are late, the path "
            "waits, and a delay of 10 ms causes an alarm. Give the driver host real-time "
            'priority (docs/integrator/computer.md), or use mode = "pvt"'
        )
    )
    return Text(
        template,
        cause=NO_PRIORITY_TEXT,
        period=f"{1000 * period_s:g}",
        seconds=f"{TRIAL_TIME_S:g}",
        late=f"{1000 * delay_s:.1f}",
    )


def main(arguments: list[str]) -> int:
    """Connect the drivers, report the result, and process requests until the control disconnects."""
    sock = socket.socket(fileno=int(arguments[0]))
    clock: Clock = RealClock(float(arguments[1]))
    machine = pickle.load(sys.stdin.buffer)  # from the parent process, over a pipe that no other process has
    warnings = request_real_time_scheduling()
    locked = lock_host_memory()
    if warnings and (period := get_setpoint_interval_s(machine)):
        warnings.append(make_priority_warning(period, measure_wakeup_delay(period)))
    try:
        machine_driven = create_host_drivers(machine, clock)
    except DriverError as error:
        sock.sendall(
            encode_message(Message(make_fault_entries("error", error.fault, "feeder-gone"), NO_NUMBERS))
        )
        return 1
    if machine_driven.get_next_tick_time() is None:
        locked = lock_host_memory()
    else:  # a garbage collection could take 0.1 s, which is longer than drives wait for a setpoint
        gc.freeze()
    warnings += locked
    sock.sendall(encode_message(Message({"ready": True}, NO_NUMBERS)))
    bell = socket.socket(fileno=int(arguments[2]))
    run_driver_host(sock, machine_driven, warnings, machine.hardware.refresh_timeouts_s, bell)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
