"""Optional features: the table in which they are registered, and what a feature can add to TurnDesk.

The code of a feature is in ``core/extras/NAME`` (without Qt), ``app/extras/NAME`` and ``tests/extras/NAME``.
``app.extras.NAME.extra`` contains ``EXTRA``, a subclass of ``Extra`` that overrides what the feature adds.
No module outside a feature imports it. If its folders are deleted, TurnDesk works without the feature.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from app.compose.check_rows import Answers
    from app.compose.journal import Journal
    from app.desk.desk import Desk
    from app.desk.latest import Latest
    from app.desk.page_description import PageEntry
    from app.desk.persistence import Persistence
    from app.desk.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.json_key import Output
    from core.machine.machine_model import Machine
    from core.store.people import PersonRow
    from core.store.store import Store
    from core.table_schema import Driver

NAMES = ("access", "quality", "jobs", "sharing")
"""All optional features. A feature comes after the features that it needs."""

Tell = Callable[[str], None]
Close = Callable[[], None]
T = TypeVar("T")


class Extra:
    """What an optional feature adds. A feature overrides only the parts that it has.

    ``commands`` maps each subcommand to the subcommand that it follows in the help. Its module is
    ``app.extras.NAME.SUBCOMMAND_command``. ``threads`` maps each supervised thread to what an operator
    misses when the thread ends. ``own_functions`` names the special functions that
    a page of the feature shows, so that F10 does not. ``needs`` names the features without which this
    feature is left out.
    """

    needs: Sequence[str] = ()
    commands: Mapping[str, str] = {}
    pages: Sequence[PageEntry] = ()
    threads: Mapping[str, str] = {}
    own_functions: Collection[str] = ()

    def machine_tables(self) -> Sequence[Driver]:
        """Return the tables that this feature adds to the machine file."""
        return ()

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        """Attach the models of this feature to the desk; without a ``journal`` nothing is saved.

        ``work`` reads and proves programs with the offsets of this moment, and saves nothing.
        """

    def special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: Latest
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the special functions (F10) of this feature, each with the name of the one it follows."""
        return ()

    def start(self, desk: Desk, journal: Journal, tell: Tell) -> Close | None:
        """Start the threads of this feature, and return a function that ends them.

        ``tell`` reports a reason why the feature cannot run to the prompt line and to the event log.
        """

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        """Return the declared outputs of --json of this feature, by the output that they follow."""
        return {}

    def demand_pin(self, store: Store, row: PersonRow, remedy: str) -> bool:
        """Ask for the PIN of this user on the command line; return False if this feature cannot do that.

        ``remedy`` says what to do if the user has no PIN. Raises CommandError if the PIN is wrong.
        """
        return False

    def check(self, machine: Machine, answers: Answers) -> None:
        """Add the rows of this feature to ``turndesk machine check``."""


@cache
def extras() -> Mapping[str, Extra]:
    """Return the optional features that are installed, by name."""
    found: dict[str, Extra] = {}
    for name in NAMES:
        if find_spec(f"app.extras.{name}") is not None:
            extra: Extra = import_module(f"app.extras.{name}.extra").EXTRA
            if found.keys() >= set(extra.needs):
                found[name] = extra
    return found


def command_modules() -> Mapping[str, str]:
    """Return the module of each subcommand that an optional feature adds."""
    return {
        command: f"app.extras.{name}.{command}_command"
        for name, extra in extras().items()
        for command in extra.commands
    }


def insert_after(items: Iterable[T], name_of: Callable[[T], str], added: Iterable[tuple[T, str]]) -> list[T]:
    """Return ``items`` with each pair of ``added`` inserted after the item that the pair names.

    If there is no item of that name, the addition becomes the last one.
    """
    found = list(items)
    for item, after in added:
        names = [name_of(each) for each in found]
        found.insert(names.index(after) + 1 if after in names else len(found), item)
    return found
