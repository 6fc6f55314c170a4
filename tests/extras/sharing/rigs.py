"""The places in which desks share, each with what can be done to it from outside."""

from __future__ import annotations

import importlib.util
import json
import os
from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from core.extras.sharing.shared_database import SharedDatabase
from core.extras.sharing.shared_folder import MARKER_FILE_NAME, SharedFolder
from core.extras.sharing.shared_location import SharedLocation, SharingErrorCause
from tests.extras.sharing.postgres_server import PostgresServer, programs

KINDS = ("folder", "postgresql")


class PowerCut(BaseException):
    """This process ends here, as far as the code under test can tell."""


class Rig(ABC):
    """``desk`` is a number: what a desk keeps of the place for itself is its own."""

    away_cause = SharingErrorCause.AWAY

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @abstractmethod
    def place(self, desk: int = 1) -> SharedLocation:
        """The place as a desk sees it."""

    @abstractmethod
    def leave(self) -> None:
        """Nobody can reach the place any more."""

    @abstractmethod
    def come_back(self) -> None:
        """It can be reached again, as it was."""

    @abstractmethod
    def make_newer(self) -> None:
        """Laid out by a TurnDesk of the future."""

    @abstractmethod
    def litter(self) -> None:
        """Somebody puts three things into it that are none of ours: among versions two, among desks one."""

    @abstractmethod
    def cut_in_put(self, patch: pytest.MonkeyPatch) -> None:
        """The next publishing ends in its middle: power cut here, or a server that is killed there."""

    def mend(self) -> None:
        """What was cut can be used again."""

    def close(self) -> None:
        """The rig ends."""


class FolderRig(Rig):
    away_cause = SharingErrorCause.NOT_THERE

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self.shop = folder / "shop"
        self.shop.mkdir()

    def place(self, desk: int = 1) -> SharedLocation:
        del desk  # all see the same folder
        return SharedFolder(self.shop)

    def leave(self) -> None:
        self.shop.rename(self.folder / "unmounted")

    def come_back(self) -> None:
        (self.folder / "unmounted").rename(self.shop)

    def make_newer(self) -> None:
        (self.shop / MARKER_FILE_NAME).write_text('{"format": 2}')

    def litter(self) -> None:
        (self.shop / "versions" / "Thumbs.db").write_bytes(b"\0\1")
        (self.shop / "versions" / f"{'a' * 64}.version").write_bytes(b'{"format":1}\nG00')
        (self.shop / "desks" / "readme.txt").write_text("hello")

    def cut_in_put(self, patch: pytest.MonkeyPatch) -> None:
        done, replace = 0, Path.replace

        def cut(path: Path, target: Path) -> Path:
            nonlocal done
            done += 1
            if done == 3:
                raise PowerCut
            return replace(path, target)

        patch.setattr(Path, "replace", cut)


class PostgresRig(Rig):
    databases = 0

    def __init__(self, folder: Path, server: PostgresServer) -> None:
        super().__init__(folder)
        PostgresRig.databases += 1
        self.server, self.database = server, f"shop{PostgresRig.databases}"
        server.sql(f"CREATE DATABASE {self.database}")

    def place(self, desk: int = 1) -> SharedLocation:
        del desk  # all ask the same server
        return SharedDatabase(self.server.conninfo(self.database))

    def leave(self) -> None:
        self.server.kill()

    def come_back(self) -> None:
        self.server.start()

    def make_newer(self) -> None:
        self.server.sql("UPDATE turndesk.layout SET format = 2", self.database)

    def litter(self) -> None:
        rows = f"('Thumbs.db', 'x', 'x'), ('{'a' * 64}', '{json.dumps({'format': 1})}', 'G00')"
        self.server.sql(f"INSERT INTO turndesk.versions VALUES {rows}", self.database)
        self.server.sql("INSERT INTO turndesk.desks VALUES ('readme', 'x')", self.database)

    def cut_in_put(self, patch: pytest.MonkeyPatch) -> None:
        """The server is killed by its own process, at the second row of the transaction."""
        del patch
        script = self.server.folder / "kill.sh"
        script.write_text(
            f"pm=$(head -1 {self.server.folder}/data/postmaster.pid)\n"
            "all=$(cat /proc/$pm/task/$pm/children)\nkill -9 $pm $all\n"
        )
        script.chmod(0o755)
        self.server.sql(
            "CREATE FUNCTION cut() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN"
            " IF (SELECT count(*) FROM turndesk.versions) = 1 THEN"
            f" COPY (SELECT 1) TO PROGRAM 'sh {script}'; END IF; RETURN NEW; END $$;"
            "CREATE TRIGGER cut BEFORE INSERT ON turndesk.versions FOR EACH ROW EXECUTE FUNCTION cut()",
            self.database,
        )

    def mend(self) -> None:
        self.server.kill()
        self.server.start()
        self.server.sql("DROP FUNCTION cut CASCADE", self.database)

    def close(self) -> None:
        self.server.sql(f"DROP DATABASE {self.database} WITH (FORCE)")


@contextmanager
def rig_of(kind: str, folder: Path, request: pytest.FixtureRequest) -> Iterator[Rig]:
    """The rig of a kind; a test is skipped where this computer cannot have it."""
    if kind == "postgresql":
        if importlib.util.find_spec("psycopg") is None:
            pytest.skip("psycopg is not installed")
        if programs() is None or os.name != "posix":
            pytest.skip("no PostgreSQL server is installed")
        rig: Rig = PostgresRig(folder, request.getfixturevalue("postgres"))
    else:
        rig = FolderRig(folder)
    yield rig
    rig.close()
