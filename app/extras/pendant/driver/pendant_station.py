"""``core.ports`` with a pendant beside the machine's own station: it adds stops, holds and counts."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from app.extras.pendant.driver.pendant_reader import Pendant, PendantState
from core.ports import DigitalIO, Station, StationState

_TOLD = 0.3  # s for which something that happened once is told: a control that looks every tick has seen it
LOST = "pendant events were lost; the handwheel may have turned farther than TurnDesk counted"


class PendantStation:
    """``core.ports.Station``. Where the pendant carries a stop it must be there: no cycle runs without it.

    Where it does not, pulling it out holds once. Nothing here can start anything.
    """

    def __init__(self, station: Station, pendant: Pendant, *, stops: bool, wheel: bool) -> None:
        self._station, self._pendant = station, pendant
        self._stops, self._wheel = stops, wheel

    @property
    def away(self) -> str:
        """Why the pendant is not read; empty when it is."""
        return self._pendant.state().away

    def snapshot(self) -> StationState:
        """The station now."""
        state, pendant = self._station.snapshot(), self._pendant.state()
        just = self._pendant.now() - pendant.broke < _TOLD
        lost = pendant.away if pendant.away and (self._stops or just) else ""
        return dataclasses.replace(
            state,
            hold=state.hold or pendant.inputs.get("hold", False),
            handwheel=state.handwheel + pendant.counts,
            trouble=state.trouble or lost,
            wheel_trouble=state.wheel_trouble or (self._of_wheel(pendant, just=just) if self._wheel else ""),
        )

    @staticmethod
    def _of_wheel(pendant: PendantState, *, just: bool) -> str:
        return pendant.away or (LOST if just else "")


class PendantIO:
    """``core.ports.DigitalIO``: the buttons of the pendant are inputs as any other."""

    def __init__(self, io: DigitalIO, pendant: Pendant) -> None:
        self._io, self._pendant = io, pendant

    def inputs(self) -> Mapping[str, bool]:
        """Those of the machine and those of the pendant."""
        return {**self._io.inputs(), **self._pendant.state().inputs}

    def outputs(self) -> Mapping[str, bool]:
        """A pendant has none."""
        return self._io.outputs()

    def write(self, name: str, on: bool) -> None:
        """Raises DriverError as the machine's."""
        self._io.write(name, on)

    def safe(self) -> None:
        """Every output to its safe state."""
        self._io.safe()
