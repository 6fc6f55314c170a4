"""The git command line, as sharing uses it: no questions, an end to every wait, and its refusals by cause."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import threading
from collections.abc import Sequence
from pathlib import Path

from core.message import Message
from core.sharing.sharing_errors import Cause, SharingError

PATIENCE = 60.0  # s: a transfer that takes longer is given up
# In the order in which they are looked for: some of what git says names two things.
_SAID = (
    (Cause.OTHER_HOST, r"host key for .* has changed"),
    (Cause.UNKNOWN_HOST, r"host key verification failed"),
    (Cause.GIT_NOT_TRUSTED, r"certificate"),
    (Cause.NO_SSH, r"\bssh: (command )?not found|cannot run ssh"),
    (Cause.NO_GIT_THERE, r"git-(upload|receive)-pack.*not found|bad line length"),
    (
        Cause.NO_RIGHT,
        r"permission denied|authentication failed|could not read (username|password)"
        r"|access denied|error: 40[13]|dubious ownership|insufficient permission"
        r"|unable to create temporary object directory",
    ),
    (Cause.FULL, r"no space left|quota exceeded"),
    (
        Cause.NOT_THERE,
        r"does not appear to be a git repository|repository .*not found|no such file or directory",
    ),
    (Cause.REFUSED, r"hook declined|remote rejected|protected branch|not allowed"),
)
_RULES = re.compile(r"^(hint|warning|Please make sure|and the repository exists)", re.IGNORECASE)


class GitCommand:
    """Commands in one bare repository; ``remote`` is what sentences name."""

    def __init__(self, folder: Path, remote: str, *, patience: float = PATIENCE) -> None:
        self._folder, self._remote, self._patience = folder, remote, patience
        self._lock = threading.Lock()
        self._running: subprocess.Popen[bytes] | None = None
        self._closed = False

    def run(self, words: Sequence[str], data: bytes = b"") -> bytes:
        """What the command says on its stdout. Raises SharingError with the cause that its stderr tells."""
        process = self._started(words)
        try:
            out, told = process.communicate(data, timeout=self._patience)
        except subprocess.TimeoutExpired:
            raise Cause.AWAY.error(
                self._remote, Message("no response for {patience} s", patience=f"{self._patience:g}")
            ) from None
        finally:
            self._running = None
            if process.poll() is None:  # no answer, or Ctrl+C: it is in a session of its own
                _end(process)
        if process.returncode:
            refusal = self._refusal(told.decode(errors="replace"))
            refusal.told = told.decode(errors="replace")
            raise refusal
        return out

    def close(self) -> None:
        """End what is under way, and begin nothing more."""
        with self._lock:
            self._closed = True
            if self._running is not None:
                _end(self._running)

    def _started(self, words: Sequence[str]) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._closed:
                raise Cause.AWAY.error(self._remote, "TurnDesk is closing")
            try:
                self._running = subprocess.Popen(
                    [
                        "git",
                        f"--git-dir={self._folder}",
                        "-c",
                        "core.hooksPath=/dev/null",
                        "-c",
                        "gc.autoDetach=false",
                        *words,
                    ],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    env=_environment(),
                    start_new_session=True,  # ends with all that it starts, and has no terminal to ask at
                )
            except FileNotFoundError:
                raise Cause.NO_GIT.error(self._remote) from None
            except OSError as error:
                raise Cause.AWAY.error(
                    self._remote, Message("git cannot be started: {cause}", cause=error.strerror)
                ) from error
            return self._running

    def _refusal(self, told: str) -> SharingError:
        lines = [line for line in told.splitlines() if line.strip() and not _RULES.match(line.strip())]
        for cause, said in _SAID:
            found = next((line for line in lines if re.search(said, line, re.IGNORECASE)), "")
            if found:
                return cause.error(self._remote, _bare(found))
        return Cause.AWAY.error(self._remote, _bare(lines[0] if lines else "git failed"))


def _bare(line: str) -> str:
    """Without who logs in: git repeats addresses."""
    line = re.sub(r"://[^/\s'\"]*@", "://", line)
    return re.sub(r"^(remote|fatal|error|ssh): *", "", line.strip(), flags=re.IGNORECASE)


def _environment() -> dict[str, str]:
    """That of this process, without what would ask somebody or name another repository."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    kept |= {name: value for name, value in os.environ.items() if name.startswith("GIT_SSH")}
    return {
        "GIT_SSH_COMMAND": "ssh -oBatchMode=yes -oConnectTimeout=10",
        **kept,
        "GIT_TERMINAL_PROMPT": "0",
        "GIT_ASKPASS": "true",
        "SSH_ASKPASS": "true",
        "LC_ALL": "C",
    }


def _end(process: subprocess.Popen[bytes]) -> None:
    """It and what it has started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except (OSError, AttributeError):  # gone meanwhile; Windows has no groups
        process.kill()
    process.communicate()
