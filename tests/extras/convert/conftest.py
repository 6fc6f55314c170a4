"""The fixtures of commands that run in this process."""

from tests.cli.conftest import home, refusals, turndesk

__all__ = ["home", "refusals", "turndesk"]
