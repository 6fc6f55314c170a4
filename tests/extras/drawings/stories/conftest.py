"""The stage of the stories."""

from tests.stories.conftest import forks, pytest_runtest_makereport, story

__all__ = ["forks", "pytest_runtest_makereport", "story"]
