"""The command ``turndesk prove DIR``, which proves all programs of folders on all CPU cores."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import CancelledError, Executor, Future
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.part_options import apply_stored_part
from app.cli.program_options import read_source
from app.cli.proofs.progress_bar import ProgressBar
from app.cli.proofs.proof_cache import ProofCache
from app.cli.proofs.proof_job import ProofJob, ProofJobsByMachine, describe_machine_choice
from app.cli.proofs.proof_pool import (
    WORKER_KILLED_TEXT,
    LocalWorkers,
    WorkDistributor,
    WorkerProvider,
    count_cores,
)
from app.cli.proofs.proof_work import (
    Proof,
    VersionMismatchError,
    get_code_hash,
    prove_pickled_program,
)
from app.cli.proofs.report_file import ReportFile, open_report
from app.compose.optional_features import find_worker_class_name
from app.compose.part_data import read_stored_parts
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, EXIT_USAGE, CommandError
from core.language.source import ProgramSource
from core.message import Message

if TYPE_CHECKING:
    from core.proving.program_tools import PartSettings


@dataclass(frozen=True, slots=True)
class ProgramFiles:
    """Program files found, sorted by name, and the number of files that are not programs."""

    paths: tuple[Path, ...]
    other_file_count: int


def find_programs(names: Iterable[str]) -> ProgramFiles:
    """Return the program files among the named files and in the named folders.

    Files named explicitly may have any suffix. Raises CommandError if a folder cannot be read or contains
    no program, or if a name is empty.
    """
    found: set[Path] = set()
    others = 0
    for path in map(Path, _expand_names(names)):
        if not path.is_dir():
            found.add(path)
            continue
        there = list(_iterate_files(path))
        programs = {each for each in there if _is_program(each)}
        if not programs:
            raise CommandError(
                Message(
                    "{path} does not contain any programs{there_count}; use a different folder",
                    path=path,
                    there_count=_among(len(there)),
                ),
                "no-programs",
            )
        found |= programs
        others += len(there) - len(programs)
    return ProgramFiles(tuple(sorted(found, key=_by_name)), others)


def _expand_names(names: Iterable[str]) -> Iterator[str]:
    """Yield the names of files and folders from the command line.

    Raises CommandError if a name is empty, because it would mean the current folder.
    """
    for name in names:
        if not name:
            raise CommandError("the file name is empty; use . for the programs in this folder", "empty-name")
        yield name


def _among(count: int) -> str:
    return Message(", only {count} other file{value}", count=count, value="s" * (count > 1)) if count else ""


def _by_name(path: Path) -> tuple[list[str], str]:
    return [part.lower() for part in path.parts], str(path)


def _iterate_files(folder: Path) -> Iterator[Path]:
    """Yield all files in a folder and its subfolders.

    Hidden folders are skipped, and links to folders are not followed.
    """
    for where, folders, names in os.walk(folder, onerror=_unreadable):
        folders[:] = [name for name in folders if not name.startswith(".")]
        yield from (Path(where) / name for name in names)


def _unreadable(error: OSError) -> None:
    raise CommandError(
        Message(
            "{file} cannot be read ({cause}); check its permissions",
            file=error.filename,
            cause=error.strerror,
        ),
        "unreadable",
    ) from error


def _is_program(path: Path) -> bool:
    from app.desk.programs.program_folder import PROGRAM_EXTENSIONS

    return path.suffix.lower() in PROGRAM_EXTENSIONS and not path.name.startswith(".") and path.is_file()


def prove_programs(args: argparse.Namespace, jobs: ProofJobsByMachine) -> int:
    """Prove all programs. Return 1 if a program has errors, or 2 if a program cannot be read."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    files = find_programs(args.files)
    with open_report(args) as report:
        run = _FolderProofRun(args, jobs, files, _workers(args), report)
        run.prove_programs()
    return run.print_results()


def _workers(args: argparse.Namespace) -> WorkerProvider:
    if args.scheduler is None:
        return LocalWorkers(args.jobs if args.jobs is not None else count_cores())
    module, _, name = find_worker_class_name().rpartition(".")
    source: WorkerProvider = getattr(import_module(module), name)(args.scheduler)
    return source


@dataclass(frozen=True, slots=True)
class _ProofUnit:
    """A program to prove, with its index in the order of names and its location in the proof cache."""

    program_index: int
    source: ProgramSource
    job: ProofJob
    cache_key: str
    cache: ProofCache | None


class _FolderProofRun:
    """One execution of ``turndesk prove DIR``, with the programs to prove and the results so far."""

    def __init__(
        self,
        args: argparse.Namespace,
        jobs: ProofJobsByMachine,
        files: ProgramFiles,
        workers: WorkerProvider,
        report: ReportFile | None,
    ) -> None:
        from app.desk.data_folder import find_data_folder

        self._args, self._jobs, self._files, self._workers = args, jobs, files, workers
        self._report = report
        names = (path.name for path in files.paths)
        self._kept_parts = read_stored_parts(names)
        # worker processes of this computer have the same version
        self._version = get_code_hash() if args.scheduler is not None else ""
        self._folder = find_data_folder() / "proofs"
        self._caches: dict[str, ProofCache] = {}  # =
        self._proofs: dict[int, Proof] = {}
        self._told = 0
        self._progress = ProgressBar("proving", len(files.paths))

    def prove_programs(self) -> None:
        """Prove all programs, and save completed proofs even if the command is interrupted."""
        proving: WorkDistributor[_ProofUnit, Proof] = WorkDistributor(self._workers, self._submit)
        results = proving.iterate_results(self._iterate_units())
        try:
            with self._progress:
                for unit, made in results:
                    self._add(unit.program_index, self._kept(unit, made))
        except CancelledError as error:
            raise CommandError(
                Message(
                    "the connection to --scheduler {scheduler} was lost; completed proofs are saved; run "
                    "the command again",
                    scheduler=self._args.scheduler,
                ),
                "scheduler-gone",
            ) from error
        finally:
            results.close()
            for cache in self._caches.values():
                cache.delete_oldest_proofs()

    def print_results(self) -> int:
        """Print the table of results and return the exit status.

        With --json, print only the number of files that are not programs.
        """
        rows = [(path, self._proofs[k]) for k, path in enumerate(self._files.paths)]
        others = self._files.other_file_count
        if not self._args.json:
            sys.stdout.write(format_proof_table(rows, others))
        elif others:
            sys.stderr.write(f"turndesk: {others} other file{'s' * (others > 1)} skipped\n")
        return max(_status(proof) for _, proof in rows)

    def _submit(self, executor: Executor, unit: _ProofUnit) -> Future[Proof]:
        return executor.submit(prove_pickled_program, unit.job.pickled_job, self._version, unit.source)

    def _iterate_units(self) -> Iterator[_ProofUnit]:
        """Yield the next program without a saved proof whenever a worker becomes available."""
        for index, path in enumerate(self._files.paths):
            try:
                source = read_source(path, self._args)
                machine = self._jobs.select_machine_name(source)
                common = self._jobs.get_job(machine)
                job = self._create_job(source, common)
            except CommandError as error:
                self._add(index, Proof({}, failure_reason=str(error)))
                continue
            cache, own = (
                self._get_cache(machine, common),
                _program_data(job.part_settings) if job is not common else None,
            )
            key = cache.get_cache_key(source, own) if cache is not None else ""
            found = cache.find_proof(key) if cache is not None else None
            if found is not None:
                self._add(index, found)
            else:
                yield _ProofUnit(index, source, job, key, cache)

    def _get_cache(self, machine: str, job: ProofJob) -> ProofCache | None:
        """Return the proof cache for this machine, or None if caching is off.

        The first call for each machine also prints which machine was chosen.
        """
        if machine not in self._caches:
            if machine:
                sys.stderr.write(describe_machine_choice("each Klartext program", machine))
            self._caches[machine] = ProofCache(self._folder, job)
        return None if self._args.no_cache else self._caches[machine]

    def _create_job(self, source: ProgramSource, common: ProofJob) -> ProofJob:
        """Return the common job, or a copy of the job with the stored part data of this program."""
        kept = self._kept_parts.get(source.name)
        if kept is None:
            return common
        return replace(
            common, part_settings=apply_stored_part(common.part_settings, source.name, kept, self._args)
        )

    def _kept(self, unit: _ProofUnit, made: Proof | BaseException) -> Proof:
        if isinstance(made, BaseException):
            return Proof(
                {}, failure_reason=f"{self._files.paths[unit.program_index]}: {self._describe_error(made)}"
            )
        if unit.cache is not None:
            unit.cache.save_proof(unit.cache_key, made)
        return made

    def _describe_error(self, error: BaseException) -> str:
        """Return the reason why a program could not be proved."""
        if isinstance(error, self._workers.worker_killed_exception):
            return WORKER_KILLED_TEXT
        if isinstance(error, VersionMismatchError):
            return (
                "the dask worker process runs a different version of TurnDesk than this "
                "computer; install this computer's version on the worker"
            )
        if isinstance(error, ModuleNotFoundError) and self._version:
            return Message(
                "TurnDesk is not installed on the dask worker ({error}); install TurnDesk there",
                error=error,
            )
        from app.cli.bug_report.crash_report import write_crash_file

        where = write_crash_file(type(error), error, error.__traceback__)
        what = str(error).splitlines()[0] if str(error) else type(error).__name__
        return Message(
            "internal error in TurnDesk ({what}); please report it and include {place}",
            what=what,
            place=where,
        )

    def _add(self, index: int, proof: Proof) -> None:
        if proof.report_json:
            proof.report_json["file"] = str(self._files.paths[index])
        self._proofs[index] = proof
        while self._told in self._proofs:
            self._print_result(self._files.paths[self._told], self._proofs[self._told])
            # The section is already in the report. Thousands of sections would need much memory.
            self._proofs[self._told] = replace(self._proofs[self._told], report_section="")
            self._told += 1
        self._progress.report_progress(len(self._proofs))

    def _print_result(self, path: Path, proof: Proof) -> None:
        """Print the proof of a program. The method is called for all programs in alphabetical order."""
        if proof.failure_reason:
            sys.stderr.write(f"turndesk: {proof.failure_reason}\n")
        elif self._args.json:
            sys.stdout.write(json.dumps(proof.report_json) + "\n")
            sys.stdout.flush()
        if self._report is not None:
            self._report.add_proof(path, proof)


def _status(proof: Proof) -> int:
    if proof.failure_reason:
        return EXIT_USAGE
    return EXIT_ERRORS if proof.count_findings("error") else EXIT_OK


def _program_data(setting: PartSettings) -> object:
    """Return the part settings that are specific to one program."""
    return setting.stock, setting.clamping, setting.silenced


_MAX_SLOWEST = 3
_HEAD = "verdict     errors  warnings      cycle s       removed  program\n"

ProofRow = tuple[Path, Proof]


def format_proof_table(rows: Sequence[ProofRow], other_count: int) -> str:
    """Return the complete table as text. ``other_count`` is the number of files that are not programs."""
    return (
        _HEAD + "".join(_line(path, proof) for path, proof in rows) + _sum(rows, other_count) + _slowest(rows)
    )


def format_proof_verdict(proof: Proof) -> str:
    """Return the result of a proof in one or two words."""
    if proof.failure_reason:
        return "not proved"
    return "errors" if proof.count_findings("error") else "proved"


def _line(path: Path, proof: Proof) -> str:
    word = format_proof_verdict(proof)
    if proof.failure_reason:
        return f"{word:10s}{'':38s}  {path}\n            {proof.failure_reason}\n"
    first = next(proof.iterate_findings("error"), None)
    return (
        f"{word:10s}{proof.count_findings('error'):8d}{proof.count_findings('warning'):10d}"
        f"{_number(proof.report_json['cycle_time_s']):13.2f}{_removed(proof):>14s}  {path}\n"
        + _format_comparison(proof)
        + (f"            line {first['line']}: {first['message']}\n" if first else "")
    )


def _format_comparison(proof: Proof) -> str:
    """Return one line of text that shows the effect of the offsets of --compare."""
    found = proof.report_json.get("compare")
    if not isinstance(found, dict):
        return ""
    unit = "in" if proof.report_json["dialect"] == "omniturn" else "mm"
    here, there = found["cycle_time_s"]
    return (
        f"            with {found['offsets']}: {found['differing']} of {len(found['features'])} diameters and"
        f" shoulders differ, by {found['largest']:.4f} {unit} at most; cycle {there - here:+.2f} s;"
        f" {len(found['added'])} findings new, {len(found['gone'])} gone\n"
    )


def _removed(proof: Proof) -> str:
    stock = proof.report_json.get("stock")
    if not isinstance(stock, dict):
        return "–"
    unit = "in³" if proof.report_json["dialect"] == "omniturn" else "mm³"
    return f"{stock['removed_volume']:.4g} {unit}"


def _number(value: object) -> float:
    assert isinstance(value, int | float)
    return float(value)


def _sum(rows: Sequence[ProofRow], others: int) -> str:
    words = Counter(format_proof_verdict(proof) for _, proof in rows)
    parts = [f"{words['proved']} proved"]
    parts += [Message("{words} with errors", words=words["errors"])] if words["errors"] else []
    parts += [Message("{words} not proved", words=words["not proved"])] if words["not proved"] else []
    parts += (
        [Message("{others} other file{value} skipped", others=others, value="s" * (others > 1))]
        if others
        else []
    )
    return f"{len(rows)} program{'s' * (len(rows) != 1)}: {', '.join(parts)}\n"


def _slowest(rows: Iterable[ProofRow]) -> str:
    proved = sorted((row for row in rows if row[1].duration_s), key=lambda row: -row[1].duration_s)
    if not proved:
        return ""
    named = ", ".join(f"{path} {proof.duration_s:.2f} s" for path, proof in proved[:_MAX_SLOWEST])
    return f"slowest to prove: {named}\n"
