"""A machine at rest: how often it is looked at, and how often it is shown.

Everything is looked at and decided in every tick. Once nothing has happened for a second a tick comes ten
times a second, where the drivers ring by themselves, and the snapshot is made anew twenty times at most.
"""

from __future__ import annotations

from core.executor.attempt import Attempt
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.snapshot import State

_RESTING = frozenset({State.ESTOP, State.DISABLED, State.IDLE, State.FAULT})
_SETTLED = 100  # ticks in which nothing has happened
_SHOWN = 0.045  # s between two snapshots then: five ticks, whose length is never quite the same
RESTS = (
    0.095  # s between two ticks of a machine at rest: a feeder sends its SYNC, ten a second, with the look
)


class Rest:
    """Of one executor, on its thread alone."""

    def __init__(self, context: MachineContext, control: MachineControl) -> None:
        self._context, self._control = context, control
        self._wakeup = context.ports.wakeup
        self._seen: tuple[object, ...] = ()  # what the last tick has seen, but for the time
        self._same = 0  # ticks since anything of that has changed
        self._shown_at = -1.0
        self._rested = False
        self.stirred = False  # with the last tick something has changed on a machine at rest

    def over(self) -> None:
        """Something was asked for: for a second every tick counts."""
        self._same = -1

    def look(self) -> bool:
        """At the end of a tick: whether it is worth showing; a snapshot is most of what a tick costs."""
        context, status = self._context, self._control.status
        seen: tuple[object, ...] = ()
        with Attempt() as look:  # a driver that breaks here is told of by whoever needs what it does not say
            seen = (
                status.state,
                context.sample[1:],
                context.inputs,
                context.signals,
                context.ports.io.outputs(),
                context.spindle.measured,
                context.spindle.command,
                status.alarms,
                context.stop,
                status.job,
                context.unknown,
            )
        broken = look.error is not None
        changed = broken or self._same < 0 or status.state not in _RESTING or seen != self._seen
        resting = status.state in _RESTING
        self.stirred, self._rested = changed and (resting or self._rested), resting
        self._same = 0 if changed else self._same + 1
        self._seen = seen
        shown = self._same < _SETTLED or context.now - self._shown_at > _SHOWN
        self._shown_at = context.now if shown else self._shown_at
        return shown

    def wait(self) -> bool:
        """Between two ticks: until something is asked for or has changed. False, and at once, where the
        machine is not at rest or its drivers do not ring.
        """
        wakeup = self._wakeup
        if wakeup is None or not self._lasts() or not wakeup.settled():
            return False
        if wakeup.wait(RESTS):
            self.over()
        return True

    @property
    def holds(self) -> bool:
        """Whether nothing has happened for a second."""
        return self._same >= _SETTLED

    def _lasts(self) -> bool:
        """Nothing turns either, and nothing is on that an E-stop would switch off."""
        if not self.holds or self._control.wheel.axis:
            return False
        context = self._context
        outputs, models = context.ports.io.outputs(), context.machine.outputs
        lamps = context.machine.lamps
        safe = all(name in lamps or model.safe in {None, outputs.get(name)} for name, model in models.items())
        return safe and not context.spindle.command and not context.spindle.measured
