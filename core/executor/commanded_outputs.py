"""Outputs as they were commanded, beside what they are: where they differ, somebody else has switched."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from core.machine.machine_model import OutputModel
from core.machine.signal_table import LAMPS
from core.message import Message
from core.ports import DigitalIO

_TELLS = 0.5  # s in which an output that was written may still be told as it was before


class Differing(NamedTuple):
    """An output that is not what it was commanded to be."""

    name: str
    wanted: bool

    @property
    def words(self) -> str:
        """What has become of it, as the operator reads it."""
        name = self.name.upper()
        return (
            Message("{name} TURNED OFF", name=name) if self.wanted else Message("{name} TURNED ON", name=name)
        )


class CommandedOutputs:
    """``core.ports.DigitalIO``: every output that the executor writes goes through here and is remembered."""

    def __init__(self, io: DigitalIO, models: Mapping[str, OutputModel]) -> None:
        self._io = io
        self._models = models
        self._lamps = frozenset(LAMPS) & models.keys()  # the control's own: no program commands them
        self._wanted = dict(self.outputs())
        self._written: dict[str, float] = {}  # when each was written last, told late by some drivers

    def inputs(self) -> Mapping[str, bool]:
        """All inputs by name."""
        return self._io.inputs()

    def outputs(self) -> Mapping[str, bool]:
        """The outputs as they are, by name, but for the lamps of the signal tower."""
        outputs = self._io.outputs()
        return (
            {name: on for name, on in outputs.items() if name not in self._lamps} if self._lamps else outputs
        )

    def everything(self) -> Mapping[str, bool]:
        """The same with the lamps."""
        return self._io.outputs()

    def write(self, name: str, on: bool) -> None:
        """Switch one output. Raises DriverError, and then it was not commanded."""
        self._io.write(name, on)
        self._wanted[name] = on
        self._written[name] = self._now

    def safe(self) -> None:
        """Every output to its safe state."""
        self._io.safe()
        for model in self._models.values():
            if model.safe is not None and model.name not in self._lamps:
                self._wanted[model.name], self._written[model.name] = model.safe, self._now

    def look(self, now: float) -> None:
        """Called first in a tick, with the time by which writes are remembered."""
        self._now = now

    def fell(self, names: Sequence[str]) -> None:
        """These are known to have been switched off by somebody else, however lately they were written."""
        for name in names:
            self._written.pop(name, None)

    def differing(self) -> list[Differing]:
        """The outputs that are not as they were commanded, and ought to be by now."""
        actual = self._io.outputs()
        return [
            Differing(name, wanted)
            for name, wanted in self._wanted.items()
            if actual.get(name, wanted) is not wanted and self._now - self._written.get(name, -1e9) > _TELLS
        ]

    def accept(self) -> list[Differing]:
        """No program is under way: outputs count as they are now. Returns those that have changed."""
        changed = self.differing()
        for each in changed:
            self._wanted[each.name] = not each.wanted
        return changed

    _now = 0.0
