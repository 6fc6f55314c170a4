"""HAL files for LinuxCNC's HAL, written from the machine file: one module a board."""
