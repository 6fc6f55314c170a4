"""Display of the machine state: readouts, states, prompts, notices and sounds."""
