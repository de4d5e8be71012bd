"""``kineme`` for many commands: each runs in a copy of a process that has imported everything.

What a command imports, compiled code above all, takes longer than what most commands do. Here one
process imports it, and forks itself for each command, with the folder, environment and standard
files of whoever typed it.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages

COMMAND = """#!{python} -IS
import json, os, socket, sys

line = socket.socket(socket.AF_UNIX)
line.connect({address!r})
said = json.dumps([sys.argv[1:], os.getcwd(), dict(os.environ)]).encode()
socket.send_fds(line, [b" "], [0, 1, 2])
line.sendall(said)
line.shutdown(socket.SHUT_WR)
ended = line.recv(1)
sys.exit(ended[0] if ended else 1)
"""
ROOMS = ("clips", "cli", "cycles", "evaluation", "library", "methods", "report", "synthesis")


@contextmanager
def ready_kineme(folder: Path) -> Iterator[Path]:
    """A folder to put first on the path, with a ``kineme`` in it, while the block lasts."""
    command, address = folder / "kineme", folder / "line"
    command.write_text(COMMAND.format(python=sys.executable, address=str(address)))
    command.chmod(0o755)
    process = subprocess.Popen(
        [sys.executable, __file__, str(address)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    try:
        process.stdout.readline()  # once it listens
        yield folder
    finally:
        process.kill()
        process.communicate()


def serve(address: str) -> None:
    """Wait for commands, and run each."""
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(address)
    listening.listen()
    load()
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    while True:
        line, _ = listening.accept()
        if os.fork() == 0:
            if os.fork() == 0:  # whose end nobody needs to wait for
                run(line)
            os._exit(0)
        os.wait()
        line.close()


def load() -> None:
    """What commands import."""
    import_module("matplotlib.pyplot")
    for room in ROOMS:
        package = import_module(f"kineme.{room}")
        for module in walk_packages(package.__path__, f"{package.__name__}."):
            with suppress(ImportError):  # of what needs more packages
                import_module(module.name)


def run(line: socket.socket) -> None:
    """One command, in this copy of the process, which ends with it."""
    _, files, _, _ = socket.recv_fds(line, 1, 3)
    with line.makefile("rb") as said:
        arguments, folder, environment = json.load(said)
    for i, file in enumerate(files):
        os.dup2(file, i)
        os.close(file)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    sys.argv = ["kineme", *arguments]
    from kineme.cli import main

    code: object = 0
    try:
        main()
    except SystemExit as end:
        code = end.code
    except BaseException:  # noqa: BLE001 (the copy ends here, whatever it is)
        sys.excepthook(*sys.exc_info())
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    line.send(bytes([code if isinstance(code, int) else bool(code)]))
    os._exit(0)


if __name__ == "__main__":
    serve(sys.argv[1])
