"""Rows outlive a program that is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from time import monotonic, sleep

import numpy as np
import pytest

import kineme
from kineme.errors import ParameterError, ReadError, WriteError
from kineme.live.sources import Rows
from kineme.live.storage import Journal, recover_journal

CODE = """
import sys, time
import numpy as np
from kineme.live.storage import Journal
journal = Journal(sys.argv[1], ["x", "y"], 100.0)
for i in range(10**6):
    journal.write(np.array([[i % 7, i * i % 11]]))
    print(i, flush=True)
"""


def test_a_kill_loses_no_row_that_was_written(tmp_path):
    for turn in range(2):
        with subprocess.Popen(
            [sys.executable, "-c", CODE, str(tmp_path / f"take{turn}")],
            stdout=subprocess.PIPE,
            text=True,
        ) as process:
            for _ in range(40 + 25 * turn):
                last = process.stdout.readline()
            os.kill(process.pid, signal.SIGKILL)
        journal = tmp_path / f"take{turn}.journal.csv"
        with journal.open("a") as file:
            file.write("12,3")  # as if a line had been cut
        signals = kineme.read(recover_journal(journal))
        assert not journal.exists()
        assert signals.n_frames >= int(last) + 1
        np.testing.assert_array_equal(signals.values[:, 0], np.arange(signals.n_frames) % 7)


def test_a_journal_becomes_a_parquet_file_with_the_rows_as_they_came(tmp_path):
    journal = Journal(tmp_path / "take", ["x", "y"], 50.0)
    journal.write(np.array([[1.0, np.nan], [2.0, np.nan]]), np.array([7.0, 7.02]))
    journal.write(np.array([[3.0, 4.0]]), np.array([7.04]))
    path = journal.close()
    assert path == tmp_path / "take.parquet"
    import pyarrow.parquet as pq

    table = pq.read_table(path).to_pydict()
    assert table == {"time_s": [7.0, 7.02, 7.04], "x": [1, 2, 3], "y": [None, None, 4]}


def test_rows_are_written_before_they_are_taken(tmp_path):
    def source():
        for i in range(20):
            yield Rows(np.full((1, 1), float(i)))
        raise ParameterError("the source fails")

    journal = Journal(tmp_path / "take", ["x"], 50.0)
    ahead = journal.write_ahead(source())
    assert next(ahead).values == 0
    latest = monotonic() + 10
    while len(journal.path.read_text().splitlines()) < 21:
        assert monotonic() < latest
        sleep(0.01)
    with pytest.raises(ParameterError, match="source fails"):
        list(ahead)
    journal.close()


def test_what_is_there_is_not_replaced(tmp_path):
    open_one = Journal(tmp_path / "take", ["x"], 50.0)
    with pytest.raises(WriteError, match="--recover"):
        Journal(tmp_path / "take", ["x"], 50.0)
    with pytest.raises(WriteError, match="still being written"):
        recover_journal(open_one.path)
    open_one.close()
    (tmp_path / "other.parquet").write_bytes(b"")
    with pytest.raises(WriteError, match="another name"):
        Journal(tmp_path / "other.parquet", ["x"], 50.0)
    (tmp_path / "table.csv").write_text("a\n1\n")
    with pytest.raises(ReadError, match="not a journal"):
        recover_journal(tmp_path / "table.csv")
