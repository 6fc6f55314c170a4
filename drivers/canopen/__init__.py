"""Driver for CiA 402 drives and CiA 401 terminals on a CAN bus, based on python-can and canopen."""
