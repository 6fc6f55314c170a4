"""Why another computer could not be reached, in a few words for a log or a page."""

from __future__ import annotations

import logging

LONGEST = 200  # characters of what the other side says that a sentence repeats
NO_ANSWER = "no answer"
_CAUSES = 10  # that are told of one trouble: somebody may answer otherwise each time


def cause_of(error: Exception) -> str:
    """In the system's words, without their number: a refused connection, an unknown name, silence."""
    cause = getattr(error, "reason", error)  # urllib wraps what the system has said
    if isinstance(cause, TimeoutError) and cause.errno is None:
        return NO_ANSWER
    return one_line(str(getattr(cause, "strerror", None) or cause))


def one_line(words: str) -> str:
    """What somebody else has said, without what a terminal obeys."""
    return "".join(sign for sign in words if sign.isprintable())[:LONGEST]


class Trouble:
    """Says to a log why somebody cannot be told: each cause once, until he was told again."""

    def __init__(self, log: logging.Logger, who: str) -> None:
        self._log, self._who = log, who
        self._said = set[str]()

    def say(self, why: str) -> None:
        """From any thread."""
        if why not in self._said and len(self._said) < _CAUSES:
            self._said.add(why)
            self._log.warning("%s cannot be told: %s", self._who, why)

    def over(self) -> None:
        """The next time all of it is news again."""
        self._said.clear()
