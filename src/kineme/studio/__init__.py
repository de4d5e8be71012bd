"""The studio: a local server and a page to look at recordings and correct their segments.

::

    server   a socket of this machine, Ctrl+C, the browser
      app      routes ─▶ documents, behind security: host, origin, token, headers
        documents   one per recording: its table, revision, undo, saving
          takes       the recording itself and all that is computed from it
          storage     the table beside the recording, and whether someone else changed it
        folder      what there is to open, names and ids; uploads

Everything that a page sends is checked in ``validation`` against the message
types of :mod:`kineme.web.messages`. No path is ever made from what a page
sends: files are found by ids, and an upload's name is made anew.
"""
