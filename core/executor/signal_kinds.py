"""What the machine signals now, by the kinds of ``signal_table``: for the tower and for the desk's sounds."""

from __future__ import annotations

from dataclasses import dataclass

from core.executor.snapshot import ACTIVE, STOPPED, State

_NO_PARTS = frozenset({State.ESTOP, State.FAULT, State.DISABLED})


@dataclass(slots=True)
class SignalKinds:
    """Sees every tick or every frame; remembers whether a part is done and nobody has begun another."""

    _ends: int = -1
    _made: bool = False

    def see(self, state: State, ends: int, *, barred: bool) -> tuple[str, ...]:
        """Everything that is so now. ``ends`` of programs; ``barred``: no other part begins."""
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
