VERSION = "0.1.0"
"""Version by Semantic Versioning, stated only here. The build reads it from this file (pyproject.toml)."""
