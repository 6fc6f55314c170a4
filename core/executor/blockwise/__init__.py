"""A cycle on a controller that plans by itself: blocks instead of setpoints, everything else the same."""
