VERSION = "0.1.0"
"""Version number according to Semantic Versioning.

It is defined only here, and the build reads it from this file (pyproject.toml).
"""
