"""The Jog page: targets to hold, tool setting, homing."""
