"""What a hand changes between two programs: offsets in force, the spindle left turning, one output."""

from __future__ import annotations

from core.executor.bench import Bench
from core.executor.commands import ForceOutput, SpindleStop, UseOffsets
from core.executor.conductor import Conductor
from core.executor.inherited import with_offsets
from core.executor.snapshot import State
from core.executor.states import CYCLE

_AT_REST = frozenset({State.IDLE, State.DISABLED})


class ByHand:
    """Obeys these commands, on the executor's thread; what it refuses it says."""

    def __init__(self, bench: Bench, conductor: Conductor) -> None:
        self._bench = bench
        self._conductor = conductor

    def obey(self, command: UseOffsets | SpindleStop | ForceOutput) -> None:
        """Do it, or say why not. Raises DriverError."""
        why = self._refusal(command)
        if why:
            self._bench.say("refused", why)
            return
        match command:
            case UseOffsets(tools=tools, secondary=secondary):
                standing = self._conductor.standing
                standing.modal = with_offsets(standing.modal, tools, secondary)
                self._bench.say("offsets", "the offsets of the tables are in force")
            case SpindleStop():
                self._bench.spindle.stop()
                self._bench.noted("by-hand", "the spindle was stopped by hand")
            case ForceOutput(name=name, on=on):
                self._bench.ports.io.write(name, on)
                self._bench.say("force", f"{name} {'on' if on else 'off'} by hand")

    def _refusal(self, command: UseOffsets | SpindleStop | ForceOutput) -> str:
        state = self._conductor.state
        if isinstance(command, ForceOutput):
            return self._output(command.name, command.on, state)
        if state not in CYCLE:
            return ""
        if isinstance(command, UseOffsets):
            return "a program is under way: it keeps the offsets that it was proved with"
        return "a program is under way: its spindle is stopped by feed hold and reset"

    def _output(self, name: str, on: bool, state: State) -> str:
        bench = self._bench
        if name not in bench.machine.outputs:
            return f"this machine has no output {name}"
        if state not in _AT_REST:
            return f"{name}: outputs are switched by hand only at rest, not in state {state.value}"
        if name == "collet" and not on and not (bench.spindle.stopped and not bench.spindle.asked):
            return "the collet is not opened by hand while the spindle turns"
        return ""
