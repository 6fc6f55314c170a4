"""Machine drivers, with one folder for each kind of machine.

Every driver implements the ports of ``core.ports``.
"""
