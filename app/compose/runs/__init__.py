"""What a run needs beside the machine, and what it leaves behind."""
