"""Rigs of shared places, and desks that share in them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from app.extras.sharing.sharing import ProgramSharing
from core.store.store import Store
from tests.extras.sharing.postgres_server import PostgresServer, programs
from tests.extras.sharing.rigs import KINDS, Rig, rig_of

MakeDesk = Callable[[int], ProgramSharing]


@pytest.fixture(scope="session")
def postgres() -> Iterator[PostgresServer]:
    """One server for all tests of a worker."""
    found = programs()
    assert found is not None
    server = PostgresServer(found)
    try:
        server.start()
        yield server
    finally:
        server.remove()


@pytest.fixture(params=KINDS)
def rig(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Rig]:
    """Each kind of place, laid out."""
    with rig_of(request.param, tmp_path, request) as made:
        made.place().set_up()
        yield made


@pytest.fixture
def folder_rig(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Rig]:
    """The cheapest kind, where the kind does not matter."""
    with rig_of("folder", tmp_path, request) as made:
        made.place().set_up()
        yield made


def desks_of(rig: Rig, stack: ExitStack) -> MakeDesk:
    """Desks with stores and program folders of their own."""
    made: dict[int, ProgramSharing] = {}

    def desk(number: int) -> ProgramSharing:
        if number not in made:
            home = rig.folder / f"desk-{number}"
            (home / "programs").mkdir(parents=True)
            store = stack.enter_context(Store.open(home))
            made[number] = ProgramSharing(
                rig.place(number), f"LATHE {number}", f"{number:032x}", home / "programs", lambda: store
            )
        return made[number]

    return desk


@pytest.fixture
def desk(rig: Rig) -> Iterator[MakeDesk]:
    """Desks in each kind of place."""
    with ExitStack() as stack:
        yield desks_of(rig, stack)


@pytest.fixture
def desk_at_folder(folder_rig: Rig) -> Iterator[MakeDesk]:
    """Desks that share in a folder."""
    with ExitStack() as stack:
        yield desks_of(folder_rig, stack)
