"""What runs under the system's Python, where LinuxCNC's ``hal`` is: it needs that Python and nothing more."""
