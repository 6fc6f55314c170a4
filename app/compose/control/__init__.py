"""Control process with the executor and the drivers. The operator screen is a client of this process."""
