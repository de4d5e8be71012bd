"""The studio: a local server and a page to look at recordings and correct their segments.

    server   a socket of this machine, Ctrl+C, the browser
      app      routes ─▶ open recordings, behind security: host, origin, token, headers
        open_recordings   by id; open_recording: table, revision, undo, saving of each
          loading           the recording itself and all that is computed from it; reading
          storage           the table beside the recording, and whether someone else changed it
          journal           undo, redo, and the tables that were replaced, on the disk
          edits             what each edit does to a table
        folder            what there is to open, names and ids; uploads; progress of each
        choices           what the page offers: presets, constants, formats

Everything that a page sends is checked as it is decoded into the types of
`kineme.web.requests`. No path is ever made from what a page sends: files
are found by ids, and an upload's name is made anew.
"""
