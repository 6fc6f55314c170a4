"""Signal tower with red, amber and green lamps and a buzzer, and the machine signals that it shows.

Lamps are not outputs of the program. A failed lamp does not hold the cycle, M30 does not change lamps, and a
lamp that is on does not keep a machine at rest awake. A drive fault, the E-stop and the shutdown bring lamps
to their safe state like all other outputs. The control then turns on the lamps that it can still switch.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from core.executor.machine_context import MachineContext
from core.executor.raised_alarm import Attempt
from core.executor.snapshot import ACTIVE, STOPPED, State
from core.machine.hardware_model import BUZZER, HALF, SIGNALS
from core.message import Message
from core.ports import DigitalIO, Unknown

_NO_PARTS = frozenset({State.ESTOP, State.FAULT, State.DISABLED})
_AGAIN = 1.0  # s after which a lamp in the wrong state is switched again
_REFUSED = 5.0  # s after which a lamp that the driver refused is switched again


@dataclass(slots=True)
class SignalKinds:
    """Determines the active signals, and remembers whether a part is finished and no other has started."""

    _ends: int = -1
    _made: bool = False

    def see(self, state: State, ends: int, *, barred: bool) -> tuple[str, ...]:
        """Return the names of all active signals.

        ``ends`` is the number of finished programs. ``barred`` is True if no other part may start.
        """
        self._made = (self._made or ends > self._ends >= 0) and state is State.IDLE
        self._ends = ends
        found = [kind for kind in (_of_state(state),) if kind]
        if barred and state not in _NO_PARTS:
            found.append("tool-life")
        elif self._made:
            found.append("part")
        return tuple(found)


def _of_state(state: State) -> str:
    if state is State.ESTOP:
        return "estop"
    if state is State.FAULT:
        return "alarm"
    if state in STOPPED:
        return "stop"
    return "runs" if state in ACTIVE else ""


@dataclass(slots=True)
class SignalLamps:
    """Switches the lamps at the end of each tick on the executor's thread. Never raises or waits."""

    context: MachineContext
    io: DigitalIO  # the driver's port, because lamps are not commanded by a program
    _lamps: tuple[str, ...] = field(init=False)
    _kinds: tuple[str, ...] = ()
    _since: dict[str, float] = field(default_factory=dict)  # start time of each signal
    _signals: SignalKinds = field(default_factory=SignalKinds)
    _due: dict[str, float] = field(default_factory=dict)  # earliest time at which each lamp is switched again
    _sent: dict[str, bool] = field(default_factory=dict)
    # earliest time of the next attempt after a refusal of the driver
    _refused: dict[str, float] = field(default_factory=dict)
    _told: str = ""

    def __post_init__(self) -> None:
        self._lamps = self.context.machine.lamps

    def look(self, state: State, ends: int, *, barred: bool) -> None:
        """Update the lamps; ``barred`` is True if a tool or a measurement prevents the next part."""
        if not self._lamps:
            return
        with Attempt():  # A driver error of a lamp must not stop the machine.
            self._see(self._signals.see(state, ends, barred=barred))
            if Unknown.OUTPUTS not in self.context.unknown:
                self._switch(self._wanted(state))

    def _see(self, kinds: tuple[str, ...]) -> None:
        if kinds != self._kinds:
            now = self.context.now
            self._since = {kind: self._since.get(kind, now) for kind in kinds}
            self._kinds = kinds

    def _wanted(self, state: State) -> dict[str, bool]:
        """Return the required state of each lamp.

        A lamp without an active signal is in its safe state after a fault, and off otherwise.
        """
        now, outputs = self.context.now, self.context.machine.outputs
        if now < self.context.lamp_test:
            return dict.fromkeys(self._lamps, True)
        fault = state in {State.FAULT, State.ESTOP}
        wanted = {name: fault and bool(outputs[name].safe) for name in self._lamps}
        # its output commands wait for the queued blocks
        steady = self.context.ports.blocks is not None and state in ACTIVE
        for kind in self._kinds:
            signal, age = SIGNALS[kind], now - self._since[kind]
            dark = signal.blinks and not steady and age % (2.0 * HALF) >= HALF
            if signal.lamp in wanted:
                wanted[signal.lamp] = not dark
            if BUZZER in wanted and age < signal.buzz:
                wanted[BUZZER] = not dark
        return wanted

    def _switch(self, wanted: dict[str, bool]) -> None:
        actual, now = self.io.outputs(), self.context.now
        for name, on in wanted.items():
            new = self._sent.get(name) is not on
            waits = now < self._refused.get(name, 0.0) or (not new and now < self._due.get(name, 0.0))
            if (new or actual.get(name) is not on) and not waits:
                self._write(name, on, now)

    def _write(self, name: str, on: bool, now: float) -> None:
        with Attempt() as trial:
            self.io.write(name, on)
        if trial.error is None:
            self._sent[name], self._due[name] = on, now + _AGAIN
            return
        self._refused[name] = now + _REFUSED
        why = Message("{name} CANNOT BE SWITCHED: {error}", name=name.upper(), error=trial.error)
        if why != self._told:
            self._told = why
            self.context.log("disturbed", why)
