"""Make a package known as an installer does."""

from __future__ import annotations

from pathlib import Path


def install_package(site: Path, name: str, entry_points: str) -> None:
    """Write the folder beside the modules of a package that names its objects."""
    info = site / f"{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(entry_points)
