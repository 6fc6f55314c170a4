"""The artifacts of a release: an environment with all Python packages, as a tarball and a Debian package."""
