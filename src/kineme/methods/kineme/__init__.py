"""Method of ``kineme`` and ``sensors``: find the shortest description of a recording by segments.

A segment is described by the similarity of its samples, or by a movement that it repeats.

================= ========================================================================
``constants``     the constants, each with its unit and its value for bodies
``preset``        the presets for bodies and for signals
``pipeline``      runs all stages
``views``         posture and energy of movement, and the choice among several views
``tree``          fine borders, a tree of segments, and the level of the shortest description
``repeating``     the share of its cost that a segment saves by repeating itself
``borders``       borders to the frame, and transitions
``repetitions``   the number of repetitions of a segment, and cuts between them
``ends``          the start of the first repetition and the end of the last one
``joining``       merges neighbouring activities that are one set of repetitions
``events``        spans that recur occasionally
``primitives``    segments with their repetitions, clusters and events
``confidence``    probabilities of the results, which no stage reads
``found``         the results of all stages, and tables at several levels of detail
================= ========================================================================

``docs/method.md`` explains each step.
"""
