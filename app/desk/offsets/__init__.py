"""Tool and secondary offsets as the operator enters them; no Qt."""
