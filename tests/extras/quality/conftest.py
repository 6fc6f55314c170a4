"""The fixtures of the tests of commands."""

from tests.cli.conftest import filled, home, refusals, turndesk

__all__ = ["filled", "home", "refusals", "turndesk"]
