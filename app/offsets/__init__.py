"""Models and views of the pages TOOL OFFSETS, SECONDARY OFFSETS and ZERO OFFSETS."""
