"""The fixtures of the tests of commands."""

from tests.cli.conftest import home, refusals, turndesk
from tests.cli.say import say

__all__ = ["home", "refusals", "say", "turndesk"]
