"""Formats of whole scenes, with characters, props and several animations: FBX, glTF, USD."""
