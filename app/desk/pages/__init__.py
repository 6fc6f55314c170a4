"""What the pages share: their tables and keys, help with codes, and why one cannot be opened now."""
