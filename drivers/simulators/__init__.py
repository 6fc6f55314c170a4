"""Simulators of the machine and of the devices that TurnDesk controls."""
