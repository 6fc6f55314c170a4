"""Signal tower with red, amber and green lamps and a buzzer, and the signals that it shows.

Lamps are not program outputs: a failed lamp does not hold the cycle, and M30 does not change lamps. A
machine at rest can use the slower tick rate even if a lamp is on. A drive fault, the E-stop and the
shutdown switch lamps to their safe states like all other outputs. The control then turns on the lamps that
it can still switch.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from core.executor.machine_context import MachineContext
from core.executor.raised_alarm import ErrorCatcher
from core.executor.snapshot import ACTIVE_STATES, STOPPED_STATES, MachineState
from core.machine.hardware_model import BLINK_HALF_PERIOD_S, BUZZER, MACHINE_SIGNALS
from core.message import Message
from core.ports import DigitalIO, UnknownPart

_NO_PARTS = frozenset({MachineState.ESTOP, MachineState.FAULT, MachineState.DISABLED})
_RETRY_INTERVAL_S = 1.0  # s after which a lamp in the wrong state is switched again
_REFUSAL_TIME_S = 5.0  # s after which a lamp that the driver refused is switched again


@dataclass(slots=True)
class SignalSelector:
    """Selector of the active signals of the signal tower.

    It also stores whether a part is complete while the next part has not started yet.
    """

    _ends: int = -1
    _made: bool = False

    def update_signals(
        self, state: MachineState, program_end_count: int, *, is_next_part_blocked: bool
    ) -> tuple[str, ...]:
        """Return the names of all active signals.

        ``program_end_count`` is the number of programs that have reached their end.
        ``is_next_part_blocked`` is True if the next part must not start.
        """
        self._made = (self._made or program_end_count > self._ends >= 0) and state is MachineState.IDLE
        self._ends = program_end_count
        found = [kind for kind in (_of_state(state),) if kind]
        if is_next_part_blocked and state not in _NO_PARTS:
            found.append("tool-life")
        elif self._made:
            found.append("part")
        return tuple(found)


def _of_state(state: MachineState) -> str:
    if state is MachineState.ESTOP:
        return "estop"
    if state is MachineState.FAULT:
        return "alarm"
    if state in STOPPED_STATES:
        return "stop"
    return "runs" if state in ACTIVE_STATES else ""


@dataclass(slots=True)
class SignalLamps:
    """Control of the lamps at the end of each tick on the executor's thread.

    It never raises an exception and never waits.
    """

    context: MachineContext
    io: DigitalIO  # the driver's port, because lamps are not commanded by a program
    _lamps: tuple[str, ...] = field(init=False)
    _kinds: tuple[str, ...] = ()
    _since: dict[str, float] = field(default_factory=dict)  # start time of each signal
    _signals: SignalSelector = field(default_factory=SignalSelector)
    _due: dict[str, float] = field(default_factory=dict)  # earliest time at which each lamp is switched again
    _sent: dict[str, bool] = field(default_factory=dict)
    # earliest time of the next attempt after a refusal of the driver
    _refused: dict[str, float] = field(default_factory=dict)
    _told: str = ""

    def __post_init__(self) -> None:
        self._lamps = self.context.machine.lamp_outputs

    def update_lamps(
        self, state: MachineState, program_end_count: int, *, is_next_part_blocked: bool
    ) -> None:
        """Update the lamps of the signal tower.

        ``is_next_part_blocked`` is True if a tool or a required measurement prevents the next part.
        """
        if not self._lamps:
            return
        with ErrorCatcher():  # A driver error of a lamp must not stop the machine.
            self._see(
                self._signals.update_signals(
                    state, program_end_count, is_next_part_blocked=is_next_part_blocked
                )
            )
            if UnknownPart.OUTPUTS not in self.context.unknown_parts:
                self._switch(self._required_states(state))

    def _see(self, kinds: tuple[str, ...]) -> None:
        if kinds != self._kinds:
            now = self.context.now
            self._since = {kind: self._since.get(kind, now) for kind in kinds}
            self._kinds = kinds

    def _required_states(self, machine_state: MachineState) -> dict[str, bool]:
        """Return the required state of each lamp.

        After a fault, a lamp without an active signal is in its safe state; otherwise it is off.
        """
        now, outputs = self.context.now, self.context.machine.outputs
        if now < self.context.lamp_test_end_s:
            return dict.fromkeys(self._lamps, True)
        fault = machine_state in {MachineState.FAULT, MachineState.ESTOP}
        wanted = {name: fault and bool(outputs[name].safe_state) for name in self._lamps}
        # its output commands wait for the queued blocks
        steady = self.context.ports.blocks is not None and machine_state in ACTIVE_STATES
        for kind in self._kinds:
            signal, age = MACHINE_SIGNALS[kind], now - self._since[kind]
            dark = (
                signal.is_blinking and not steady and age % (2.0 * BLINK_HALF_PERIOD_S) >= BLINK_HALF_PERIOD_S
            )
            if signal.lamp in wanted:
                wanted[signal.lamp] = not dark
            if BUZZER in wanted and age < signal.buzzer_time_s:
                wanted[BUZZER] = not dark
        return wanted

    def _switch(self, wanted: dict[str, bool]) -> None:
        actual, now = self.io.get_outputs(), self.context.now
        for name, on in wanted.items():
            new = self._sent.get(name) is not on
            waits = now < self._refused.get(name, 0.0) or (not new and now < self._due.get(name, 0.0))
            if (new or actual.get(name) is not on) and not waits:
                self._write(name, on, now)

    def _write(self, name: str, on: bool, now: float) -> None:
        with ErrorCatcher() as trial:
            self.io.write(name, on)
        if trial.error is None:
            self._sent[name], self._due[name] = on, now + _RETRY_INTERVAL_S
            return
        self._refused[name] = now + _REFUSAL_TIME_S
        why = Message("{name} CANNOT BE SWITCHED: {error}", name=name.upper(), error=trial.error)
        if why != self._told:
            self._told = why
            self.context.log_text("disturbed", why)
