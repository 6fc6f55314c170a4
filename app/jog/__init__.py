"""The Jog page: moving by hand, homing, setting tools and touching them off."""
