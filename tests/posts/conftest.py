"""The fixtures of the tests of commands."""

from tests.cli.conftest import home, refusals, turndesk

__all__ = ["home", "refusals", "turndesk"]
