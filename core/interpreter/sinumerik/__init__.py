"""The SINUMERIK turning dialect made into elementary blocks, with C as the third axis."""
