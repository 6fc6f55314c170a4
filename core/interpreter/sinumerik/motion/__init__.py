"""Motion of SINUMERIK: lines, arcs, threads, corners, compensation, TRANSMIT and TRACYL."""
