"""Lines out with one answer each back, and the scripts that wait for what they have asked."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator
from dataclasses import dataclass, field

from core.ports import Fault, FaultCode

# Bytes of its buffer that are never used. With 100 free ones the firmware's simulator takes nothing more from
# its socket: a cycle start or a reset neither.
_RESERVE = 128
_LONGEST = 256  # bytes of a line


@dataclass(slots=True)
class Ask:
    """A line whose answer matters: what was told before its ``ok``; ``error`` 0 is none."""

    line: str
    lines: list[str] = field(default_factory=list)
    done: bool = False
    error: int = 0
    sent_at: float = 0.0
    ticket: int = 0  # of a block, 0 for everything else

    @property
    def size(self) -> int:
        """Bytes on the wire."""
        return len(self.line) + 1


class Stream:
    """``write`` puts bytes on the wire. Lines leave in order, and only as many as surely fit."""

    def __init__(self, write: Callable[[bytes], None]) -> None:
        self._write = write
        self.room = 100  # bytes that may be unanswered; the controller tells its buffer first
        self.waiting: deque[Ask] = deque()
        self.unanswered: deque[Ask] = deque()
        self.stale = False  # answers to lines that no longer count may still come

    def use(self, buffer: int) -> None:
        """The controller's buffer holds so many bytes."""
        self.room = buffer - _RESERVE

    @property
    def quiet(self) -> bool:
        """Whether every line has been sent and answered."""
        return not self.waiting and not self.unanswered

    def fits(self, line: str) -> bool:
        """Whether this line could leave at once."""
        return not self.waiting and self._used() + len(line) + 1 <= self.room

    def send(self, line: str, now: float, ticket: int = 0) -> Ask:
        """Send a line, or let it wait its turn."""
        assert line.isascii(), line
        assert len(line) < _LONGEST, line
        ask = Ask(line, sent_at=now, ticket=ticket)
        self.waiting.append(ask)
        self.pump(now)
        return ask

    def pump(self, now: float) -> None:
        """Send what has come to fit."""
        while self.waiting and (not self.unanswered or self._used() + self.waiting[0].size <= self.room):
            ask = self.waiting.popleft()
            ask.sent_at = now
            self.unanswered.append(ask)
            self._write(ask.line.encode("ascii") + b"\n")

    def answered(self, error: int) -> Ask | None:
        """``ok`` (0) or an error has come; the line that it belongs to, None when there is none."""
        if not self.unanswered:
            return None
        ask = self.unanswered.popleft()
        ask.done, ask.error = True, error
        return ask

    def message(self, line: str) -> None:
        """Something that the controller says before it answers for a line."""
        if self.unanswered:
            self.unanswered[0].lines.append(line)

    def void(self) -> None:
        """No line counts any more; what is still answered belongs to nothing until ``$G`` has been told."""
        self.waiting.clear()
        self.unanswered.clear()
        self.stale = True

    def _used(self) -> int:
        return sum(ask.size for ask in self.unanswered)


# --- Scripts: generators that ask for something, and go on when it is so.


Step = tuple[Callable[[], bool], float, str]  # until, within s, what is told when it takes longer
Script = Generator[Step, None, None]


class ScriptError(Exception):
    """What a script was begun for cannot be done; the sentence becomes the fault, with its code."""

    def __init__(self, text: str, code: FaultCode = "controller-refuses") -> None:
        super().__init__(text)
        self.code: FaultCode = code


class Runner:
    """One script at a time, carried on by whoever looks."""

    def __init__(self) -> None:
        self.doing = ""  # what the present script is for
        self._script: Script | None = None
        self._step: Step = (lambda: True, 0.0, "")
        self._until = 0.0
        self._inside = False  # its step is under way

    @property
    def busy(self) -> bool:
        """Whether a script is under way."""
        return self._script is not None

    def begin(self, script: Script, doing: str, now: float) -> None:
        """A script that is under way is given up."""
        self.drop()
        self._script, self.doing = script, doing
        self._step, self._until = (lambda: True, 0.0, ""), now

    def drop(self) -> None:
        """Nothing is under way any more; a script that finds its wire gone ends with its step."""
        if self._script is not None and not self._inside:
            self._script.close()
        self._script = None

    def go_on(self, now: float) -> str:
        """As far as it can; why it failed, or nothing."""
        while self._script is not None:
            until, _, why = self._step
            if not until():
                if now > self._until:
                    self._script = None
                    return why
                return ""
            try:
                self._inside = True
                self._step = next(self._script)
            except StopIteration:
                self._script = None
            except ScriptError as error:
                self._script = None
                return Fault(str(error), error.code)
            else:
                self._until = now + self._step[1]
            finally:
                self._inside = False
        return ""
