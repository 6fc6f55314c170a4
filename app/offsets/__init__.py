"""The pages TOOL OFFSETS, SECONDARY OFFSETS and ZERO OFFSETS: model and view."""
