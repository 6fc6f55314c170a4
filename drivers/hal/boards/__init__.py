"""Generators of HAL files for LinuxCNC from the machine file, with one module per board."""
