"""Interpreter of Klartext programs for mills with rotary axes and tilted planes."""
