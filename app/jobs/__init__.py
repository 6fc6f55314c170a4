"""The queue of jobs: what is made next, how many parts, what of its tools is missing on the gang plate."""
