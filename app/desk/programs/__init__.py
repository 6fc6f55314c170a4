"""Loading, proving and starting of programs, and the check of their first move."""
