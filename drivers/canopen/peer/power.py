"""The power states of a CiA 402 drive as the drive keeps them, with the transitions of the profile."""

from __future__ import annotations

from collections.abc import Callable

from drivers.canopen.states import DriveState

_BITS = {
    DriveState.NOT_READY: 0x00,
    DriveState.OFF: 0x40,
    DriveState.READY: 0x21,
    DriveState.ON: 0x23,
    DriveState.ENABLED: 0x27,
    DriveState.QUICK_STOP: 0x07,
    DriveState.REACTING: 0x0F,
    DriveState.FAULT: 0x08,
}
_ON = frozenset(((0x07, DriveState.READY), (0x0F, DriveState.READY), (0x07, DriveState.ENABLED)))
_VOLTAGE, _REMOTE = 0x10, 0x200
_POWERED = frozenset((DriveState.ENABLED, DriveState.QUICK_STOP, DriveState.REACTING))


class PowerStates:
    """``control`` takes control words, ``stopped`` ends a braking; ``sto`` is the hardware's word."""

    def __init__(self, powered_up: Callable[[], None]) -> None:
        self.state = DriveState.OFF
        self.last = 0  # control word
        self.sto = False
        self.refuses = False  # a drive that does not come on, for tests
        self._powered_up = powered_up

    @property
    def powered(self) -> bool:
        """The motor has current."""
        return self.state in _POWERED

    @property
    def braking(self) -> bool:
        """On its own way to rest."""
        return self.state in {DriveState.QUICK_STOP, DriveState.REACTING}

    @property
    def word(self) -> int:
        """The state's bits of the status word."""
        return _BITS[self.state] | _VOLTAGE | _REMOTE

    def control(self, word: int) -> None:
        """One transition at most, as the profile's figure has them."""
        rising = word & 0x80 and not self.last & 0x80
        self.last = word
        if self.state is DriveState.FAULT:
            self.state = DriveState.OFF if rising else self.state
        elif not word & 0x02:
            self.off()
        elif not word & 0x04:
            self.quick_stop()
        elif self.state in {DriveState.OFF, DriveState.READY, DriveState.ON, DriveState.ENABLED}:
            self._step(word)

    def quick_stop(self) -> None:
        """Brake where there is power, lose it at once where there is none to brake with."""
        if self.state is DriveState.ENABLED:
            self.state = DriveState.QUICK_STOP
        elif not self.powered and self.state is not DriveState.FAULT:
            self.state = DriveState.OFF

    def off(self) -> None:
        """No voltage."""
        if self.state not in {DriveState.FAULT, DriveState.REACTING}:
            self.state = DriveState.OFF

    def trip(self) -> None:
        """A fault: brake, then no power."""
        self.state = DriveState.REACTING if self.powered else DriveState.FAULT

    def stopped(self) -> None:
        """At rest after braking."""
        self.state = DriveState.FAULT if self.state is DriveState.REACTING else DriveState.OFF

    def _step(self, word: int) -> None:
        command = word & 0x0F
        if self.sto or self.refuses:
            return
        if command == 0x06:
            self.state = DriveState.READY
        elif (command, self.state) in _ON:
            self.state = DriveState.ON
        elif command == 0x0F and self.state is DriveState.ON:
            self.state = DriveState.ENABLED
            self._powered_up()
