"""Scripts: generators that ask for something, and go on when it is so."""

from __future__ import annotations

from collections.abc import Callable, Generator

from core.ports import Fault, FaultCode

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
        """Nothing is under way any more."""
        if self._script is not None:
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
                self._step = next(self._script)
            except StopIteration:
                self._script = None
            except ScriptError as error:
                self._script = None
                return Fault(str(error), error.code)
            else:
                self._until = now + self._step[1]
        return ""
