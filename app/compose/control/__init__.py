"""Control process with the executor and the drivers. The operator screen is its client."""
