"""Standard cycles of SINUMERIK: stock removal, grooves, undercuts, threads, drilling and tapping."""
