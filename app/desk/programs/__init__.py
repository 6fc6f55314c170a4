"""Programs on the desk: loaded, proved, made ready for Cycle Start, and their first move watched."""
