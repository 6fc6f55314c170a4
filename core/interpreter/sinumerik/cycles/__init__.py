"""Standard cycles of SINUMERIK: turning, grooves, undercuts, threads, drilling and tapping."""
