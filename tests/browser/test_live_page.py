"""Show ``kineme live`` in the browser while rows come, stop and end."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys

import numpy as np
import pytest

from axe import AXE, load_axe, violations
from screen import until
from streams import FPS, two_exercises


@pytest.mark.slow
def test_the_page_counts_and_tells_the_end(new_tab, tmp_path):
    rows = two_exercises(16.0)[: int(24 * FPS)]
    options = ["--fps", str(FPS), "--quiet", "--page", "--record", str(tmp_path / "take")]
    with subprocess.Popen(
        [sys.executable, "-m", "kineme", "live", *options],
        stdin=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "BROWSER": "true"},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as process:
        np.savetxt(process.stdin, rows, delimiter=",", header="acc_x,acc_y", comments="")
        process.stdin.flush()
        address = re.search(r"http\S+", process.stderr.readline())[0]
        page = new_tab(address)
        status = page.get_by_role("status")
        until(page, lambda: "The source has stopped" in status.inner_text())
        assert int(page.locator(".present-count").inner_text()) >= 2
        assert re.fullmatch(r"\d+ a minute", page.get_by_text("a minute").inner_text())
        assert page.locator(".past").get_by_text("cluster 0").count() == 1
        if AXE.exists():
            load_axe(page)
            for scheme in ("dark", "light"):
                page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
                assert violations(page) == []
        stranger = new_tab(re.sub("token=.*", "token=wrong", address))
        until(stranger, lambda: "does not answer" in stranger.get_by_role("status").inner_text())
        process.stdin.close()
        until(page, lambda: "ended" in status.inner_text())
        assert "the page stays" in process.stderr.readline()
        assert (tmp_path / "take.parquet").exists()
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 0
