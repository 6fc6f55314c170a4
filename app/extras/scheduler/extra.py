"""Registration of proofs on other computers."""

from __future__ import annotations

from app.compose.extra import Extra


class ProofsElsewhere(Extra):
    """Optional feature with the option --scheduler of ``turndesk prove``."""

    proof_workers = "app.extras.scheduler.proof_scheduler.Scheduler"


EXTRA = ProofsElsewhere()
