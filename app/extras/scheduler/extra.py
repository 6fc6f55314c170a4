"""Registration of the optional feature that runs proofs on other computers."""

from __future__ import annotations

from app.compose.optional_features import OptionalFeature


class SchedulerExtra(OptionalFeature):
    """Optional feature with the option ``--scheduler`` of ``turndesk prove``."""

    worker_class_name = "app.extras.scheduler.proof_scheduler.ProofScheduler"


EXTRA = SchedulerExtra()
