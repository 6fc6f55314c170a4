"""What programs read of the machine, as the desk is what people read. Nothing in here commands."""
