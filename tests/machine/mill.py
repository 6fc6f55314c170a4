"""A machine file of a mill with an A-C table, for tests."""

from __future__ import annotations

SLIDE = """
travel = [-500.0, 500.0]
vmax = 15000
amax = 3000
count = 0.001
fe_window = 2.0
in_pos = 0.005
absolute = true
"""
ROTARY = """
vmax = 3600
amax = 720
count = 0.001
fe_window = 2.0
in_pos = 0.01
"""
MILL = f"""
[machine]
name = "M"
units = "mm"
kind = "mill"
commit_ms = 30
lookahead_ms = 1000
low_water_ms = 80
lease_ms = 60
setpoint_ms = 1
[limits]
max_feed = 15000
manual_rapid = 5000
resolution = 0.001
clearance = 40.0
[axis.X]{SLIDE}[axis.Y]{SLIDE}[axis.Z]{SLIDE}
[axis.A]{ROTARY}
travel = [-120.0, 120.0]
absolute = true
[axis.C]{ROTARY}
absolute = true
[spindle]
rpm = [50, 8000]
accel_rpm_s = 4000
decel_rpm_s = 4000
at_speed_pct = 5
at_speed_s = 0.3
timeout_s = 5
stop_below = 5
encoder_ppr = 1024
[io.out]
coolant = {{ at = "OUT-1", safe = false }}
[io.in]
estop = {{ at = "IN-1", active = "low" }}
start = {{ at = "IN-2" }}
[interlocks]
spindle_with_collet_open = true
"""
