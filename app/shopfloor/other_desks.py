"""The desks beside this one: their status.json read every few seconds, while somebody looks at the page."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Sequence
from http.client import HTTPException
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit, urlunsplit
from urllib.request import ProxyHandler, build_opener

from app.shopfloor.status_page import OtherDesk

EVERY = 3.0  # s
LOOKED_AT = 15.0  # s after which nobody looks any more
_PATIENCE = 2.0  # s
_MOST = 100_000  # bytes
_ASK = build_opener(ProxyHandler({}))  # desks of one shop are not asked by way of a proxy


def status_address(address: str) -> str:
    """Where a desk that has its page at ``address`` says its status; the token stays in the question."""
    parts = urlsplit(address)
    return urlunsplit(parts._replace(path=parts.path.rstrip("/") + "/status.json", fragment=""))


def asked(address: str) -> OtherDesk:
    """One desk, asked now; waits for two seconds at most for each piece of its answer."""
    name = urlsplit(address).netloc.rpartition("@")[2]
    try:
        with _ASK.open(status_address(address), timeout=_PATIENCE) as answer:
            found = json.loads(answer.read(_MOST))
    except HTTPError as error:
        why = "it wants another token" if error.code == 403 else f"it answers {error.code} {error.reason}"
        return OtherDesk(name, trouble=why)
    except (URLError, HTTPException, OSError) as error:
        return OtherDesk(name, trouble=_why(error))
    except (ValueError, RecursionError):
        return OtherDesk(name, trouble="what answers there is no desk")
    if not isinstance(found, dict):
        return OtherDesk(name, trouble="what answers there is no desk")
    return OtherDesk(name, {key: value for key, value in found.items() if _fits(key, value)})


def _why(error: Exception) -> str:
    """In the system's words, without their number."""
    cause = getattr(error, "reason", error)
    return str(getattr(cause, "strerror", None) or cause)


_TEXTS = frozenset({"machine", "state", "execution", "program"})
_FIGURES = frozenset({"line", "made", "time_left", "last_cycle", "spindle_load"})


def _fits(key: str, value: object) -> bool:
    """Whether the page can show it: nobody knows who answers there."""
    figure = isinstance(value, int | float) and not isinstance(value, bool)
    return (key in _TEXTS and isinstance(value, str)) or (key in _FIGURES and figure)


class OtherDesks:
    """``look`` tells what was heard last; a thread asks while ``look`` is called now and then."""

    def __init__(self, addresses: Sequence[str], ask: Callable[[str], OtherDesk] = asked) -> None:
        self._addresses, self._ask = addresses, ask
        self._heard = tuple(OtherDesk(urlsplit(each).netloc, trouble="not asked yet") for each in addresses)
        self._looked = threading.Event()
        self._closing = threading.Event()
        self._last = time.monotonic()
        self._thread = threading.Thread(target=self._keep, name="other-desks", daemon=True)

    def start(self) -> None:
        """Once; without other desks nothing is to be asked."""
        if self._addresses:
            self._thread.start()

    def look(self) -> Sequence[OtherDesk]:
        """What was heard of each."""
        self._last = time.monotonic()
        self._looked.set()
        return self._heard

    def close(self) -> None:
        """The thread ends behind the question that is open; nobody waits for it."""
        self._closing.set()
        self._looked.set()

    def _keep(self) -> None:
        while not self._closing.is_set():
            self._looked.wait()
            self._heard = tuple(self._ask(each) for each in self._addresses)
            if time.monotonic() - self._last > LOOKED_AT:
                self._looked.clear()
            self._closing.wait(EVERY)
