"""The method of ``kineme`` and ``sensors``: the shortest description of a recording by segments.

A segment is told by its samples staying alike, or as a movement that repeats.

================= ========================================================================
``constants``     what each does, in which unit, and its value for bodies
``preset``        both presets
``pipeline``      the stages, one after the other
``views``         posture and energy of movement (``features.channels``), and which view is taken
``tree``          fine borders, neighbours joined, and the level of the shortest description
``repeating``     what a segment saves by repeating itself
``level``         segments of the parts of a recording, put together
``borders``       borders to the frame
``repetitions``   how often a segment repeats itself; ``rests``, where cuts lie at rest
``ends``          where the first repetition begins and the last one ends
``likeness``      which clusters are one movement at another pace
``events``        what recurs now and then, along ``paths``; ``placing`` puts it among segments
``primitives``    repetitions and events of all segments
``confidence``    how sure all that is, which no stage reads
``found``         what comes of it, at several levels of detail
================= ========================================================================

``docs/method.md`` tells each step, and what was tried.
"""
