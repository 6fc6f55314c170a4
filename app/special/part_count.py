"""How many parts of the program on the desk are made, and how many shall be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.persistence import Persistence
from app.desk.translation import tr
from core.executor.commands import Command, PartsMade, SetSwitch
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.store_errors import StoreError

MOST = 9_999_999
_RUNNING = frozenset({State.RUN, State.WAIT})


@dataclass(slots=True)
class PartCounter:
    """One count for each program, kept with its target; 0 is no target.

    In the cycle that makes the last part Cycle Repeat is switched off, so that the machine stops by itself.
    """

    persistence: Persistence = field(default_factory=Persistence)
    program: str = ""
    count: int = 0
    target: int = 0
    of_job: int = 0  # the count at which the job under way is done; it goes before the target
    _seen: int | None = None
    _announced: int = -1
    _made: int = -1  # as the executor was told
    text: str = ""  # digest of the text whose parts are counted

    @property
    def words(self) -> str:
        """Parts made, and the target where there is one: ``12`` or ``12/100``."""
        return f"{self.count}/{self.aim}" if self.aim else str(self.count)

    @property
    def aim(self) -> int:
        """The count at which parts end, 0: none; that of the job under way, or else the target."""
        return self.of_job or self.target

    @property
    def reached(self) -> bool:
        """Whether all the parts that were asked for are made."""
        return 0 < self.aim <= self.count

    def see(
        self,
        snapshot: Snapshot,
        post: Callable[[Command], None],
        say: Callable[[str], None],
        text: str = "",
    ) -> None:
        """One frame: another program, another part, the last part. ``text``: digest of the loaded text."""
        name = Path(snapshot.program).name
        if name != self.program or text != self.text:
            self._load(name)
            self.text = text
            self._seen = snapshot.parts
        if self._seen is not None and snapshot.parts > self._seen:
            self.count += snapshot.parts - self._seen
            if self.reached and not self.of_job:  # the end of a job is told with what comes next
                words = tr("TARGET REACHED: {count} OF {target} PARTS")
                say(tr(Message(words, count=self.count, target=self.target)))
        self._seen = snapshot.parts
        self._tell_executor(snapshot, post)
        self._stop_at(snapshot, post, say)

    def _tell_executor(self, snapshot: Snapshot, post: Callable[[Command], None]) -> None:
        """The executor numbers the part under way by this count."""
        if self.program and self.count not in {snapshot.made, self._made}:
            post(PartsMade(self.count))
        self._made = self.count

    def _stop_at(
        self, snapshot: Snapshot, post: Callable[[Command], None], say: Callable[[str], None]
    ) -> None:
        last = snapshot.counts and self.aim > 0 and self.count + 1 >= self.aim
        if last and snapshot.cycle_repeat and snapshot.state in _RUNNING and self._announced != self.count:
            self._announced = self.count
            post(SetSwitch("cycle_repeat", False))
            say("THIS PART REACHES THE TARGET. CYCLE REPEAT IS NOW OFF")

    def _load(self, name: str) -> None:
        self.program, self.count, self.target, self._announced = name, 0, 0, -1
        if not name:
            return
        try:
            self.count = self.persistence.parts(name)
            kept = self.persistence.setting(_key(name))
        except StoreError:
            return  # the desk says by itself that nothing is kept
        self.target = kept if isinstance(kept, int) and 0 < kept <= MOST else 0

    def reload(self) -> None:
        """Read count and target again, after a restore."""
        self._load(self.program)

    def set_target(self, target: int) -> None:
        """So many parts, 0: no target. Raises StoreError when it is not kept."""
        before, self.target, self._announced = self.target, target, -1
        self.persistence.save_setting(_key(self.program), target or None)
        self.persistence.note_change(
            Message(
                "part target of {program}: {before} → {target}",
                program=self.program,
                before=before,
                target=target,
            )
        )

    def correct(self, by: int) -> None:
        """Parts that were made otherwise, or are scrap. Raises StoreError when it is not kept."""
        self.count, self._announced = self.count + by, -1
        self.persistence.correct_parts(self.program, by)
        self.persistence.note_change(
            Message(
                "part count of {program}: {count} → {count2}",
                program=self.program,
                count=self.count - by,
                count2=self.count,
            )
        )

    def reset(self) -> None:
        """The count to nought. Raises StoreError when it is not kept."""
        before, self.count, self._announced = self.count, 0, -1
        self.persistence.reset_parts(self.program)
        self.persistence.note_change(
            Message("part count of {program}: {before} → 0", program=self.program, before=before)
        )


def _key(program: str) -> str:
    return f"target:{program}"
