"""Tools, offsets, spindle, dwells and M codes of OmniTurn."""
