"""The pages: their sources (``pages``), as built (``static``), and what they are told.

``recording`` puts together what a page draws, from ``display`` (the poses) and
``matrix`` (the tiles of the similarity matrix). The types of what pages are
told are in ``messages``.
"""
