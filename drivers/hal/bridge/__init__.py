"""Code that runs under the system's Python with LinuxCNC's ``hal`` module and has no other requirements."""
