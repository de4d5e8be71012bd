"""The papers' own figures and tables on CMU subject 86, made anew.

Trials and their truths (`kineme_reproduction.trials`); the runs of all methods with the settings
that their authors chose per trial, and the published tables (`kineme_reproduction.benchmark`); and
the figures. Scores are those of `kineme.evaluation`. ``kineme evaluate cmu86`` finds
`kineme_reproduction.command` by its entry point.
"""
