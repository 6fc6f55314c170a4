"""A PostgreSQL server of the tests' own: not as root, on a socket in its folder, killed whenever wanted."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import tempfile
from contextlib import suppress
from pathlib import Path

USER = "nobody"  # the server refuses to run as root


def programs() -> Path | None:
    """The folder of the newest server's programs; None: none is installed."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: int(path.parts[4]))
    if found:
        return found[-1].parent
    named = shutil.which("initdb")
    return Path(named).resolve().parent if named else None


class PostgresServer:
    """``conninfo`` reaches it while it runs. What is on its disk stays when it is killed."""

    def __init__(self, bin_folder: Path) -> None:
        self._bin = bin_folder
        self.folder = Path(tempfile.mkdtemp(prefix="td-pg-"))
        self._user = USER if os.geteuid() == 0 else None
        if self._user is not None:
            shutil.chown(self.folder, self._user)
        self._data = self.folder / "data"
        words = ["--no-sync", "--auth=trust", "--encoding=UTF8", "--locale=C", "--username=shop"]
        self._run([str(self._bin / "initdb"), "-D", str(self._data), *words])
        self._process: subprocess.Popen[bytes] | None = None

    def conninfo(self, database: str, user: str = "shop") -> str:
        """For one of its databases."""
        return f"host={self.folder} dbname={database} user={user}"

    def start(self) -> None:
        """Back when it answers."""
        words = [
            "-c",
            "fsync=off",
            "-c",
            "listen_addresses=",
            "-c",
            "autovacuum=off",
            "-c",
            "max_connections=20",
        ]
        self._process = subprocess.Popen(
            [str(self._bin / "postgres"), "-D", str(self._data), "-k", str(self.folder), *words],
            user=self._user,
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        ready = [str(self._bin / "pg_isready"), "-q", "-h", str(self.folder), "-t", "1"]
        while subprocess.run(ready, check=False).returncode:
            if self._process.poll() is not None:  # its forerunner's memory was still in use
                self.start()
                return

    def sql(self, text: str, database: str = "postgres") -> None:
        """One statement or several, by the server's own client."""
        words = ["-X", "-q", "-h", str(self.folder), "-U", "shop", "-d", database, "-v", "ON_ERROR_STOP=1"]
        self._run([str(self._bin / "psql"), *words, "-c", text])

    def kill(self) -> None:
        """SIGKILL to it and to all that it has started."""
        if self._process is None:
            return
        pid = self._process.pid
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        for each in (pid, *map(int, children)):
            with suppress(ProcessLookupError):
                os.kill(each, signal.SIGKILL)
        self._process.wait()
        self._process = None

    def remove(self) -> None:
        """It and its folder."""
        with suppress(OSError):
            self.kill()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _run(self, words: list[str]) -> None:
        done = subprocess.run(words, user=self._user, cwd=self.folder, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr.decode(errors="replace")
