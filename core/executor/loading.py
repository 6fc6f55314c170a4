"""What Cycle Start will begin: a program with its proof, a restart in it, or a line of MDI."""

from __future__ import annotations

from core.executor.bench import Bench
from core.executor.commands import ConfirmStart, GiveProof, LoadJob, PartsMade, Prepare, Renew
from core.executor.conductor import Conductor
from core.executor.snapshot import Starts
from core.executor.states import CYCLE

_UNDER_WAY = "a program is under way: it must end or be reset before another is loaded"


class Loading:
    """Obeys these commands, on the executor's thread; what it refuses it says."""

    def __init__(self, bench: Bench, conductor: Conductor) -> None:
        self._bench = bench
        self._conductor = conductor

    def obey(self, command: LoadJob | GiveProof | Renew | Prepare | ConfirmStart | PartsMade) -> None:
        """Do it, or say why not."""
        if isinstance(command, GiveProof):
            self._conductor.standing.proof = command.proof
        elif isinstance(command, Renew):
            self._renew(command)
        elif isinstance(command, PartsMade):
            self._conductor.counters.made = max(0, command.parts)
        elif isinstance(command, ConfirmStart):
            self._confirm(command)
        elif self._conductor.state in CYCLE:
            self._bench.say("refused", _UNDER_WAY)
        elif isinstance(command, LoadJob):
            self._load(command)
        else:
            self._prepare(command)

    def _load(self, command: LoadJob) -> None:
        """A restart belonged to the program before; an open SEARCHTO or MDI stays open."""
        standing = self._conductor.standing
        self._conductor.rounds.interruption.loaded(command.job)
        standing.job, standing.proof, standing.start_refused = command.job, command.proof, ""
        self._conductor.rounds.renewal.forget()
        if standing.starts is Starts.RESTART:
            self._prepare(Prepare(Starts.RESTART))
        self._bench.say("load", command.job.source.name)

    def _renew(self, command: Renew) -> None:
        """Under a running program it waits for the end of the part; else it counts at once."""
        rounds, standing = self._conductor.rounds, self._conductor.standing
        why = rounds.renewal.ask(command, standing.job)
        if why:
            self._bench.say("refused", why)
        elif self._conductor.state not in CYCLE:
            rounds.renewal.take_up(standing)

    def _confirm(self, command: ConfirmStart) -> None:
        why = self._conductor.rounds.interruption.answer(command.at)
        self._conductor.standing.start_refused = ""
        if why:
            self._bench.say("refused", why)
        elif command.at:
            self._bench.say("confirmed", "a start at the first line is meant")

    def _prepare(self, command: Prepare) -> None:
        standing = self._conductor.standing
        self._conductor.rounds.interruption.withdraw()
        standing.starts, standing.start_refused = command.starts, ""
        standing.prepared, standing.prepared_proof = command.job, command.proof
