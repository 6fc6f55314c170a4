"""G54 to G59 as the operator enters them; no Qt."""
