"""What the desk shows of the machine: readouts, states, prompts, notices and sounds."""
