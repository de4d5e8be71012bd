"""Names from files on the terminal: what they hold is shown, and steers nothing."""

from __future__ import annotations

import io
from pathlib import Path

from rich.table import Table
from rich.text import Text

from kineme.cli.tables import make_table
from kineme.cli.terminal import Console, print_error

STEERS = "\x1b[2J\x1b]0;owned\x07\x9b1A\u202e"


def test_errors_spell_out_what_would_steer(capsys) -> None:
    print_error(f"{Path('walk' + STEERS)}: is damaged\nline\ttwo")
    told = capsys.readouterr().err
    assert not set("\x07\x9b\u202e") & set(told)
    assert "\x1b[2J" not in told
    assert r"walk\x1b[2J\x1b]0;owned\x07\x9b1A\u202e: is damaged" in told
    assert "\nline\ttwo" in told


def test_tables_spell_it_out_and_keep_their_own_colours() -> None:
    table = Table("joint")
    table.add_row(Text(f"hip{STEERS}", style="bold red"))
    for terminal in (True, False):
        file = io.StringIO()
        console = Console(file=file, force_terminal=terminal, width=120)
        console.print(Text(STEERS), table, f"plain {STEERS}")
        told = file.getvalue()
        assert not set("\x07\x9b\u202e") & set(told)
        assert not any(code in told for code in ("\x1b[2J", "\x1b]"))
        assert r"hip\x1b[2J" in told
        assert ("\x1b[1;31m" in told) == terminal


def test_a_row_is_a_line_where_there_is_no_edge_and_else_folded() -> None:
    label = "warming up " * 30
    table = make_table("#", "recording", "start s", "stop s", "distance", "cluster", "label")
    table.add_row("0", "HuGaDB_v2_various_02_07.txt", "12.25", "13.50", "0.42", "3", label)
    file = io.StringIO()
    Console(file=file).print(table)
    assert label.strip() in file.getvalue()
    terminal = io.StringIO()
    Console(file=terminal, force_terminal=True, width=70).print(table)
    told = Text.from_ansi(terminal.getvalue()).plain
    assert max(map(len, told.splitlines())) == 70
    assert "…" not in told
    assert "_07.txt" in told
