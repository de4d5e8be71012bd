"""``kineme`` for many commands: each runs in a copy of a process that has imported everything.

What a command imports, compiled code above all, takes longer than what most commands do. Here one
process imports it, and forks itself for each command, with the folder, environment and standard
files of whoever typed it.
"""

from __future__ import annotations

import atexit
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
from tempfile import TemporaryDirectory

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
def ready_kineme() -> Iterator[Path]:
    """A folder to put first on the path, with a ``kineme`` in it, while the block lasts."""
    with TemporaryDirectory() as folder:  # the names of sockets are short
        command, address = Path(folder, "kineme"), f"{folder}/line"
        command.write_text(COMMAND.format(python=sys.executable, address=address))
        command.chmod(0o755)
        start = [sys.executable, __file__, address]
        with subprocess.Popen(start, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) as process:
            try:
                process.stdout.readline()  # once it listens
                yield Path(folder)
            finally:
                process.kill()


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
                return answer(line)
            os._exit(0)
        os.wait()
        line.close()


def answer(line: socket.socket) -> None:
    """Have a copy of this process run one command, and tell how it ended."""
    _, files, _, _ = socket.recv_fds(line, 1, 3)
    with line.makefile("rb") as said:
        arguments, folder, environment = json.load(said)
    if command := os.fork():
        _, status = os.waitpid(command, 0)
        line.send(bytes([os.waitstatus_to_exitcode(status) % 256]))
        os._exit(0)
    line.close()
    for i, file in enumerate(files):
        os.dup2(file, i)
        os.close(file)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    sys.argv = ["kineme", *arguments]
    code: object = 0
    try:
        import_module("kineme.cli").main()
    except SystemExit as end:
        code = end.code
    except BaseException:  # noqa: BLE001 (the copy ends here, whatever it is)
        sys.excepthook(*sys.exc_info())
        code = 1
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code if isinstance(code, int) else bool(code))  # to unload it all takes seconds


def load() -> None:
    """What commands import."""
    import_module("matplotlib.pyplot")
    for room in ROOMS:
        package = import_module(f"kineme.{room}")
        for module in walk_packages(package.__path__, f"{package.__name__}."):
            with suppress(ImportError):  # of what needs more packages
                import_module(module.name)


if __name__ == "__main__":
    serve(sys.argv[1])
