"""What people look at without a server: one page of HTML that holds everything.

``page`` fills the page that is built from ``studio/web``; ``recording`` puts
together what goes into it, from ``display`` (the poses) and ``matrix`` (the
tiles of the similarity matrix). The types of what pages are told are in
``messages``.
"""
