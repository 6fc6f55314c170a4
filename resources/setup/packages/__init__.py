"""Release artifacts: an environment with all Python packages, as a tarball and as a Debian package."""
