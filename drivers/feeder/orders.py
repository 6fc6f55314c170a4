"""Orders that change the machine, by the words of a request; and the hands at a simulated station."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.ports import DriverError, MachinePorts, Stop
from drivers.feeder.wire import number, text


def act(ports: MachinePorts, head: Mapping[str, object]) -> None:
    """Carry one order out. Raises DriverError for one that is not known, or that the drivers refuse."""
    on = head.get("on") is True
    acts: dict[str, Callable[[], None]] = {
        "enable": lambda: ports.axes.enable(on),
        "stop": lambda: ports.axes.stop(_how(text(head, "how"))),
        "home": lambda: ports.axes.home(text(head, "name")),
        "clear_fault": ports.axes.clear_fault,
        "run": lambda: ports.spindle.run(number(head, "rpm")),
        "coast": ports.spindle.coast,
        "hold": lambda: _hold(ports, on=on, orient=head.get("orient") is True),
        "write": lambda: ports.io.write(text(head, "name"), on),
        "safe": ports.io.safe,
    }
    order = acts.get(text(head, "what"))
    if order is None:
        raise DriverError("the feeder does not know this order; are both of the same version?")
    order()


def use_hand(hands: object | None, head: Mapping[str, object]) -> object:
    """A hand at the simulated station, by the name of its method. Raises DriverError."""
    name, values = text(head, "name"), head.get("values")
    use = None if name.startswith("_") or hands is None else getattr(hands, name, None)
    if not callable(use) or not isinstance(values, list):
        raise DriverError("this machine has no simulated station")
    try:
        return use(*values)
    except TypeError as error:
        raise DriverError(f"the simulated station cannot {name} with {values}") from error


def _hold(ports: MachinePorts, *, on: bool, orient: bool) -> None:
    if ports.lock is None:
        raise DriverError("the spindle's drive of this machine is not C")
    ports.lock.hold(on, orient)


def _how(word: str) -> Stop:
    try:
        return Stop(word)
    except ValueError as error:
        raise DriverError(f"the feeder does not know the stop {word!r}") from error
