"""The whole suite: the same examples at every run, so that a failure is a change and not a throw of dice.

``HYPOTHESIS_PROFILE=search pytest …`` looks for new ones.
"""

from __future__ import annotations

import os

from hypothesis import settings

settings.register_profile("steady", derandomize=True, deadline=None)
settings.register_profile("search", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))
