"""CiA 402 drives and CiA 401 terminals on a CAN bus. Needs python-can and canopen."""
