"""Display of the machine state, with readouts, states, prompts, notices and sounds."""
