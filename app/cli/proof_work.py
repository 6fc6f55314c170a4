"""One program to prove as a unit of work: it and its result can be sent to another process or computer."""

from __future__ import annotations

import pickle
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.cli.figures import Json
    from core.interpreter.job_setup import Setup
    from core.language.source import Source
    from core.machine.machine_model import Machine
    from core.proving.part_proof import PartSetting

_ROOT = Path(__file__).parents[2]
_ROOMS = ("app/cli", "app/compose", "core")  # what a proof is made by


@dataclass(frozen=True)
class ProofJob:
    """What is the same for all programs that are proved together."""

    machine: Machine
    setup: Setup
    setting: PartSetting
    ideal: bool = False
    optional_stop: bool = False

    @cached_property
    def packed(self) -> bytes:
        """The job as it is sent."""
        return pickle.dumps(self)


@dataclass(frozen=True, slots=True)
class Proof:
    """What proving has found: the object of ``--json``, empty where ``fault`` says why there is none.

    ``seconds`` is how long it took, 0 where it was kept from another time.
    """

    report: Json
    fault: str = ""
    seconds: float = 0.0

    def count(self, severity: str) -> int:
        """How many findings weigh so much."""
        return sum(1 for _ in self.findings(severity))

    def findings(self, severity: str) -> Iterator[Json]:
        """The findings that weigh so much."""
        found = self.report.get("diagnostics", [])
        assert isinstance(found, list)
        return (each for each in found if each["severity"] == severity)


class OtherVersionError(Exception):
    """The worker has another TurnDesk than the one that asks: its proofs would not be ours."""


def proof_of(packed: bytes, version: str, source: Source) -> Proof:
    """Prove one program; runs in a worker. Raises OtherVersionError, unless ``version`` is empty."""
    if version and version != code_version():
        raise OtherVersionError
    start = time.perf_counter()
    proof = proved(_unpacked(packed), source)
    return replace(proof, seconds=time.perf_counter() - start)


def proved(job: ProofJob, source: Source) -> Proof:
    """Prove one program here."""
    from app.cli.proof_json import report_json
    from core.proving.part_proof import prove_with_part

    report, part = prove_with_part(source, job.setup, job.machine, job.setting, ideal=job.ideal)
    return Proof(report_json(source.name, report, part, optional_stop=job.optional_stop))


@lru_cache(maxsize=4)
def _unpacked(packed: bytes) -> ProofJob:
    job: ProofJob = pickle.loads(packed)
    return job


@lru_cache(maxsize=1)
def code_version() -> str:
    """A hash of the program text of TurnDesk itself: a version number does not change while it is mended."""
    total = sha256()
    for room in _ROOMS:
        for path in sorted((_ROOT / room).rglob("*.py")):
            total.update(path.relative_to(_ROOT).as_posix().encode() + b"\0" + path.read_bytes())
    return total.hexdigest()
