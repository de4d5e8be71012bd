"""The method ``kineme``: recurrence whatever the phase, change points, actions, repetitions."""
