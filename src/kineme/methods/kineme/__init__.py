"""Method of ``kineme`` and ``sensors``: find the shortest description of a recording by segments.

A segment is described by the similarity of its samples, or by a movement that it repeats.

=============== ==========================================================================
``constants``   the constants, each with its unit and its value for bodies
``preset``      the presets for bodies and for signals
``pipeline``    runs all stages; their results as tables at several levels of detail
``views``       posture and energy of movement, and the choice among several views
``tree``        fine borders, a tree of segments, and the level of the shortest description
``borders``     borders to the frame, first and last repetitions, neighbours that are one set
``repetitions`` the repetitions of a segment, cuts between them, and the cost that they save
``events``      spans that recur occasionally
``primitives``  segments with their repetitions, clusters and events
``confidence``  probabilities of the results, which no stage reads
=============== ==========================================================================

``docs/method.md`` explains each step.
"""
