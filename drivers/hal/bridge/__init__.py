"""Code that runs under the system's Python and requires only LinuxCNC's ``hal`` module."""
