"""The control's side of the feeder: requests in words. A feeder that is gone is a fault, and no hang."""

from __future__ import annotations

import logging
import queue
from collections.abc import Mapping
from typing import Protocol

from core.ports import Clock, DriverError, Fault, TrippedError
from drivers.feeder.wire import NOTHING, Message, fault_of, text, texts

_log = logging.getLogger(__name__)
_FRESH = 0.002  # s for which one look serves all ports


class Link(Protocol):
    """Carries a request to the feeder and its answer back."""

    def ask(self, message: Message) -> Message:
        """Raises DriverError when there is no answer."""
        ...

    def hang_up(self) -> None:
        """From any thread: nothing is said or heard any more."""
        ...

    def close(self) -> None: ...


class Line:
    """Requests in words, and the last look at everything."""

    def __init__(self, link: Link, clock: Clock) -> None:
        self._link = link
        self.clock = clock
        self.lost: Fault | str = ""  # why the feeder cannot be asked any more
        self._state: Mapping[str, object] = {}
        self._at = -1.0
        self._posted: queue.SimpleQueue[Message] = queue.SimpleQueue()

    def ask(self, message: Message) -> Message:
        """The answer. Raises DriverError with what the drivers refuse, or that the feeder is gone."""
        if self.lost:
            raise DriverError(self.lost)
        try:
            answer = self._link.ask(message)
        except DriverError as error:
            self.lost = error.fault
            raise
        if "tripped" in answer.head:
            raise TrippedError(text(answer.head, "tripped"))
        if why := fault_of(answer.head, "error", "driver"):
            raise DriverError(why)
        return answer

    def order(self, what: str, **values: object) -> None:
        """Something that changes the machine; the next look is a new one."""
        self._at = -1.0
        self.ask(Message({"do": "do", "what": what, **values}, NOTHING))

    def post(self, message: Message) -> None:
        """From any thread: goes out before the next look, unanswered."""
        self._posted.put(message)

    def look(self, *, anew: bool = False) -> Mapping[str, object]:
        """Everything that can be seen, at most 2 ms old; the last known when the feeder is gone."""
        now = self.clock.now()
        if not self.lost and (anew or not 0.0 <= now - self._at < _FRESH):
            try:
                while not self._posted.empty():
                    self.ask(self._posted.get())
                self._state = self.ask(Message({"do": "look"}, NOTHING)).head
            except DriverError as error:
                self.lost = self.lost or error.fault
            self._at = now
            for note in texts(self._state.get("notes")):
                _log.warning("feeder: %s", note)
        return self._state

    def hang_up(self) -> None:
        """From any thread: the feeder sees that its control is gone, and stops the machine for good."""
        self._link.hang_up()

    def close(self) -> None:
        """End it."""
        self._link.close()
