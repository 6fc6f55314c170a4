"""Production data: tool life, cycles and stops."""
