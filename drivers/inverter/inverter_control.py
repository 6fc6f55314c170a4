"""The control of an inverter on its line: commands and polling.

``InverterControl.run_exchange`` is one exchange. ``InverterThread`` repeats it, and tests call it directly.
A stop has priority over all other requests and waits at most for the response in progress.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from core.message import Message
from core.ports import Clock, DriverError, Fault, FaultCode
from drivers.inverter.command_monitor import STANDSTILL_HZ, InverterCommandMonitor, append_estop_instruction
from drivers.inverter.inverter_family import InverterFamily, InverterState
from drivers.inverter.modbus_rtu import NoResponseError, RequestRejectedError, RequestWithheldError
from drivers.serial_line import SerialLineError

SILENCE_TIMEOUT_S = 1.0  # Seconds without a response after which the inverter counts as lost.
MAX_SILENCE_S = SILENCE_TIMEOUT_S + 0.5  # Seconds after which the exchange itself has reported the silence.
_PARTIAL_RESPONSE_S = (
    2.0  # Seconds after a poll in which single responses count, before the next poll must be complete.
)
_RETRY_DELAY_S = 1.0  # Seconds between two attempts to open a lost port.
_MAX_POLLS = 60  # Polls until the inverter must be trusted.
_RESTART_TIME_S = 3.0  # Seconds in which an inverter may be silent after a reset.


@dataclass(frozen=True, slots=True)
class PolledState:
    """State of the inverter from the last poll, with the time of the poll.

    When the poll began, all commands that were issued before ``command_cutoff_time_s`` had been sent.
    """

    time_s: float
    inverter_state: InverterState
    command_cutoff_time_s: float = 0.0


class InverterControl:
    """Control of the inverter, which owns its serial line.

    Any thread may set ``commanded_hz``; everything else may be used only by the thread of ``run_exchange``.
    ``open_line`` opens the line and returns the inverter, or raises DriverError. ``setpoint_step_hz`` is
    the resolution of the reported setpoint in Hz.
    """

    def __init__(
        self,
        open_line: Callable[[], InverterFamily],
        clock: Clock,
        comm_timeout_s: float,
        max_hz: float,
        setpoint_step_hz: float = 0.01,
    ) -> None:
        self._open, self._clock = open_line, clock
        self._comm_loss, self._highest, self._step = comm_timeout_s, max_hz, setpoint_step_hz
        self._want = 0.0
        self._told: float | None = None  # None: no command since the line was opened.
        self._stops = self._stopped = 0  # Number of commanded stops, and of those that the inverter has.
        self._obedience = InverterCommandMonitor(self._step)
        self._family: InverterFamily | None = None
        self._retry = 0.0
        self._began = self._began_before = clock.now()  # Start times of the present and the last exchange.
        self._answered = clock.now()  # Time of the last response in an exchange without an error.
        self._reset = False
        self.silence_allowed_until = 0.0  # Silence is permitted until this time.
        self.last_poll: PolledState | None = None
        self.failure: Fault | str = ""  # Latched until ``clear_fault``.
        self.exchange_error = ""  # Reason why the last exchange failed.
        self.warnings: tuple[str, ...] = ()

    @property
    def commanded_hz(self) -> float:
        """Return the commanded frequency in Hz, with its sign.

        A fault sets it permanently to 0.
        """
        return 0.0 if self.failure else self._want

    @commanded_hz.setter
    def commanded_hz(self, hz: float) -> None:
        if hz == 0.0 and self._want != 0.0:
            self._stops += 1  # The stop is sent even if a start follows before the next exchange.
        self._want = hz

    @property
    def is_inverter_trusted(self) -> bool:
        """Return whether the inverter has sent enough valid responses to be trusted."""
        return (
            self._family is not None
            and self._family.valid_response_count >= self._family.required_response_count
        )

    @property
    def is_state_unknown(self) -> bool:
        """Return whether the state is unknown because the port is closed or the inverter is silent."""
        return self._family is None or self.last_poll is None or self.silence_s > SILENCE_TIMEOUT_S

    @property
    def silence_s(self) -> float:
        """Return the time in seconds since the last poll or partial response.

        The result is 0 while silence is permitted.
        """
        seen, now = self.last_poll, self._clock.now()
        if seen is None or now <= self.silence_allowed_until:
            return 0.0
        return now - max(seen.time_s, min(self._answered, seen.time_s + _PARTIAL_RESPONSE_S))

    @property
    def line_delay_s(self) -> float:
        """Return the delay in seconds from a command to the poll that shows its effect.

        This delay is caused by the serial line.
        """
        seen = self.last_poll
        return self._clock.now() - seen.command_cutoff_time_s if seen is not None else 0.0

    def open_and_check_line(self) -> None:
        """Open the line, stop the inverter, check it, and poll until it is trusted.

        Raises DriverError if one of these steps fails.
        """
        self._prepare()
        for _ in range(_MAX_POLLS):
            self._look()
            if self.is_inverter_trusted:
                return
        raise DriverError(
            "the inverter did not send {warm_up} valid responses in a row: {missed}",
            warm_up=self._familiar.required_response_count,
            missed=self.exchange_error,
        )

    def run_exchange(self) -> None:
        """Perform one exchange with the inverter.

        Errors become the fault and are never raised.
        """
        try:
            if self._family is None:
                self._reopen()
            else:
                self._exchange()
            self.exchange_error = ""
        except SerialLineError as error:
            self._let_go(str(error))
        except (NoResponseError, RequestRejectedError) as error:
            self.exchange_error = str(error)
            self._told = None  # The command may be lost, so it is sent again.
            self._answered = 0.0  # Other responses do not complete the poll.
        self._supervise()

    def clear_fault(self) -> None:
        """Clear the fault, reset a trip and discard the commanded frequency.

        Any thread may call this method.
        """
        self._want = 0.0
        self._reset = True
        self.failure = ""

    def discard_polled_state(self) -> None:
        """Discard the known state of the inverter and permit silence until it has restarted."""
        self.clear_fault()
        self._told, self.last_poll, self.silence_allowed_until = (
            None,
            None,
            self._clock.now() + _RESTART_TIME_S,
        )

    def close(self) -> None:
        """Stop the inverter and close the line."""
        self._want = 0.0
        if self._family is not None:
            try:
                self._family.stop_motor()
            except DriverError as error:
                self.exchange_error = str(error)
            self._family.close()
            self._family = None

    @property
    def _familiar(self) -> InverterFamily:
        if self._family is None:
            raise NoResponseError("the serial line to the inverter is not open")
        return self._family

    def _prepare(self) -> None:
        self._family = self._open()
        self._family.is_stop_pending = lambda: self._stop_waits() or self._has_unsent_stop()
        self._stop_now()
        self.warnings = tuple(self._family.check_parameters(self._comm_loss, self._highest))

    def _stop_waits(self) -> bool:
        return self.commanded_hz == 0.0 and self._told != 0.0

    def _has_unsent_stop(self) -> bool:
        return self._stops != self._stopped

    def _stop_now(self) -> None:
        """Stop the inverter.

        The stop is complete when the inverter has confirmed it. Raises DriverError if the inverter does not
        respond.
        """
        stops, self._told = self._stops, None
        self._familiar.stop_motor()
        self._told, self._stopped = 0.0, stops

    def _reopen(self) -> None:
        now = self._clock.now()
        if now < self._retry:
            self._clock.sleep_until(min(self._retry, now + 0.1))
            return
        self._retry = now + _RETRY_DELAY_S
        self._prepare()

    def _exchange(self) -> None:
        self._began_before, self._began = self._began, self._clock.now()
        if self._reset:
            self._perform_clear()
        with suppress(RequestWithheldError):  # The next exchange starts with the stop.
            self._tell()
            self._look()

    def _perform_clear(self) -> None:
        """Stop the inverter and reset a trip.

        If the trip remains, the next poll reports it.
        """
        self._stop_now()
        self._obedience = InverterCommandMonitor(self._step)
        tripped = self.last_poll is None or bool(self.last_poll.inverter_state.trip_text)
        self._reset = False
        if tripped:
            self.silence_allowed_until = self._clock.now() + _RESTART_TIME_S
            self._familiar.reset_trip()

    def _tell(self) -> None:
        want, look = self.commanded_hz, self.last_poll.inverter_state if self.last_poll else None
        # A stop is repeated until standstill.
        turns = want == 0.0 and look is not None and (look.is_running or look.output_hz > STANDSTILL_HZ)
        missing = self._has_unsent_stop()
        if want == self._told and not turns and not missing:
            return
        if want == 0.0 or missing:
            self._obedience.record_command(self._clock.now(), 0.0, look)
            self._stop_now()
        if want != 0.0:
            self._obedience.record_command(self._clock.now(), want, look)
            self._told = None  # From the first frame on, a stop must be sent and has priority.
            self._familiar.command_frequency_hz(want)
        self._told, self._answered = want, self._clock.now()

    def _look(self) -> None:
        for look in self._familiar.iter_poll_steps():
            self._answered = self._clock.now()
            if look is not None:
                self._judge(look)
            elif self._stop_waits():
                return

    def _judge(self, look: InverterState) -> None:
        now = self._clock.now()
        self.last_poll = PolledState(now, look, self._began_before)
        if self._reset:
            return  # This poll started before the operator's reset.
        if look.trip_text:
            self._latch(Message("the inverter has tripped: {trip}", trip=look.trip_text), "spindle")
        elif why := self._obedience.check_polled_state(now, look, now - self._began):
            self._latch(Message("the inverter does not follow its command: {why}", why=why), "ignores-stop")

    def _let_go(self, why: str) -> None:
        self.exchange_error = why
        if self._family is not None:
            self._family.close()
        self._family, self._told = None, None
        self._latch(append_estop_instruction(why) if self._may_turn() else why, "inverter-silent")

    def _supervise(self) -> None:
        """Set a fault if the inverter has been silent for too long, even if no command is active."""
        never = self.last_poll is None and self._clock.now() >= self.silence_allowed_until
        if (never or self.silence_s >= SILENCE_TIMEOUT_S) and not self.failure:
            why = self.exchange_error or "no response from inverter"
            self._latch(append_estop_instruction(why) if self._may_turn() else why, "inverter-silent")

    def _may_turn(self) -> bool:
        return self._want != 0.0 or self.last_poll is None or self.last_poll.inverter_state.output_hz > 0.0

    def _latch(self, why: str, code: FaultCode) -> None:
        if not self.failure:
            self.failure = Fault(why, code)
        self._want, self._reset = 0.0, False


# --- Thread that repeats the exchanges. The spindle's fault reports its end.


_CLOSE_TIMEOUT_S = 3.0  # Seconds for the longest exchange with its retries.


class InverterThread:
    """Thread that repeats the exchanges with the inverter without a pause.

    The line limits the rate of requests.
    """

    def __init__(self, control: InverterControl) -> None:
        self._attendant = control
        self._ended = threading.Event()
        self.thread = self._made()

    def start(self) -> None:
        """Start the thread.

        This method must be called only once.
        """
        self.thread.start()

    def restart(self) -> None:
        """Start a new thread if the last thread has failed.

        The first command of the new thread is a stop.
        """
        if not self.is_alive and not self._ended.is_set():
            self._attendant.discard_polled_state()
            self.thread = self._made()
            self.thread.start()

    @property
    def is_alive(self) -> bool:
        """Return whether the thread is running."""
        return self.thread.is_alive()

    def close(self) -> None:
        """End the thread and send a final stop."""
        self._attendant.commanded_hz = 0.0  # Prevents further commands of the thread.
        self._ended.set()
        if self.thread.is_alive():
            self.thread.join(_CLOSE_TIMEOUT_S)
        self._attendant.close()

    def _made(self) -> threading.Thread:
        return threading.Thread(target=self._keep, name="inverter", daemon=True)

    def _keep(self) -> None:
        while not self._ended.is_set():
            self._attendant.run_exchange()
