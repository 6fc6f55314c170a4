"""An editor in a temporary folder: the real prover, and an archive in memory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import setup_for
from app.compose.workshop import proof_of
from app.desk.background_work import Watch
from app.desk.programs.program_loading import LoadingSteps, Proved
from app.editor.editor import Editor, LeftProgram
from app.path.path_picture import Picture, picture_of
from core.executor.job import Job
from core.interpreter.dialects import ReadProgram
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import Source, load_source
from core.proving.program_timeline import Timeline, timed_blocks
from core.proving.prove_program import prove
from core.store.store_errors import StoreError
from core.store.store_rows import VersionRow

GOOD = "G90G94F300G72\nT1\nM03S1000\nX1Z.1\nZ-.5\nM05\nM30\n"
TOOLS = {1: ToolOffset(-12.7, -76.2)}


@dataclass
class Memory:
    """Versions as the store keeps them: the same text again is no new one."""

    kept: dict[str, list[tuple[bytes, str]]] = field(default_factory=dict)
    full: bool = False

    def versions(self, name: str) -> tuple[VersionRow, ...]:
        rows = [
            VersionRow(n, sha256(text).hexdigest(), "2026-03-01T10:00:00.000Z", why, len(text))
            for n, (text, why) in enumerate(self.kept.get(name, []), 1)
        ]
        return tuple(reversed(rows))

    def text_of(self, name: str, version: int) -> bytes:
        return self.kept[name][version - 1][0]

    def save_version(self, name: str, text: bytes, why: str) -> int:
        if self.full:
            raise StoreError("the disk is full")
        rows = self.kept.setdefault(name, [])
        if not rows or rows[-1][0] != text:
            rows.append((text, why))
        return len(rows)


def workshop() -> LoadingSteps:
    """The real interpreter and prover on the shipped lathe."""
    lathe = load_machine(None)

    def make_job(source: Source, block_delete: bool) -> Job:
        setup = setup_for(lathe, tools=TOOLS, secondary={}, block_delete=block_delete)
        return Job(source, setup, source.text, ReadProgram(source), frozenset(TOOLS))

    def proved(job: Job, watch: Watch) -> Proved:
        report = prove(job.source, job.setup, lathe, watch)
        return Proved(proof_of(job, report), report.diagnostics)

    def draw(job: Job, watch: Watch) -> Picture:
        return picture_of(timed_blocks(Timeline.of(job.source, job.setup, lathe)), watch)

    return LoadingSteps(load_source, make_job, proved, draw)


def editor_in(
    folder: Path, archive: Memory | None = None, left: Callable[[LeftProgram], None] = lambda _: None
) -> Editor:
    """The operator's programs and the samples, both empty at first."""
    (folder / "samples").mkdir(exist_ok=True)
    return Editor(workshop(), archive or Memory(), folder / "programs", folder / "samples", left)
