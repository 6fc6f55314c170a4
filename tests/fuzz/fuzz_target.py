"""What a target of fuzzing is, what counts as a fault of it, and the file in which faults are kept."""

from __future__ import annotations

import json
import random
import time
import traceback
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

TOO_LONG = 2.0  # s of processor time for one input
_SHOWN = 4000  # bytes of an input that are kept with a fault

Mutate = Callable[[bytes, random.Random], bytes]


def of_extras() -> list[str]:
    """Return the modules with the targets of the optional features, as ``TARGETS``."""
    folder = Path(__file__).parents[1] / "extras"
    return [
        f"tests.extras.{each.parent.name}.fuzz_targets" for each in sorted(folder.glob("*/fuzz_targets.py"))
    ]


@dataclass(frozen=True, slots=True)
class Target:
    """``run`` takes any bytes and answers with the sentences that it told a person, or raises one of
    ``refusals``, whose text is such a sentence. ``seeds`` are good inputs; ``mutate`` knows the language.
    """

    name: str
    seeds: Callable[[], Iterable[bytes]]
    run: Callable[[bytes], Iterable[str]]
    refusals: tuple[type[Exception], ...] = ()
    mutate: Mutate | None = None


@dataclass(frozen=True, slots=True)
class Fault:
    """``kind``: raised, slow, unclear; ``where`` the innermost line of ours: faults are told apart by it."""

    target: str
    kind: str
    where: str
    text: str
    data: str  # hexadecimal


class Examined:
    """Runs a target; every fault is kept once, and nothing is raised."""

    def __init__(self, target: Target, kept: Path) -> None:
        self._target, self._kept = target, kept
        self._known: set[tuple[str, str]] = set()
        self.runs = self.refused = 0
        self.slowest = 0.0

    def __call__(self, data: bytes) -> None:
        """One input."""
        self.runs += 1
        begun = time.thread_time()
        try:
            told = list(self._target.run(data))
        except self._target.refusals as error:
            told = [str(error)]
            self.refused += 1
        except Exception as error:  # noqa: BLE001 - whatever it is, it is the fault that is looked for
            self._note("raised", _place(error), repr(error), data)
            return
        took = time.thread_time() - begun
        self.slowest = max(self.slowest, took)
        if took > TOO_LONG:
            self._note("slow", f"{self._target.name} over {TOO_LONG:g} s", f"{took:.1f} s", data)
        for text in told:
            if not text.strip() or "\n" in text.strip() or "Traceback" in text:
                self._note("unclear", f"{self._target.name}: {text[:60]!r}", text, data)

    def _note(self, kind: str, where: str, text: str, data: bytes) -> None:
        if (kind, where) in self._known:
            return
        self._known.add((kind, where))
        fault = Fault(self._target.name, kind, where, text[:400], data[:_SHOWN].hex())
        with self._kept.open("a", encoding="utf-8") as file:
            file.write(json.dumps(asdict(fault)) + "\n")


def _place(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    ours = [
        each for each in frames if any(f"/{room}/" in each.filename for room in ("core", "app", "drivers"))
    ]
    last = (ours or frames)[-1]
    return f"{type(error).__name__} {'/'.join(Path(last.filename).parts[-3:])}:{last.lineno}"


def faults_in(kept: Path) -> list[Fault]:
    """What was found."""
    if not kept.exists():
        return []
    return [Fault(**json.loads(line)) for line in kept.read_text(encoding="utf-8").splitlines()]
