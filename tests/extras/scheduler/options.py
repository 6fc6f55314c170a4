"""The option of proofs on other computers, and the test that uses it."""

COVERED = {("prove", "--scheduler"): "tests/extras/scheduler/test_scheduler.py"}
