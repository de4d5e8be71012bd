"""Where to look first in a large library: windows of its recordings in 32 numbers each.

`windows` tells what these numbers are, `kept` holds those of a whole library, and `nearest` finds
the few that are like an example. Only around these is it searched sample by sample.
"""
