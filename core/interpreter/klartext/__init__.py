"""Klartext programs to elementary blocks: tilted planes on a mill with rotary axes."""
