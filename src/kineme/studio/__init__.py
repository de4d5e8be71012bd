"""The studio: a local server and a page to look at recordings and correct their segments.

    server   a socket of this machine, Ctrl+C, the browser
      app      routes ─▶ open recordings, behind http.security: host, origin, token, headers
        http              bodies of requests, uploads, answers, events
        open_recordings   by id; open_recording: table, revision, undo, saving of each
          sketches          what a large file shows of itself while it is read
          loading           the recording itself and all that is computed from it; reading
          first_segments    found in a thread; a page is shown without if that takes long
          edits             what each edit does to a table
          kept.storage      the table beside the recording, and whether someone else changed it
          kept.journal      undo, redo, and the tables that were replaced, on the disk
        folder            what there is to open, names and ids; progress of each
        choices           what the page offers: presets, constants, formats
        library           the same for a library: clusters as cards, searches

Everything that a page sends is checked as it is decoded into the types of
`kineme.web.edits` and `kineme.web.requests`. No path is ever made from what a page sends: files
are found by ids, and an upload's name is made anew.
"""
