"""Option ``prove --scheduler``, which distributes proofs to the workers of a Dask scheduler.

The workers must run the same version of TurnDesk. They receive the programs and the machine.
"""

from __future__ import annotations

import logging
import re
import sys
from concurrent.futures import Executor

from app.desk.command_errors import CommandError
from core.message import Message

_ADDRESS = re.compile(r"(?:tcp://|tls://)?(\[[0-9A-Fa-f:]+\]|[\w.-]+):(\d{1,5})")
_ANSWER = 10.0  # seconds to wait for the scheduler
_AHEAD = 256  # units that the scheduler has at once; workers can join during the proofs


class ProofScheduler:
    """Connection to a Dask scheduler and its workers.

    The constructor raises CommandError if the scheduler cannot be reached.
    """

    max_active_work_units = _AHEAD

    def __init__(self, address: str) -> None:
        if not (found := _ADDRESS.fullmatch(address)) or int(found[2]) > 65535:
            raise CommandError(
                Message(
                    "--scheduler {address} is not valid; write HOST:PORT, such as 192.168.1.20:8786",
                    address=address,
                ),
                "scheduler-address",
            )
        try:
            import distributed
        except ImportError as error:
            raise CommandError(
                "--scheduler needs dask.distributed, which is not installed; install turndesk[scheduler]",
                "no-dask",
            ) from error
        logging.getLogger("distributed").setLevel(logging.CRITICAL)  # TurnDesk reports its errors.
        self.worker_killed_exception: type[BaseException] = distributed.scheduler.KilledWorker
        try:
            self._client = distributed.Client(address, timeout=_ANSWER)
        except OSError as error:
            raise CommandError(
                Message(
                    "--scheduler {address}: no response; start the scheduler or correct the address",
                    address=address,
                ),
                "no-scheduler",
            ) from error
        if not self._client.ncores():
            sys.stderr.write(f"turndesk: {address} has no workers yet; waiting for one\n")

    def start_workers(self, _jobs: int | None = None) -> Executor:
        """Return an executor for all workers of the scheduler, including workers that connect later."""
        executor: Executor = self._client.get_executor(pure=False)
        return executor

    def stop_workers(self, executor: Executor | None, *, is_done: bool) -> None:
        """Disconnect from the scheduler. If the proof is not done, also cancel the remaining work units."""
        if executor is not None:
            executor.shutdown(wait=is_done)
        self._client.close()
