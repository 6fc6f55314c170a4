"""Tools, offsets, frames, spindles and M functions of SINUMERIK."""
