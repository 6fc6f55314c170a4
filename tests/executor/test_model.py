"""A seed set of the model of the executor; ``tests.benchmarks.bench_executor_model`` runs 100 000 steps."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, settings

from tests.executor.model import ExecutorModel

pytestmark = pytest.mark.long

# The test class that hypothesis makes: the same examples at every run, by the suite's own profile.
TestExecutorModel = ExecutorModel.TestCase
TestExecutorModel.settings = settings(
    max_examples=12, stateful_step_count=30, deadline=None, suppress_health_check=list(HealthCheck)
)
