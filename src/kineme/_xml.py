"""XML of strangers: what every parser of it refuses."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree as ET


class NoEntities:
    """A target of `xml.etree.ElementTree.XMLParser` whose documents define no entities."""

    def doctype(self, *_: Any) -> None:
        """Refuse: entities are defined here, and could grow a small file without bounds."""
        raise ET.ParseError("it has a document type")
