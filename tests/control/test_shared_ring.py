"""The scope's ring in memory that two processes share."""

from __future__ import annotations

import os
import subprocess
import sys
from multiprocessing.connection import Pipe

import numpy as np
import pytest

from app.compose.control.descriptor_passing import SharedMemory, receive_descriptor, send_descriptor
from core.records.record_ring import RingLayout, RowBuffer, ScopeRing, calculate_buffer_size

RECORDED = RingLayout({"X": False, "Z": False}, duration_s=1.0)
_WRITER = """
import sys, numpy as np, mmap, os
from core.records.record_ring import RowBuffer
memory = memoryview(mmap.mmap(int(sys.argv[1]), 0))
rows = RowBuffer(64, 8, memory)
n = 0
sys.stdout.write("x"); sys.stdout.flush()
while n < 300_000:
    count = 1 + n % 7
    numbers = np.arange(n + 1, n + 1 + count, dtype=float)
    rows.append_rows(np.repeat(numbers[:, None], 8, axis=1))
    n += count
"""


def test_ring_written_by_another_process_never_shows_a_partial_row() -> None:
    file = os.memfd_create("ring")
    os.ftruncate(file, calculate_buffer_size(64, 8))
    rows = RowBuffer(64, 8, SharedMemory(file).memory_view)
    writer = subprocess.Popen(
        [sys.executable, "-c", _WRITER, str(file)], pass_fds=(file,), stdout=subprocess.PIPE
    )
    assert writer.stdout is not None
    writer.stdout.read(1)
    seen = 0
    while writer.poll() is None:
        read = rows.copy_rows_between(-np.inf, np.inf)
        seen += len(read)
        assert (read == read[:, :1]).all()
        assert (np.diff(read[:, 0]) > 0).all()
    writer.stdout.close()
    os.close(file)
    assert seen > 1000
    assert rows.last_time_s >= 300_000


def test_shared_ring_shows_rows_written_by_the_other_process() -> None:
    ours, theirs = Pipe()
    memory = SharedMemory.create(RECORDED.size_bytes)
    send_descriptor(theirs, memory.descriptor)
    there, here = (
        ScopeRing.from_layout(RECORDED, memory.memory_view),
        ScopeRing.from_layout(RECORDED, SharedMemory(receive_descriptor(ours)).memory_view),
    )
    there.samples.append_rows(np.full((1, RECORDED.sample_width), 5.0))
    assert here.samples.last_time_s == 5.0
    ours.close()
    theirs.close()


def test_missing_shared_memory_ends_the_connection() -> None:
    ours, theirs = Pipe()
    theirs.close()
    with pytest.raises(EOFError):
        SharedMemory(receive_descriptor(ours))
    ours.close()
