"""Guard that blocks motion, spindle start and outputs after a trip until it is acknowledged."""

from __future__ import annotations

from collections.abc import Sequence

from core.faults import DriverHostTrip, TrippedError, get_fault_code
from core.message import Message as Text
from drivers.driver_host.host_messages import Message, number
from drivers.process_messages import text

_MOTION_COMMANDS = frozenset(("splice", "mesh"))
_SWITCHING_COMMANDS = frozenset(("write", "hold"))  # Rejected only with ``on``.


class TripGuard:
    """A guard that rejects requests of the control after a trip until the trip is acknowledged."""

    def __init__(self) -> None:
        self.active_trip: DriverHostTrip | None = None
        self._count = 0
        self._turns = False  # The control has commanded the spindle to turn.
        self.is_c_requested = False  # The spindle drive has accepted a command to engage as C.

    def require_request_allowed(self, message: Message) -> None:
        """Raise TrippedError if a trip is not acknowledged and the message requests an action.

        Such actions are a motion, a start of the spindle, engaging the C axis, and switching on an output.
        Engaging the C axis is included because the spindle may search its index and turn to its position.
        Stopping, releasing and switching off are always allowed. Switching on the power of the drives is
        also allowed, because it causes no motion.
        """
        what, is_on = text(message.header, "what"), message.header.get("on") is True
        turns = what == "orient" or (what == "run" and number(message.header, "rpm") != 0.0)
        if self.active_trip is not None and (
            text(message.header, "do") in _MOTION_COMMANDS
            or what == "home"
            or turns
            or (what in _SWITCHING_COMMANDS and is_on)
        ):
            raise TrippedError(
                Text(
                    "the driver host received no messages for {seconds} s and stopped the machine",
                    seconds=f"{self.active_trip.silence_s:.2f}",
                )
            )
        if what in {"run", "coast", "orient", "release"}:
            self._turns = turns

    def record_accepted_command(self, message: Message) -> None:
        """Record whether the C axis is requested, after the drivers have accepted a command."""
        if text(message.header, "what") == "hold":
            self.is_c_requested = message.header.get("on") is True

    def record_c_state(self, *, is_enabled: bool, fault: str) -> None:
        """Record that C-axis mode has ended if the drives have no power or the C axis has a fault."""
        if not is_enabled or get_fault_code(fault, "axis") == "c-coupling":
            self.is_c_requested = False

    def record_trip(
        self,
        silence_s: float,
        outputs: Sequence[str],
        *,
        is_spindle_stopped: bool,
        is_c_canceled: bool = False,
    ) -> None:
        """Record that outputs and the spindle were switched off.

        ``is_c_canceled`` means that the spindle drive was being engaged as the C axis, which is treated as
        a turning spindle. No trip is recorded if nothing was on.
        """
        turned = (self._turns and is_spindle_stopped) or is_c_canceled
        self._turns = self._turns and not is_spindle_stopped
        self.is_c_requested = self.is_c_requested and not is_c_canceled
        if turned or outputs:
            self._tripped(silence_s, turned, outputs)

    def record_output_switched_off(self, silence_s: float, output: str) -> None:
        """Record that one output was switched off because the control did not renew it."""
        self._tripped(silence_s, False, [output])

    def update_silence_duration(self, silence_s: float) -> None:
        """Update the duration of the silence when the control sends messages again."""
        if self.active_trip is not None:
            self.active_trip = self.active_trip._replace(silence_s=max(silence_s, self.active_trip.silence_s))

    def acknowledge_trip(self, trip_number: float) -> None:
        """Clear the trip with this number; if a later trip has occurred, it remains active."""
        if self.active_trip is not None and self.active_trip.trip_number == trip_number:
            self.active_trip = None

    def _tripped(self, away: float, spindle: bool, outputs: Sequence[str]) -> None:
        self._count += 1
        before = self.active_trip or DriverHostTrip(0, 0.0, False, ())
        on = tuple(dict.fromkeys((*before.active_outputs, *outputs)))
        self.active_trip = DriverHostTrip(
            self._count, max(away, before.silence_s), spindle or before.spindle, on
        )
