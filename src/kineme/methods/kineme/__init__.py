"""Method of ``kineme`` and ``sensors``: the shortest description of a recording by segments.

A segment is described by the similarity of its samples, or by a movement that it repeats.

================= ========================================================================
``constants``     the constants, each with its unit and its value for bodies
``preset``        both presets
``pipeline``      the stages, one after the other
``views``         posture and energy of movement, and the choice among several views
``tree``          fine borders, a tree of segments, and the level of the shortest description
``repeating``     the share of its cost that a segment saves by repeating itself
``borders``       borders to the frame, and transitions
``repetitions``   the number of repetitions of a segment, and cuts between them
``ends``          where the first repetition begins and the last one ends
``events``        spans that recur now and then
``primitives``    segments with their repetitions, clusters and events
``confidence``    probabilities of all these, which no stage reads
``found``         the results of all stages, and tables at several levels of detail
================= ========================================================================

``docs/method.md`` explains each step.
"""
